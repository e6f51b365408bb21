# SPDX-License-Identifier: BSD-2-Clause
# scale.gp - ns per contact against the number of contacts; of both files the larger one.
load folder."/common.gp"
file = word(existing("scale_large.csv scale.csv"), 1)
keys = "algorithm1_sweep nlc_solve+from+zeros step+predicted nlc_network_init nlc_sweep nlc_assemble"
array labels[6] = ["Algorithm 1 as printed, a sweep", "solve from zeros to 10^{-6}", "time step to 10^{-6}", "network", \
    "sweep", "assemble"]
array colours[6] = ["#000000", "#fdae6b", "#a50f15", "#238b45", "#4292c6", "#8c510a"]
part(k, order) = rows(file, '$c["packing"] ~ /^'.order.':/ && $c["measurement"] == "'. \
    system("echo '".word(keys, k)."' | tr + ' '").'"', '$c["contacts"], $c["median"]')
set output out."/scale.png"
set logscale xy
set format x "10^{%T}"
set yrange [1:*]
set xlabel "contacts and candidates"
set ylabel "ns per contact"
set key outside bottom center horizontal maxrows 4 samplen 2
set title "filled, solid: spheres and contacts in random order; open, dashed: numbered by nlc_order; dotted: in the order of space" noenhanced
plot for [k=1:6] part(k, "lattice") using 1:2 with linespoints lc rgb colours[k] pt 7 lw 1.5 title labels[k], \
    for [k=1:6] part(k, "ordered:lattice") using 1:2 with linespoints lc rgb colours[k] pt 6 dt 2 lw 1.2 notitle, \
    for [k=1:6] part(k, "sorted") using 1:2 with lines lc rgb colours[k] dt 3 lw 1 notitle

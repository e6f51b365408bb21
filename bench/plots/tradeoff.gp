# SPDX-License-Identifier: BSD-2-Clause
# tradeoff.gp - run time against error, a panel for each packing.
load folder."/common.gp"
files = existing("tradeoff.csv tradeoff_large.csv")
names = packings(files)
count = words(names)
across = count < 2 ? 1 : 2
down = (count + across - 1) / across
if (strstrt(GPVAL_TERMINALS, "pngcairo") > 0) {
    set terminal pngcairo size 620 * across, 430 * down + 75 font "sans,10" background "white"
}
keys = "hertz lagged algorithm1 fixed_zeros fixed_last fixed_predicted solve_zeros solve_last solve_predicted \
    solve_zeros_kept solve_last_kept sphere_zeros sphere_zeros_kept sphere_last sphere_last_kept"
array labels[15] = ["Hertz, no coupling", "1, 2, 3 lagged sweeps", "Algorithm 1 as printed, from zeros", \
    "fixed point, from zeros", "fixed point, from the last step", "fixed point, predicted", \
    "default, from zeros", "default, from the last step", "default, predicted", \
    "default, from zeros, coefficients kept", "default, last step, kept", "exact sphere, from zeros", \
    "exact sphere, zeros, coefficients kept", "exact sphere, from the last step", "exact sphere, last step, kept"]
array colours[15] = ["#777777", "#8c510a", "#000000", "#9ecae1", "#4292c6", "#08519c", "#fdae6b", "#e6550d", "#a50f15", \
    "#fdae6b", "#e6550d", "#a1d99b", "#41ab5d", "#bcbddc", "#6a51a3"]
array marks[15] = [4, 8, 12, 6, 6, 6, 7, 7, 7, 5, 5, 10, 11, 10, 11]
set output out."/tradeoff.png"
set logscale xy
set xrange [1:1e-16]
set format x "10^{%T}"
set format y "%g"
set xlabel "largest error of a force"
set ylabel "ns per contact and step"
top = 1 - 75.0 / (430 * down + 75)
set multiplot
# the key, over all panels
set size 1, 1 - top
set origin 0, top
set key at screen 0.5, screen 0.995 center top horizontal maxrows 4 samplen 2
unset border; unset tics; unset xlabel; unset ylabel; unset grid
set yrange [1:10]
plot for [k=1:15] 0.1 with linespoints lc rgb colours[k] pt marks[k] lw 1.5 title labels[k]
set border lc rgb "#444444"; set tics textcolor rgb "#222222"; set grid xtics ytics lt 1 lw 0.5 lc rgb "#dddddd"
set xlabel "largest error of a force"
set ylabel "ns per contact and step"
unset key
set yrange [1:*]
do for [p=1:count] {
    name = word(names, p)
    set size 1.0 / across, top / down
    set origin ((p - 1) % across) * 1.0 / across, top - (1 + (p - 1) / across) * top / down
    set title name noenhanced
    here(k) = '$c["packing"] == "'.name.'" && $c["series"] == "'.word(keys, k).'"'
    present = ""
    do for [k=1:15] { if (count_rows(files, here(k)) > 0) { present = present." ".k } }
    plot for [k in present] rows(files, here(int(k)), '($c["error"] < 1e-16 ? 1e-16 : $c["error"]), $c["median"]') \
        using 1:2 with linespoints lc rgb colours[int(k)] pt marks[int(k)] lw 1.5
}
unset multiplot

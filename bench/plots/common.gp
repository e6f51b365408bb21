# SPDX-License-Identifier: BSD-2-Clause
# common.gp - for all pictures: rows of CSV files, terminal.  In: results, the folder of these files; out, that of pictures.
columns = 'BEGIN { FS = "," } FNR == 1 { for (k = 1; k <= NF; k++) c[$k] = k; next } '
# A command whose output are the rows of files (those that exist) for which an awk condition holds, as the awk list given.
rows(files, condition, list) = "< awk '" . columns . "(" . condition . ") { print " . list . " }' " . files
count_rows(files, condition) = int(system("awk '" . columns . "(" . condition . ") { n++ } END { print n + 0 }' " . files))
existing(files) = system("cd ".results." && for f in ".files."; do [ -e $f ] && printf '%s ' '".results."/'$f; done; :")
packings(files) = system("awk '" . columns . "!seen[$c[\"packing\"]]++ { print $c[\"packing\"] }' " . files)
if (strstrt(GPVAL_TERMINALS, "pngcairo") > 0) {
    set terminal pngcairo size 1200, 900 font "sans,11" background "white"
} else {
    set terminal png size 1200, 900 background "white"
}
set grid xtics ytics lt 1 lw 0.5 lc rgb "#dddddd"
set border lc rgb "#444444"
set tics textcolor rgb "#222222"

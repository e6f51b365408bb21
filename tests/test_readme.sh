#!/bin/sh
# The README's example compiles as C and as C++, runs, and does what the text says; the demo runs.
set -eu
dir=$B/tests-sh/readme
rm -rf "$dir" && mkdir -p "$dir"
# the program is the indented block from its first #include to the closing brace of main
awk '/^    #include <math.h>/ { on = 1 } on { sub(/^    /, ""); print } on && /^}/ { exit }' "$S/README" > "$dir/step.c"
cp "$dir/step.c" "$dir/step.cpp"
$CC -std=c99 -Wall -Wextra -Werror -I"$S/include" "$dir/step.c" "$B/libnlcontact.a" -lm -o "$dir/step"
$CXX -std=c++11 -Wall -Wextra -Werror -I"$S/include" "$dir/step.cpp" "$B/libnlcontact.a" -lm -o "$dir/step++"
for program in step step++; do
    out=$(${EMULATOR-} "$dir/$program")
    [ -n "$out" ] && grep -qF "    $out" "$S/README" || { echo "test_readme: the README does not show: $out"; exit 1; }
done
lines=$(wc -l < "$dir/step.c")
[ "$lines" -le 30 ] || { echo "test_readme: the example has grown to $lines lines"; exit 1; }
${EMULATOR-} "$B/bench/packing" --csv "$S/bench/data/b_die125_rd0.80.csv" > "$dir/demo.csv"
grep -q '1\.302' "$dir/demo.csv" || { echo "test_readme: the demo's ratio is not 1.302"; exit 1; }
echo "test_readme: example in C and C++, demo: ok"

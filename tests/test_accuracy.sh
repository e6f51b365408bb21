#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# bench/accuracy: its figures for Hertz's law, which is known in closed form, and what it refuses.
set -eu
export LC_ALL=C
fail() { echo "test_accuracy: $*" >&2; exit 1; }
tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT
trap 'exit 1' HUP INT TERM
accuracy() { ${EMULATOR-} "$B/bench/accuracy" "$@"; }

# A table whose errors are known: 4/3 eps^(3/2) / (1 - nu^2) over the forces here, that of the second group from a unit.
cat >"$tmp/table.csv" <<END
# contact: 0 0 2 group 1
# contact: 1 0 0 group 2
# unit: 2
nu,other,eps_1,eps_2,force_1,force_2
0,7,0.01,0.04,0.002,0.0256
0.5,,0.09,0.01,0.096,0.0032
END
accuracy --models hertz --csv "$tmp/out.csv" --svg "$tmp/out.svg" "$tmp/table.csv" >"$tmp/out"
cut -d, -f3,4,5,6,9,10 "$tmp/out.csv" >"$tmp/errors"
cat >"$tmp/expected" <<END
nu,eps_1,eps_2,group,error,status
0,0.01,0.04,1,0.333333,0
0,0.01,0.04,2,-0.166667,0
0.5,0.09,0.01,1,0.000000,0
0.5,0.09,0.01,2,0.111111,0
END
diff "$tmp/expected" "$tmp/errors" || fail "other errors than expected (<)"
# A second sphere of the same radius: 4/3 (1/2)^(1/2) eps^(3/2) / (q_1 + q_2), q = (1 - nu^2)/E, twice rigid, once softer.
cat >"$tmp/sphere.csv" <<END
# contact: 0 0 1 group 1 sphere
nu,eps_1,force_1,radius_ratio,young_ratio,other_nu
0,0.02,0.002666666,1,inf,0
0.5,0.02,0.002666666,1,inf,0
0.5,0.02,0.002666666,1,0.75,0.5
END
accuracy --models hertz --csv "$tmp/out2.csv" "$tmp/sphere.csv" >/dev/null
cut -d, -f9 "$tmp/out2.csv" | tr '\n' ' ' | grep -q '^error 0.000000 0.333334 -0.428571 $' ||
    fail "errors with a second sphere: $(cat "$tmp/out2.csv")"
# worst and rms of {1/3, 0} and of {-1/6, 1/9}
grep -qE 'all without \* +\+33\.33 +23\.57' "$tmp/out" || fail "worst and rms of the first group"
grep -qE 'all without \* +-16\.67 +14\.16' "$tmp/out" || fail "worst and rms of the second group"
grep -q '</svg>' "$tmp/out.svg" || fail "no chart"

# Every table there is can be read.
set --
for file in "$S"/bench/data/reference/*.csv "$S"/bench/data/fe/*.csv; do
    case $file in */hertz_pressure.csv) ;; *) set -- "$@" "$file" ;; esac
done
accuracy --models hertz,sphere "$@" >"$tmp/out" || fail "the references cannot be read"
for file; do
    name=$(basename "$(dirname "$file")")/$(basename "$file" .csv)
    grep -q "^  $(printf %.22s "$name") " "$tmp/out" || fail "no line for $name"
done

# Times and their chart; a model that costs nothing costs less.
accuracy --models hertz,sphere --packing "$S/bench/data/b_die125_rd0.80.csv" --cost "$tmp/cost.svg" "$tmp/table.csv" >"$tmp/out"
awk '/^  nlc_s/ { rows++; good += $(NF-1) < $NF } END { exit !(rows == 2 && good == 2) }' "$tmp/out" ||
    fail "times: $(grep nlc_s "$tmp/out")"
grep -q '>sphere</text>' "$tmp/cost.svg" && grep -q '</svg>' "$tmp/cost.svg" || fail "no chart of costs"

refused() {
    status=0
    accuracy "$tmp/bad.csv" >/dev/null 2>"$tmp/err" || status=$?
    [ $status -eq 1 ] && grep -q "bad.csv:$1: " "$tmp/err" || fail "not refused at line $1: $(cat "$tmp/bad.csv" "$tmp/err")"
}
sed 's/0.002/x/' "$tmp/table.csv" >"$tmp/bad.csv" && refused 5
sed 's/0.0256/nan/' "$tmp/table.csv" >"$tmp/bad.csv" && refused 5
sed 's/,0.0256//' "$tmp/table.csv" >"$tmp/bad.csv" && refused 5
sed 's/force_2/force_3/' "$tmp/table.csv" >"$tmp/bad.csv" && refused 4
sed 's/0 0 2/0 0 0/' "$tmp/table.csv" >"$tmp/bad.csv" && refused 1
sed 's/group 2/group 3/' "$tmp/table.csv" >"$tmp/bad.csv" && refused 2
sed '/contact/d' "$tmp/table.csv" >"$tmp/bad.csv" && refused 2
sed '5,$d' "$tmp/table.csv" >"$tmp/bad.csv" && refused 4
sed 's/# contact: 0 0 2 group 1/& sphere/' "$tmp/table.csv" >"$tmp/bad.csv" && refused 4
for arguments in "--models 1 x" "--models hertz, x" "--cost x x" "--wrong 1 x" "--csv" ""; do
    status=0
    accuracy $arguments >/dev/null 2>&1 || status=$?
    [ $status -eq 2 ] || fail "accuracy $arguments: status $status"
done
echo "test_accuracy: errors of Hertz's law, all references, what is refused: ok"

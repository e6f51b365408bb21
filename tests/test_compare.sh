#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# bench/compare: made-up times, of which it is known what is slower.
set -eu
export LC_ALL=C
fail() { echo "test_compare: $*" >&2; exit 1; }
tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT
trap 'exit 1' HUP INT TERM

head=packing,particles,contacts,measurement,unit,runs,minimum,lower_quartile,median,upper_quartile
# row PACKING MEASUREMENT UNIT MINIMUM QUARTILE MEDIAN QUARTILE
row() { echo "$1,10,50,$2,$3,21,$4,$5,$6,$7"; }
compare() { # STATUS ARGUMENT ...
    expected=$1 status=0
    shift
    sh "$S/bench/compare" "$@" >"$tmp/out" 2>"$tmp/err" || status=$?
    [ $status -eq "$expected" ] || fail "compare $*: status $status, not $expected: $(cat "$tmp/out" "$tmp/err")"
}
says() { grep -q -- "$1" "$tmp/out" || fail "does not say '$1': $(cat "$tmp/out")"; }

{
    echo "# times of a good day"
    echo $head
    row a sweep ns 9 10 11 12
    row b sweep ns 9 10 11 12
    row a init ns 20 21 22 23
    row - law ns/call 5 5 5 5
    row a ratio 1 9 10 11 12
} >"$tmp/old"
change() { # OLD-ROW NEW-ROW
    awk -v from="$1" -v to="$2" '$0 == from { $0 = to; n++ } { print } END { exit n != 1 }' "$tmp/old" >"$tmp/new" ||
        fail "no row $1"
}
a_sweep=$(row a sweep ns 9 10 11 12)

compare 0 "$tmp/old" "$tmp/old"
says '^4 measurements: 0 slower by more than 10 %, 0 faster$'

# Slower: medians and minima by a third, quartiles apart.  Only that row is named; back again it is faster.
change "$a_sweep" "$(row a sweep ns 12 13 14.5 15)"
compare 1 "$tmp/old" "$tmp/new"
says '^slower  a  sweep: 11 -> 14.5 (+32 %), minimum 9 -> 12$'
says '1 slower by more than 10 %, 0 faster$'
[ "$(wc -l <"$tmp/out")" -eq 2 ] || fail "says more: $(cat "$tmp/out")"
compare 0 "$tmp/new" "$tmp/old"
says '^faster  a  sweep: '
compare 0 -t 34 "$tmp/old" "$tmp/new"
compare 1 -t 31 "$tmp/old" "$tmp/new"

# Not slower: the spreads overlap; a disturbed run, whose minimum is as before; a change below the threshold.
change "$a_sweep" "$(row a sweep ns 12 11.9 14.5 18)"
compare 0 "$tmp/old" "$tmp/new"
change "$a_sweep" "$(row a sweep ns 9.5 13 14.5 18)"
compare 0 "$tmp/old" "$tmp/new"
change "$a_sweep" "$(row a sweep ns 12 12.05 12.05 12.2)"
compare 0 "$tmp/old" "$tmp/new"
change "$(row - law ns/call 5 5 5 5)" "$(row - law ns/call 5.4 5.4 5.4 5.4)"
compare 0 "$tmp/old" "$tmp/new"
compare 1 -t 7 "$tmp/old" "$tmp/new"
# What is no time does not count: neither a ratio nor other columns.
change "$(row a ratio 1 9 10 11 12)" "$(row a ratio 1 90 91 92 93)"
compare 0 "$tmp/old" "$tmp/new"
sed -e '/^#/!s/$/,x/' -e "s/^\(packing.*\),x/\1,status/" "$tmp/old" >"$tmp/new"
compare 0 "$tmp/old" "$tmp/new"

# Rows of one file only are counted; another order of rows and columns changes nothing.
{ grep -v ,init, "$tmp/old"; row c sweep ns 1 1 1 1; row c init ns 1 1 1 1; } >"$tmp/new"
compare 0 "$tmp/old" "$tmp/new"
says '^3 measurements: .*, 1 only in the old file, 2 only in the new one$'
awk -F, -v OFS=, '/^#/ { next } { print $10, $9, $8, $7, $5, $4, $1 }' "$tmp/old" >"$tmp/turned"
{ head -n 1 "$tmp/turned"; sed -n '2,$p' "$tmp/turned" | sort; } >"$tmp/new"
compare 0 "$tmp/old" "$tmp/new"
says '^4 measurements: 0 slower'

# Refused, with status 2.
compare 2 "$tmp/old"
compare 2 -t x "$tmp/old" "$tmp/old"
compare 2 "$tmp/old" "$tmp/none"
: >"$tmp/new" && compare 2 "$tmp/old" "$tmp/new"
cut -d, -f1-8 "$tmp/old" >"$tmp/new" && compare 2 "$tmp/old" "$tmp/new"
sed 's/^a,\(.*\),9,/a,\1,-nan,/' "$tmp/old" >"$tmp/new" && compare 2 "$tmp/old" "$tmp/new"
{ cat "$tmp/old"; echo "$a_sweep"; } >"$tmp/new" && compare 2 "$tmp/old" "$tmp/new"
sed 's/^[ab-],/x,/' "$tmp/old" | sed '/^x.*,9,/d' >"$tmp/new" && compare 2 "$tmp/old" "$tmp/new"
echo "test_compare: slower, faster, within the spread, refused: ok"

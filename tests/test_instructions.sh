#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# Instructions of every public function, as valgrind counts them, against those recorded in tests/instructions.csv: a guard of
# speed that does not depend on what else the machine does.  `make record-instructions` records them anew.
set -eu
export LC_ALL=C
MARGIN=15 # per cent, either way: a record that is far too high guards nothing
fail() { echo "test_instructions: $*" >&2; exit 1; }
skip() { echo "test_instructions: skipped: $*"; exit 0; }
tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT
trap 'exit 1' HUP INT TERM

# What is compared: rows of a function and variant; a variant that this machine lacks does not count.
compare() { # RECORDED COUNTED
    awk -F, -v margin="$MARGIN" '
    /^#/ || /^function,/ { next }
    { key = $1 " (" $2 ")" }
    FILENAME == ARGV[1] { recorded[key] = $4; variant[key] = $2; order[++n] = key; next }
    { here[$2] = 1; rows++; counted[key] = $4; if (!(key in recorded)) { print key ": not recorded"; bad++ } }
    END {
        for (k = 1; k <= n; k++) {
            key = order[k]
            if (!(variant[key] in here)) { lacking[variant[key]] = 1; continue }
            if (!(key in counted)) { print key ": recorded, and not there"; bad++; continue }
            change = 100 * (counted[key] / recorded[key] - 1)
            if (change > margin || change < -margin) {
                printf "%s: %s instructions, %s recorded (%+.0f %%)\n", key, counted[key], recorded[key], change
                bad++
            }
        }
        for (v in lacking) print "no " v " here: not compared"
        if (!rows) { print "nothing was counted"; bad++ }
        exit bad > 0
    }' "$1" "$2"
}

# The comparison itself, on made-up counts.
printf '%s\n' '# library: x' function,variant,per,instructions a,-,call,100 b,AVX2,contact,50 >"$tmp/old"
compared() { compare "$tmp/old" "$tmp/new" >"$tmp/said" && echo same || echo differs; }
[ "$(cp "$tmp/old" "$tmp/new" && compared)" = same ] || fail "equal counts differ"
[ "$(sed 's/,100/,114/; s/,50/,43/' "$tmp/old" >"$tmp/new" && compared)" = same ] || fail "14 % differ"
[ "$(sed 's/,100/,116/' "$tmp/old" >"$tmp/new" && compared)" = differs ] || fail "16 % more do not differ"
[ "$(sed 's/,50/,42/' "$tmp/old" >"$tmp/new" && compared)" = differs ] || fail "16 % less do not differ"
[ "$(sed '/AVX2/d' "$tmp/old" >"$tmp/new" && compared)" = same ] && grep -q 'no AVX2' "$tmp/said" || fail "a variant too few"
[ "$(sed 's/b,AVX2/b,-/' "$tmp/old" >"$tmp/new" && compared)" = differs ] || fail "a new function is not noticed"
[ "$(sed 's/^a,-/a,AVX2/' "$tmp/old" >"$tmp/new" && compared)" = differs ] || fail "a missing function is not noticed"

[ -z "${EMULATOR-}" ] || skip "an emulator is used"
command -v valgrind >/dev/null || skip "no valgrind: make setup"
valgrind -q --tool=none true >/dev/null 2>&1 || skip "valgrind does not work here"
here=$(sh "$S/bench/count_instructions" "$B/libnlcontact.a" 2>"$tmp/err") || skip "$(cat "$tmp/err")"
recorded=$(sed -n '/^# library: /p' "$S/tests/instructions.csv")
[ "$recorded" = "$here" ] || skip "recorded for $recorded, this is $here"
sh "$S/bench/count_instructions" "$B/libnlcontact.a" "$B/bench/instructions" >"$tmp/counted" || fail "counting fails"
for function in $(sed -n 's/^NLC_API .*[ *]\(nlc_[a-z0-9_]*\)(.*/\1/p' "$S/include/nlcontact.h"); do
    grep -q "^$function[ ,]" "$tmp/counted" || fail "$function is not counted: bench/functions_scalar.c, functions_network.c"
done
compare "$S/tests/instructions.csv" "$tmp/counted" >"$tmp/said" ||
    { cat "$tmp/said"; fail "if this is meant to be so: make record-instructions"; }
echo "test_instructions: $(grep -c "^nlc_" "$tmp/counted") counts within $MARGIN %: ok"

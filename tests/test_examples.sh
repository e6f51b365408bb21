#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# Other languages: the examples give the forces that the packing program gives, and declare what the header does.
set -eu
fail() { echo "test_examples: $*" >&2; exit 1; }
tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT
trap 'exit 1' HUP INT TERM
unset MAKEFLAGS MFLAGS GNUMAKEFLAGS MAKELEVEL
FC=${FC-gfortran} done='' skipped=''
packing=$S/bench/data/b_die125_rd0.80.csv

${EMULATOR-} "$B/bench/packing" --csv "$packing" | grep '^total_force,' >"$tmp/expected"
sed 's/plane rigid/plane type 1/' "$packing" >"$tmp/wall.csv"
# Printed to 1e-6 N; the forces themselves agree to the tolerance of 1e-8, their sum to much better.
same() {
    name=$1 && shift
    "$@" "$packing" >"$tmp/found" || fail "$name fails"
    tr ',' ' ' <"$tmp/found" | awk -v expected="$(cat "$tmp/expected")" '
        function near(a, b) { return a - b <= 2e-8 * b && b - a <= 2e-8 * b }
        { split(expected, e, ","); ok = $1 == "total" && near($4, e[3]) && near($7, e[4]) && $10 == sprintf("%.3f", e[4] / e[3]) }
        END { exit !ok }' || fail "$name says '$(cat "$tmp/found")' and the packing program '$(cat "$tmp/expected")'"
    ! "$@" "$tmp/none" >"$tmp/found" 2>&1 || fail "$name finds nothing wrong with a missing file"
    for other in "$S/bench/data/a_mono1000_periodic.csv" "$tmp/wall.csv"; do
        ! "$@" "$other" >"$tmp/found" 2>&1 || fail "$name computes what it cannot, $other"
        grep -q 'no periodic boxes' "$tmp/found" || fail "$name does not say what is wrong with $other: $(cat "$tmp/found")"
    done
    done="$done $name"
}
skip() { skipped="$skipped; $1: $2"; }

$MAKE -s -C "$S" B="$B" CC="$CC" CXX="$CXX" FC="$FC" WARNINGS='-Wall -Wextra -Werror' examples >"$tmp/log" 2>&1 ||
    { cat "$tmp/log"; fail "make examples fails"; }
same C++ ${EMULATOR-} "$B/examples/packing-c++"

# Sizes of structs and ends of fields, from the header; the other languages print the same lines.
structs=$(sed -n 's/^typedef struct \(nlc_[a-z_]*\) {.*/\1/p' "$S/include/nlcontact.h")
{
    printf '#include <nlcontact.h>\n#include <stdio.h>\nint main(void)\n{\n'
    for t in $structs; do printf '    printf("%s %%d\\n", (int)sizeof(%s));\n' "$t" "$t"; done
    printf '    return 0;\n}\n'
} >"$tmp/sizes.c"
$CC ${CFLAGS-} -I"$S/include" -o "$tmp/sizes" "$tmp/sizes.c" && ${EMULATOR-} "$tmp/sizes" >"$tmp/sizes.txt" || fail "no sizes"

if command -v "$FC" >/dev/null && [ "$($FC -dumpmachine)" = "$($CC -dumpmachine)" ]; then
    same Fortran ${EMULATOR-} "$B/examples/packing-fortran"
    {
        printf 'program sizes\nuse nlcontact\n'
        for t in $structs; do printf 'type(%s) :: a_%s\n' "$t" "$t"; done
        for t in $structs; do
            printf "print '(a,i0)', '%s ', c_sizeof(a_%s)\n" "$t" "$t"
            case $t in
            nlc_material) ;;
            *) printf "if (a_%s%%struct_size /= c_sizeof(a_%s)) print *, 'struct_size of %s is wrong'\n" "$t" "$t" "$t" ;;
            esac
        done
        printf 'end program\n'
    } >"$tmp/sizes.f90"
    $FC -J"$tmp" -o "$tmp/fsizes" "$S/include/nlcontact.f90" "$tmp/sizes.f90" "$B/libnlcontact.a" ${LDFLAGS-} -lm ||
        fail "the Fortran module does not compile"
    ${EMULATOR-} "$tmp/fsizes" >"$tmp/fsizes.txt"
    diff "$tmp/sizes.txt" "$tmp/fsizes.txt" || fail "sizes of structs in C (<) and in Fortran (>) differ"
else
    skip Fortran "no $FC for this machine"
fi

python=
for p in python3 /usr/bin/python3; do
    [ -n "$python" ] || ! $p -c 'import numpy' 2>/dev/null || python=$p
done
if [ -z "$python" ]; then
    skip Python "no numpy"
elif [ -n "${EMULATOR-}" ]; then
    skip Python "the library is for another machine"
else
    export NLCONTACT_LIBRARY="$B/libnlcontact.so" PYTHONDONTWRITEBYTECODE=1
    same Python "$python" "$S/examples/packing.py"
    PYTHONPATH=$S/examples $python -c '
import ctypes, nlcontact
for name in "particles options info positions".split():
    print("nlc_" + name, ctypes.sizeof(getattr(nlcontact, name.capitalize())))' >"$tmp/psizes.txt"
    while read -r line; do
        grep -qxF "$line" "$tmp/sizes.txt" || fail "Python says '$line', C '$(grep "${line% *} " "$tmp/sizes.txt")'"
    done <"$tmp/psizes.txt"
fi
if command -v python3 >/dev/null; then
    python3 "$S/tools/fortran.py" "$S/include/nlcontact.h" >"$tmp/module.f90"
    cmp -s "$tmp/module.f90" "$S/include/nlcontact.f90" ||
        fail "include/nlcontact.f90 is not what tools/fortran.py makes of the header"
else
    skip "Fortran module against the header" "no python3"
fi
echo "test_examples:$done: ok${skipped:+ (not looked at$skipped)}"

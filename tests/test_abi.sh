#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# The ABI: what tests/abi records of each release holds in this library, and what it records of this one is up to date.
#     header, program.c   a program built with that release's header runs with this library
#     layout              sizes, offsets, values and symbols are where they were, by the compiler's own judgement
#     libnlcontact.abi    what abidiff sees in the debug information
# Where the header or lib/nlcontact.map have changed, `make abi-baseline` records it, in the same commit.
set -eu
export LC_ALL=C
fail() { echo "test_abi: $*" >&2; exit 1; }
tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT
trap 'exit 1' HUP INT TERM
unset MAKEFLAGS MFLAGS GNUMAKEFLAGS MAKELEVEL
current=${VERSION%.*} skipped=''
abi=$S/tests/abi
skip() { skipped="$skipped; $1"; }

# Nodes of the version script are NLCONTACT_x.y, oldest first, none of a release to come; a symbol is in one of them.
sed -n 's/^NLCONTACT_\([0-9.]*\) {$/\1/p' "$S/lib/nlcontact.map" >"$tmp/nodes"
[ -s "$tmp/nodes" ] || fail "no nodes found in the version script"
{ cat "$tmp/nodes" && echo "$current"; } | sort -c -t. -k1,1n -k2,2n ||
    fail "the nodes of the version script are not those of releases"
sed -n 's/^ *\(nlc_[a-z0-9_]*\);$/\1/p' "$S/lib/nlcontact.map" | sort | uniq -d >"$tmp/twice"
[ ! -s "$tmp/twice" ] || fail "symbols in two nodes:" $(cat "$tmp/twice")
shared=$B/libnlcontact.so.$VERSION
readelf -W --dyn-syms "$shared" | awk '$7 != "UND" && $7 != "ABS" { print $8 }' | sed -n 's/@@/ /p' | sort >"$tmp/symbols"
[ -s "$tmp/symbols" ] || fail "no symbols found in the shared library"

# A recorded layout as static assertions for all models of data.  Of an older release a struct may have grown.
assertions() { # layout, comparison of sizes
    awk -v compare="$2" '
    function pick(k, a, b, c) {
        split($3, a, "+"); split($4, b, "+"); split($5, c, "+")
        return "(sizeof(void *) == 8 ? " a[k] " : offsetof(struct probe, x) == 8 ? " b[k] " : " c[k] ")"
    }
    function demand(condition, text) { print "_Static_assert(" condition ", \"" text "\");" }
    BEGIN {
        print "#include <nlcontact.h>\nstruct probe { char c; int64_t x; };"
        demand("sizeof(nlc_status) == 4", "nlc_status has another size")
    }
    $1 == "struct" { demand("sizeof(" $2 ") " ($2 == "nlc_material" ? "==" : compare) " " pick(1), $2 " has another size") }
    $1 == "field" {
        type = $2; sub(/\..*/, "", type); name = $2; sub(/.*\./, "", name)
        demand("offsetof(" type ", " name ") == " pick(1), $2 " has moved")
        demand("sizeof ((" type " *)0)->" name " == " pick(2), $2 " has another size")
    }
    $1 == "value" { demand($2 " == " $3, $2 " has changed") }' "$1"
}
# The compiler compares types: what a release's header declares is declared again after today's, and its fields are those that
# today's structs begin with.
prototypes() { awk '/^NLC_API/ { on = 1 } on { print } /;/ { on = 0 }' "$1"; }
fields() { awk '/^typedef struct [a-z_]+ {$/ { on = $3 } on && !/^[{}]|^typedef/ { gsub(/ +/, " "); print on ":" $0 } /^}/ { on = "" }' "$1"; }
compare_types() { # the folder of an older release
    { echo '#include <nlcontact.h>' && prototypes "$1/nlcontact.h"; } >"$tmp/types.c"
    grep -q '^NLC_API.*nlc_solve' "$tmp/types.c" || fail "no functions found in $1/nlcontact.h"
    $CC ${CFLAGS-} -std=c11 -ffreestanding -fsyntax-only -I"$S/include" "$tmp/types.c" || fail "functions of ${1##*/} are declared otherwise"
    fields "$1/nlcontact.h" >"$tmp/fields"
    fields "$abi/$current/nlcontact.h" >"$tmp/today"
    grep -q '^nlc_info: int64_t culprit;' "$tmp/fields" || fail "no fields found in $1/nlcontact.h"
    awk -F: '
    NR == FNR { today[$1, ++count[$1]] = $2; next }
    today[$1, ++seen[$1]] != $2 { print $1 ":" $2; wrong = 1 }
    END { exit wrong }' "$tmp/today" "$tmp/fields" || fail "the fields above of ${1##*/} are not what today's structs begin with"
}
models=0
compile() {
    "$@" -std=c11 -ffreestanding -fsyntax-only -I"$S/include" "$tmp/layout.c" || fail "$release: does not hold: $*"
    models=$((models + 1))
}
# Releases are the nodes, and from the first of them on what is tagged.
{ cat "$tmp/nodes" && git -C "$S" tag -l 'v*.0' 2>/dev/null | sed -n 's/^v\([0-9]*\.[0-9]*\)\.0$/\1/p'; } |
    awk -F. 'NR == 1 { major = $1; minor = $2 } $1 > major || ($1 == major && $2 >= minor)' >"$tmp/releases"
while read -r release; do
    [ -f "$abi/$release/layout" ] || fail "nothing is recorded of $release: make abi-baseline, or bring it back"
done <"$tmp/releases"
for layout in "$abi"/*/layout; do
    folder=${layout%/layout} release=${folder##*/}
    if [ "$release" = "$current" ]; then compare='=='; else compare='>='; fi
    assertions "$layout" "$compare" >"$tmp/layout.c"
    grep -q 'offsetof(nlc_info, struct_size)' "$tmp/layout.c" || fail "$layout was not understood"
    if git -C "$S" rev-parse -q --verify "refs/tags/v$release.0" >/dev/null 2>&1; then
        git -C "$S" diff --quiet "v$release.0" -- "$folder" || fail "$release is released, and what was recorded of it has changed"
    fi
    compile $CC ${CFLAGS-}
    for model in -m32 -mx32; do
        if $CC $model -ffreestanding -fsyntax-only -x c - </dev/null 2>/dev/null; then compile $CC $model; fi
    done

    # Symbols of a release stay in its node, and once released a node gets no more.
    sed -n 's/^symbol //p' "$layout" | sort >"$tmp/recorded"
    [ -s "$tmp/recorded" ] || fail "$layout has no symbols"
    awk 'NR == FNR { released[$2]; next } $2 in released' "$tmp/recorded" "$tmp/symbols" >"$tmp/found"
    diff "$tmp/recorded" "$tmp/found" || fail "symbols recorded of $release (<) and those of the library (>) differ"

    # What came later lies behind everything that was there, padding at a struct's end included: an older program may have left
    # anything in it.
    if [ "$release" != "$current" ]; then
        compare_types "$folder"
        awk '
        NR == FNR { if ($1 == "struct") for (k = 3; k <= 5; k++) size[$2, k] = $k; if ($1 == "field") old[$2]; next }
        $1 == "field" && !($2 in old) {
            type = $2; sub(/\..*/, "", type)
            for (k = 3; k <= 5; k++) if ((type, k) in size && $k + 0 < size[type, k] + 0) { print $2; wrong = 1 }
        }
        END { exit wrong }' "$layout" "$abi/$current/layout" || fail "the fields above lie inside the struct of $release"
    fi

    program=$tmp/program-$release
    for library in shared static; do
        case $library in shared) link="-L$B -lnlcontact" ;; static) link=$B/libnlcontact.a ;; esac
        $CC ${CFLAGS-} -std=c99 -I"$folder" -o "$program" "$folder/program.c" $link ${LDFLAGS-} -lm ||
            fail "the program of $release does not link with the $library library"
        LD_LIBRARY_PATH="$B${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}" ${EMULATOR-} "$program" ||
            fail "the program of $release fails with the $library library"
    done
done

# What is recorded of this release is what it is.
again="make abi-baseline, and read what it changes"
[ -f "$abi/$current/layout" ] || fail "nothing is recorded of $current: $again"
if command -v python3 >/dev/null; then
    python3 "$S/tools/abi.py" header "$S/include/nlcontact.h" | diff "$abi/$current/nlcontact.h" - >"$tmp/diff" ||
        { cat "$tmp/diff"; fail "the header has changed: $again"; }
    [ ! -d "$S/debian" ] || python3 "$S/tools/abi.py" symbols "$S/lib/nlcontact.map" | diff "$S/debian/libnlcontact0.symbols" - ||
        fail "Debian's list of symbols is out of date: $again"
    if [ "$($CC -dumpmachine | cut -d- -f1)" = x86_64 ] && [ $models -ge 3 ]; then
        python3 "$S/tools/abi.py" layout "$S/include/nlcontact.h" "$S/lib/nlcontact.map" "$CC" >"$tmp/layout"
        diff "$abi/$current/layout" "$tmp/layout" || fail "the layout has changed: $again"
    else
        skip "whether the layout is recorded in full: $CC has not all models of data"
    fi
else
    skip "whether the header is the one recorded: no python3"
fi

# The exit code of abidiff is 4 for a field appended and for one shifted: of this release it must be 0, of an older one nothing
# may be gone (8).
if ! command -v abidiff >/dev/null; then
    skip "debug information: no abidiff"
elif ! readelf -h "$shared" | grep -q 'X86-64' || [ "$(getconf LONG_BIT)" != 64 ]; then
    skip "debug information: recorded for x86-64"
else
    $MAKE -s -C "$S" B="$tmp/build" CC="$CC" CFLAGS='-O0 -g' LDFLAGS= WARNINGS= abi-dump >"$tmp/log" 2>&1 ||
        { cat "$tmp/log"; fail "make abi-dump fails"; }
    for recorded in "$abi"/*/libnlcontact.abi; do
        release=${recorded%/*} release=${release##*/} status=0
        abidiff --harmless "$recorded" "$tmp/build/libnlcontact.abi" >"$tmp/log" 2>&1 || status=$?
        [ $status -eq 0 ] || { [ "$release" != "$current" ] && [ $((status & 11)) -eq 0 ]; } ||
            { cat "$tmp/log"; fail "abidiff says $status of $release: $again"; }
    done
fi
echo "test_abi: releases $(cd "$abi" && echo *), $models models of data: ok${skipped:+ (not looked at$skipped)}"

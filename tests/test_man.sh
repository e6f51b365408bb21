#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# The man pages: clean mdoc; prototypes, errors and accuracy as in the header; every example compiles and succeeds.
set -eu
fail() { echo "test_man: $*" >&2; exit 1; }
tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT
trap 'exit 1' HUP INT TERM
cd "$S/man"

command -v mandoc >/dev/null || fail "mandoc is missing: run make setup"
mandoc -Tlint -Wall ./*.[37] || fail "mandoc has complaints"

# What a page repeats of the header, as lines "function fact": the prototype, the statuses returned, the worst error.
# Comments over a function in the header and running text in a page are both searched in $text.
facts='
function tell(fact) { print name, fact }
function tell_of_text(    n, w, k, kind) {
    n = split(text, w, /[^A-Za-z0-9_.]+/)
    for (k = 2; k <= n; k++) if (w[k] ~ /^ulp\.?$/ && w[k-1] ~ /^[0-9.]+$/) tell(w[k-1] " ulp")
    n = split(text, w, /[^A-Za-z0-9_]+/)
    for (k = 1; k <= n; k++) if (w[k] ~ /^NLC_(ERROR|WARNING)_[A-Z_]+$/) {
        tell(w[k])
        kind = w[k] ~ /ERROR/ ? "NLC_ERROR" : "NLC_WARNING" # of the short names that follow
    } else if (w[k] ~ /^_[A-Z_]+$/) tell(kind w[k])
}
function tell_prototype(p) {
    gsub(/[ \t]+/, " ", p); gsub(/\* /, "*", p); gsub(/NLC_API /, "", p); gsub(/NLC_RESTRICT/, "restrict", p)
    tell(p)
}'
awk "$facts"'
/^\/\*/ { text = "" }
/^NLC_API/ { prototype = ""; name = $0; sub(/\(.*/, "", name); sub(/.*[ *]/, "", name) }
/^NLC_API/, /;/ {
    prototype = prototype " " $0
    if (/;/) { sub(/^ /, "", prototype); tell_prototype(prototype); tell_of_text() }
    next
}
{ text = text "\n" $0 }' "$S/include/nlcontact.h" | LC_ALL=C sort -u >"$tmp/header"
for page in nlc_*.3; do
    awk -v name="${page%.3}" "$facts"'
    function bare(s) { sub(/^\.[A-Z][a-z] /, "", s); gsub(/"/, "", s); return s }
    /^\.Sh / { examples = /EXAMPLES/ }
    /^\.Sh RETURN/ || /^\.Sh ERRORS/ { told = 1 } # a warning that the description explains counts where it is returned
    /^\.Ft / { type = bare($0) }
    /^\.Fo / { list = "" }
    /^\.Fa "/ { list = list ", " bare($0) }
    /^\.Fc/ { tell_prototype(type " " name "(" substr(list, 3) ");") }
    /^\.Fn / && NF == 3 && $3 == "void" { tell_prototype(type " " name "(void);") }
    told && !examples { text = text "\n" $0 }
    END { tell_of_text() }' "$page"
done | LC_ALL=C sort -u >"$tmp/pages"
[ "$(wc -l <"$tmp/header")" -gt 60 ] || fail "the header was not understood"
diff "$tmp/header" "$tmp/pages" >"$tmp/diff" || { cat "$tmp/diff"; fail "header (<) and pages (>) differ"; }

# The overview lists every status with its number, text and culprit.
tr '\n' ' ' <nlcontact.3 | sed 's/\\-/-/g' >"$tmp/overview"
sed -n 's/^ *X(\(NLC_[A-Z_]*\), *\([-0-9]*\), *"\([^"]*\)", *"\([^"]*\)").*/\1 Pq \2 \3 [\4]/p' "$S/include/nlcontact.h" |
    sed 's/ \[-1\]$//' >"$tmp/statuses"
[ -s "$tmp/statuses" ] || fail "no statuses found in the header"
while read -r status; do
    grep -qF "Dv $status ." "$tmp/overview" || fail "nlcontact.3 does not say: $status"
done <"$tmp/statuses"

# Examples: the literal displays of EXAMPLES, without the escapes of roff.
pages=0 examples=0 skipped=''
if printf '#include <omp.h>\nint main(void) { return omp_get_max_threads() < 1; }\n' >"$tmp/omp.c" &&
    $CC ${CFLAGS-} -fopenmp -o "$tmp/omp" "$tmp/omp.c" ${LDFLAGS-} 2>/dev/null; then openmp=-fopenmp
else openmp=-Wno-unknown-pragmas skipped=" (without threads)"; fi
ranks=
if [ -z "${EMULATOR-}" ] && command -v mpicc >/dev/null && command -v mpirun >/dev/null; then
    ranks='mpirun -n 3' # as root, and on fewer processors than ranks: for two generations of Open MPI
    export OMPI_CC="$CC" MPICH_CC="$CC" OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
    export OMPI_MCA_rmaps_base_oversubscribe=1 PRTE_MCA_rmaps_default_mapping_policy=:oversubscribe
fi
for page in *.[37]; do
    pages=$((pages + 1))
    awk -v to="$tmp/${page%.*}" -v quote="'" '
    /^\.Sh / { here = /EXAMPLES/ }
    /^\.Ed/ { show = 0 }
    show {
        sub(/^\\&/, ""); gsub(/\\-/, "-"); gsub(/\\\(aq/, quote); gsub(/\\\(ha/, "^"); gsub(/\\\(ti/, "~")
        gsub(/\\\(ga/, "`"); gsub(/\\e/, "\\\\")
        print > (to "." n ".c")
    }
    here && /^\.Bd -literal/ { show = 1; n++ }' "$page"
    [ -f "$tmp/${page%.*}.1.c" ] || fail "$page has no example"
    for source in "$tmp/${page%.*}".*.c; do
        program=${source%.c} threads='' compiler=$CC start=${EMULATOR-}
        if grep -q '^#include <mpi.h>' "$source"; then
            [ -n "$ranks" ] || { skipped="$skipped (without ranks)" && continue; }
            compiler=mpicc start=$ranks
        fi
        ! grep -q '^#pragma omp' "$source" || threads=$openmp
        $compiler ${CFLAGS-} $threads -std=c99 -Wall -Wextra -Werror -I"$S/include" -o "$program" "$source" "$B/libnlcontact.a" \
            ${LDFLAGS-} -lm || fail "an example of $page does not compile"
        $start "$program" >"$program.out" 2>&1 || { cat "$program.out"; fail "an example of $page fails"; }
        examples=$((examples + 1))
    done
done
echo "test_man: $pages pages, $examples examples: ok$skipped"

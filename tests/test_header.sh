#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# The header: compiles alone and without a warning as C and C++ of every age, twice too; public structs have no padding where
# pointers have 64 bits.  (Their layout is the affair of test_abi.sh.)
set -eu
fail() { echo "test_header: $*" >&2; exit 1; }
tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT
trap 'exit 1' HUP INT TERM
strict="-Wall -Wextra -pedantic -Wconversion -Wsign-conversion -Wshadow -Wundef -Wpadded -Werror"

printf '#include <nlcontact.h>\n#include <nlcontact.h>\n' >"$tmp/twice.c"
cp "$tmp/twice.c" "$tmp/twice.cc"

compiled=0
compile() {
    "$@" -fsyntax-only -I"$S/include" || fail "does not pass: $*"
    compiled=$((compiled + 1))
}
for cc in "$CC" gcc clang; do
    command -v "${cc%% *}" >/dev/null || continue
    case " ${seen-}|" in *" $cc|"*) continue ;; esac
    seen="${seen-} $cc|"
    for std in c99 c11 c17; do compile $cc -std=$std $strict -Wstrict-prototypes "$tmp/twice.c"; done
done
for cxx in "$CXX" g++ clang++; do
    command -v "${cxx%% *}" >/dev/null || continue
    case " ${seen-}|" in *" $cxx|"*) continue ;; esac
    seen="${seen-} $cxx|"
    for std in c++11 c++17; do
        compile $cxx -std=$std $strict -Wold-style-cast -Wzero-as-null-pointer-constant "$tmp/twice.cc"
    done
done

# What takes a const network may be called by many threads at once: one of the tests does.
for name in $(sed -n 's/^NLC_API .*[ *]\(nlc_[a-z0-9_]*\)(const nlc_network \*.*/\1/p' "$S/include/nlcontact.h"); do
    grep -q "$name(n[,)]" "$S/tests/test_threads.c" || fail "$name takes a const network, and test_threads does not call it"
done

# A C++ program with every function in it links and runs.
names=$(sed -n 's/^NLC_API .*[ *]\(nlc_[a-z0-9_]*\)(.*/\1/p' "$S/include/nlcontact.h")
[ -n "$names" ] || fail "no functions found in the header"
{
    echo '#include <nlcontact.h>'
    echo 'typedef void (*function)();'
    echo 'static const function volatile functions[] = {'
    for name in $names; do echo "    reinterpret_cast<function>(&$name),"; done
    echo '};'
    echo 'int main()'
    echo '{'
    echo '    for (std::size_t k = 0; k < sizeof functions / sizeof *functions; k++) if (!functions[k]) return 1;'
    echo '    return nlc_hertz_force(3.0, 4.0) == 24.0 ? 0 : 1;'
    echo '}'
} | sed '1i #include <cstddef>' >"$tmp/all.cc"
$CXX ${CFLAGS-} -std=c++11 -I"$S/include" -o "$tmp/all" "$tmp/all.cc" "$B/libnlcontact.a" ${LDFLAGS-} -lm ||
    fail "a C++ program with every function in it does not link"
${EMULATOR-} "$tmp/all" || fail "a C++ program computes something else"
echo "test_header: $compiled compilations, a C++ program: ok"

#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# Names: the header, the version script, the shared library and the man pages agree on what is public; the libraries need
# nothing but arithmetic and memory primitives and have no writable data.
set -eu
export LC_ALL=C
fail() { echo "test_names: $*" >&2; exit 1; }
tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT
trap 'exit 1' HUP INT TERM
shared=$B/libnlcontact.so.$VERSION static=$B/libnlcontact.a
command -v readelf >/dev/null || fail "readelf is missing"

# readelf's columns: 5 binding, 6 visibility, 7 section, 8 name
symbols() { readelf -W "$@" | awk '($5 == "GLOBAL" || $5 == "WEAK") && $8 != "" { print $7, $8, $6 }'; }
symbols --dyn-syms "$shared" >"$tmp/dynamic"
symbols -s "$static" >"$tmp/static"

# One list of functions, five times.
sed -n 's/^NLC_API .*[ *]\(nlc_[a-z0-9_]*\)(.*/\1/p' "$S/include/nlcontact.h" | sort >"$tmp/header"
[ -s "$tmp/header" ] || fail "no functions found in the header"
same() { diff "$tmp/header" "$tmp/$1" || fail "header (<) and $2 (>) differ"; }
sed -n '/global:/,/local:/s/^ *\([a-z0-9_*]*\);.*/\1/p' "$S/lib/nlcontact.map" | sort >"$tmp/map"
same map "version script"
awk '$1 != "UND" && $1 != "ABS" { sub(/@@NLCONTACT_[0-9.]*$/, "", $2); print $2 }' "$tmp/dynamic" | sort >"$tmp/exported"
same exported "symbols of the shared library with a version"
awk '$1 != "UND" && $3 == "DEFAULT" { print $2 }' "$tmp/static" | sort >"$tmp/default"
same default "symbols of default visibility in the static library"
(cd "$S/man" && ls nlc_*.3) | sed 's/\.3$//' | sort >"$tmp/pages"
same pages "man pages"

if grep -qE '__(asan|tsan|msan|ubsan|sanitizer|gcov|llvm)' "$tmp/static"; then
    echo "test_names: $(wc -l <"$tmp/header") functions: ok (instrumented build: not looked at: other names, imports, data)"
    exit 0
fi

# i386 compilers add thunks of their own.
stray=$(awk '$1 != "UND" && $2 !~ /^nlc_/ && $2 !~ /^__x86\.get_pc_thunk/ { print $2 }' "$tmp/static")
[ -z "$stray" ] || fail "global names in the static library that do not begin with nlc_:" $stray

# Arithmetic; memory; what the linker's start files ask for; what the compiler puts in when told to harden.
allowed=' sqrt cbrt fma fabs sin cos
 memcpy memmove memset memcmp
 __cxa_finalize __gmon_start__ _ITM_deregisterTMCloneTable _ITM_registerTMCloneTable
 __stack_chk_fail __stack_chk_guard __memcpy_chk __memmove_chk __memset_chk '
for name in $(awk '$1 == "UND" { sub(/@.*/, "", $2); print $2 }' "$tmp/dynamic"); do
    case $allowed in
    *[[:space:]]"$name"[[:space:]]*) ;;
    *) fail "the shared library imports $name" ;;
    esac
done
for library in $(readelf -d "$shared" | sed -n 's/.*(NEEDED).*\[\(.*\)\]/\1/p'); do
    case $library in
    libc.* | libm.* | ld-*) ;;
    *) fail "the shared library needs $library" ;;
    esac
done

# Sections of the objects: writable ones must be empty, except constants that only wait for relocation.
readelf -WS "$static" | sed 's/^ *\[ *[0-9]*\] *//' | awk '
$1 ~ /^\.(data|bss|tdata|tbss|init_array|ctors|fini_array|dtors)/ && $1 !~ /^\.data\.rel\.ro/ && $5 !~ /^0+$/ {
    print $1
}' >"$tmp/data"
[ ! -s "$tmp/data" ] || fail "writable data or constructors in the library:" $(sort -u "$tmp/data")
! grep -q '^COM' "$tmp/static" || fail "common symbols in the library:" $(awk '$1 == "COM" { print $2 }' "$tmp/static")
readelf -WS "$static" | grep -q '\.text' || fail "readelf's output was not understood"
echo "test_names: $(wc -l <"$tmp/header") functions: ok"

#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# Installation: what `make install` leaves is all that C and C++ programs need, wherever it goes, and `make uninstall`
# removes it.
set -eu
fail() { echo "test_install: $*" >&2; exit 1; }
tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT
trap 'exit 1' HUP INT TERM
# the caller's make and its variables are none of our business
unset MAKEFLAGS MFLAGS GNUMAKEFLAGS MAKELEVEL DESTDIR PREFIX prefix exec_prefix libdir includedir datarootdir mandir
unset CPPFLAGS LDFLAGS WARNINGS
run_make() {
    $MAKE -s -C "$S" B="$tmp/build" CC="$CC" CXX="$CXX" CFLAGS=-O1 "$@" >"$tmp/log" 2>&1 ||
        { cat "$tmp/log"; fail "make $* fails"; }
}
# pkg-config of the installation whose libdir is $1
config() { dir=$1 && shift && PKG_CONFIG_PATH="$dir/pkgconfig" $PKG_CONFIG "$@" nlcontact; }
is() { [ "$1" = "$2" ] || fail "$3 is '$1' and should be '$2'"; }

cat >"$tmp/program.c" <<'EOF'
#include <nlcontact.h>

int main(int argc, char **argv)
{
    const char *a = argc > 1 ? argv[1] : "", *b = nlc_version();
    while (*a && *a == *b) a++, b++;
    return *a == *b && nlc_hertz_overlap(3, nlc_hertz_force(3, 4.0)) == 4 ? 0 : 1;
}
EOF
cp "$tmp/program.c" "$tmp/program.cc"

# A prefix of one's own: C and C++, with the shared library.
home=$tmp/home
run_make -j2 install DESTDIR= PREFIX="$home"
{
    echo include/nlcontact.f90
    echo include/nlcontact.h
    for name in libnlcontact.a libnlcontact.so libnlcontact.so.0 libnlcontact.so."$VERSION" pkgconfig/nlcontact.pc; do
        echo "lib/$name"
    done
    (cd "$S/man" && for page in *.3; do echo "share/man/man3/$page"; done)
} | LC_ALL=C sort >"$tmp/expected"
(cd "$home" && find . ! -type d) | sed 's|^\./||' | LC_ALL=C sort >"$tmp/found"
diff "$tmp/expected" "$tmp/found" || fail "expected (<) and installed (>) files differ"
is "$(config "$home/lib" --modversion)" "$VERSION" "the version in nlcontact.pc"
is "$(config "$home/lib" --define-variable=prefix=/elsewhere --variable=libdir)" /elsewhere/lib "libdir below another prefix"
is "$(readelf -d "$home/lib/libnlcontact.so" | sed -n 's/.*(SONAME).*\[\(.*\)\]/\1/p')" libnlcontact.so.0 "the SONAME"
for language in c cc; do
    case $language in c) compiler=$CC ;; *) compiler=$CXX ;; esac
    $compiler "$tmp/program.$language" -o "$tmp/program" $(config "$home/lib" --cflags --libs) ||
        fail "$compiler does not find the installed header or shared library"
    readelf -d "$tmp/program" | grep -q 'NEEDED.*libnlcontact\.so\.0\]' || fail "the program does not need libnlcontact.so.0"
    LD_LIBRARY_PATH="$home/lib" ${EMULATOR-} "$tmp/program" "$VERSION" || fail "the program with the shared library fails"
done

# Only the static library is there.
rm "$home"/lib/libnlcontact.so*
for language in c cc; do
    case $language in c) compiler=$CC ;; *) compiler=$CXX ;; esac
    $compiler "$tmp/program.$language" -o "$tmp/program" $(config "$home/lib" --static --cflags --libs) ||
        fail "$compiler does not find the installed header or static library"
    ${EMULATOR-} "$tmp/program" "$VERSION" || fail "the program with the static library fails"
done

# A package being made: other folders, from the same build, staged in DESTDIR.
stage=$tmp/stage
where="DESTDIR=$stage PREFIX=/opt/nlc libdir=/opt/nlc/lib/some-tuple includedir=/opt/include/nlc-0"
run_make install $where
libdir=$stage/opt/nlc/lib/some-tuple
is "$(config "$libdir" --variable=prefix)" /opt/nlc "prefix in nlcontact.pc"
is "$(config "$libdir" --variable=libdir)" /opt/nlc/lib/some-tuple "libdir in nlcontact.pc"
is "$(config "$libdir" --variable=includedir)" /opt/include/nlc-0 "includedir in nlcontact.pc"
[ -f "$stage/opt/include/nlc-0/nlcontact.h" ] || fail "includedir has no header"
! grep -rlF "$tmp" "$stage" || fail "these files know where they were staged or built"

run_make uninstall $where
left=$(find "$stage" ! -type d)
[ -z "$left" ] || fail "uninstall leaves:" $left
echo "test_install: shared, static, C, C++, staged, uninstalled: ok"

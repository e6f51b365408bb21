#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# Debian packages: they build, lintian finds nothing, and a program builds and runs with what is in them.
# Half a minute, so only with NLC_TEST_FULL=1 and where dpkg-buildpackage, debhelper and lintian are installed.
set -eu
fail() { echo "test_debian: $*" >&2; exit 1; }
[ -n "${NLC_TEST_FULL-}" ] || { echo "test_debian: not run: NLC_TEST_FULL=1 runs it"; exit 0; }
for tool in dpkg-buildpackage dh lintian; do
    command -v $tool >/dev/null || { echo "test_debian: not run: no $tool"; exit 0; }
done
[ -d "$S/debian" ] || { echo "test_debian: not run: the archive has no debian"; exit 0; }
tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT
trap 'exit 1' HUP INT TERM
unset MAKEFLAGS MFLAGS GNUMAKEFLAGS MAKELEVEL
logged() { "$@" >"$tmp/log" 2>&1 || { tail -n 40 "$tmp/log"; fail "$* fails"; }; }

DEB_BUILD_OPTIONS=nocheck logged $MAKE -s -C "$S" B="$tmp/build" deb
cd "$tmp/build/deb"
lintian --allow-root -I --pedantic --fail-on error,warning,info,pedantic ./*.changes >"$tmp/lintian" 2>&1 ||
    { cat "$tmp/lintian"; fail "lintian has complaints"; }

mkdir "$tmp/root"
for package in libnlcontact0 libnlcontact-dev; do dpkg-deb -x "$package"_"$VERSION"-*.deb "$tmp/root"; done
libdir=$(echo "$tmp"/root/usr/lib/*)
[ ! -e "$tmp/root/usr/local" ] && [ -e "$libdir/libnlcontact.so.0" ] || fail "things are in the wrong place"
gcc "$S/tests/abi/0.1/program.c" -o "$tmp/program" -lm \
    $(PKG_CONFIG_SYSROOT_DIR="$tmp/root" PKG_CONFIG_LIBDIR="$libdir/pkgconfig" $PKG_CONFIG --cflags --libs nlcontact) \
    -I"$tmp/root/usr/include" -L"$libdir" || fail "a program does not build with the packages"
LD_LIBRARY_PATH="$libdir" "$tmp/program" || fail "a program built with the packages fails"
echo "test_debian: packages, lintian, a program: ok"

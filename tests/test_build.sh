#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# Building: the source archive and the libraries have the same bytes every time and wherever they are made, any folder will do
# to build in, and nothing is built twice.
set -eu
fail() { echo "test_build: $*" >&2; exit 1; }
tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT
trap 'exit 1' HUP INT TERM
# the caller's make and its variables are none of our business
unset MAKEFLAGS MFLAGS GNUMAKEFLAGS MAKELEVEL B CPPFLAGS LDFLAGS WARNINGS
run_make() {
    $MAKE -s CC="$CC" CXX="$CXX" CFLAGS="-O1 -g" "$@" >"$tmp/log" 2>&1 || { cat "$tmp/log"; fail "make $* fails"; }
}

# The targets that `make help` lists are those that are not files.
$MAKE -s -C "$S" B="$tmp/none" help >"$tmp/help" || fail "make help fails"
for target in all check examples stress demo bench accuracy figures setup install uninstall dist deb distcheck abi-check abi-baseline clean; do
    grep -q "^  make $target  *[a-z]" "$tmp/help" || fail "make help does not list $target"
done
phony=" $(sed -n 's/^\.PHONY: *//p' "$S/Makefile" | tr '\n' ' ') "
for target in $(sed -n 's/^  make \([a-z-]*\) .*/\1/p' "$tmp/help"); do
    case $phony in *" $target "*) ;; *) fail "$target is not .PHONY: a file of that name would hide it" ;; esac
done
[ ! -e "$tmp/none" ] || fail "make help builds something"

# Every place that names the version names the same one.  (debian/ is not in the archive.)
names_version() { # file, pattern of what stands around it
    [ "$(sed -n "s/$2/\\1/p" "$S/$1" | head -n 1)" = "$VERSION" ] || fail "$1 names another version than the header"
}
names_version CITATION.cff '^version: *\(.*\)'
names_version NEWS '^\([0-9][0-9.]*\) (.*'
names_version packaging/package.py '^    version("\(.*\)").*'
names_version packaging/nlcontact.eb "^version = '\(.*\)'"
[ ! -d "$S/debian" ] || names_version debian/changelog '^nlcontact (\([0-9.]*\)-.*'

# The archive, three times: under another umask, locale and time zone, and from an unpacked archive, owned and dated
# otherwise.
archive=nlcontact-$VERSION.tar.gz
run_make -C "$S" B="$tmp/1" dist
(umask 077 && LC_ALL=C TZ=Asia/Tokyo && export LC_ALL TZ && run_make -C "$S" B="$tmp/2" dist)
cmp "$tmp/1/$archive" "$tmp/2/$archive" || fail "make dist gives other bytes the second time"
(umask 077 && cd "$tmp" && gzip -dc "1/$archive" | tar --no-same-permissions -xf -)
source=$tmp/nlcontact-$VERSION
find "$source" -exec touch {} +
run_make -C "$source" B="$tmp/3" dist
[ "$(od -An -tx1 -N8 "$tmp/1/$archive")" = " 1f 8b 08 00 00 00 00 00" ] ||
    fail "the archive holds its name or the time"
cmp "$tmp/1/$archive" "$tmp/3/$archive" || fail "make dist gives other bytes in an unpacked archive"
for folder in lib man tests; do
    gzip -dc "$tmp/1/$archive" | tar -tf - | grep "/$folder/" | LC_ALL=C sort -c ||
        fail "the archive is in the order of the disk"
done
for file in Makefile README NEWS CONTRIBUTING SECURITY COPYING CITATION.cff nlcontact.pc.in nlcontact-config.cmake.in nlcontact-config-version.cmake.in include/nlcontact.h lib/nlcontact.map man/nlcontact.3 tests/run; do
    [ -s "$source/$file" ] || fail "the archive has no $file"
done

# The archive builds, from another folder, and a second time there is nothing to do.
mkdir "$tmp/elsewhere"
cd "$tmp/elsewhere"
(cd "$source" && find . | sort) >"$tmp/before"
run_make -j2 -f "$source/Makefile" lib
(cd "$source" && find . | sort) >"$tmp/after"
diff "$tmp/before" "$tmp/after" || fail "building in another folder changes the source folder"
for file in libnlcontact.a libnlcontact.so libnlcontact.so."$VERSION"; do
    [ -s "build/$file" ] || fail "make lib makes no $file"
done
$MAKE -q -f "$source/Makefile" CC="$CC" CXX="$CXX" CFLAGS="-O1 -g" lib || fail "make lib has something to do the second time"

# The same bytes from inside the sources, in a folder of another name, and from a copy of the sources, dated otherwise; debug
# information included.
cp -r "$source" "$tmp/copy"
find "$tmp/copy" -exec touch -d '2001-02-03 04:05:06' {} +
(umask 077 && LC_ALL=C TZ=Asia/Tokyo && export LC_ALL TZ && run_make -j2 -C "$tmp/copy" B=a/folder/to/build/in lib)
(cd "$source/lib" && run_make -j2 -f ../Makefile B="$tmp/absolute" lib)
# From a folder with a space in its name, by way of a symbolic link to it.
cp -r "$source" "$tmp/a copy"
ln -s "a copy" "$tmp/link to a copy"
(cd "$tmp/link to a copy" && run_make -j2 lib)
for file in libnlcontact.a libnlcontact.so."$VERSION"; do
    for other in "$tmp/copy/a/folder/to/build/in" "$tmp/absolute" "$tmp/a copy/build"; do
        cmp "build/$file" "$other/$file" || fail "$file has other bytes when it is built in another folder"
    done
    ! grep -qF "$tmp" "build/$file" || fail "$file knows where it was built"
done
touch "$source/include/nlcontact.h"
! $MAKE -q -f "$source/Makefile" CC="$CC" CXX="$CXX" CFLAGS="-O1 -g" lib || fail "make lib does not see a changed header"
run_make -f "$source/Makefile" clean
[ ! -e build ] || fail "make clean leaves something"
echo "test_build: help, dist, build elsewhere, build twice, the same bytes everywhere: ok"

#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# Installation: what `make install` leaves is all that C and C++ programs need, by pkg-config and by CMake, wherever it goes,
# and `make uninstall` removes it.
set -eu
fail() { echo "test_install: $*" >&2; exit 1; }
tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT
trap 'exit 1' HUP INT TERM
# the caller's make and its variables are none of our business
unset MAKEFLAGS MFLAGS GNUMAKEFLAGS MAKELEVEL DESTDIR PREFIX prefix exec_prefix libdir includedir datarootdir mandir
unset pkgconfigdir cmakedir CPPFLAGS LDFLAGS WARNINGS
run_make() {
    $MAKE -s -C "$S" B="$tmp/build" CC="$CC" CXX="$CXX" CFLAGS=-O1 "$@" >"$tmp/log" 2>&1 ||
        { cat "$tmp/log"; fail "make $* fails"; }
}
# pkg-config of the installation whose libdir is $1
config() { dir=$1 && shift && PKG_CONFIG_PATH="$dir/pkgconfig" $PKG_CONFIG "$@" nlcontact; }
is() { [ "$1" = "$2" ] || fail "$3 is '$1' and should be '$2'"; }
needs_shared() { readelf -d "$1" | grep -q 'NEEDED.*libnlcontact\.so\.0\]'; }

cat >"$tmp/program.c" <<'END'
#include <nlcontact.h>

int main(int argc, char **argv)
{
    const char *a = argc > 1 ? argv[1] : "", *b = nlc_version();
    while (*a && *a == *b) a++, b++;
    return *a == *b && nlc_hertz_overlap(3, nlc_hertz_force(3, 4.0)) == 4 ? 0 : 1;
}
END
cp "$tmp/program.c" "$tmp/program.cc"

# CMake, where there is one and the programs are for this machine: the library below $1 gives the targets $2, which programs link
# with and which run; of what is not there nothing is promised.
mkdir "$tmp/project"
cp "$tmp/program.c" "$tmp/project/"
cat >"$tmp/project/CMakeLists.txt" <<'END'
cmake_minimum_required(VERSION 3.13)
project(host C)
find_package(nlcontact 9.0 QUIET)
if(nlcontact_FOUND)
    message(FATAL_ERROR "a version that is not there is found")
endif()
foreach(kind static shared)
    if(NOT kind IN_LIST KINDS)
        find_package(nlcontact QUIET COMPONENTS ${kind} PATHS ${CMAKE_PREFIX_PATH} NO_DEFAULT_PATH)
        if(nlcontact_FOUND)
            message(FATAL_ERROR "a ${kind} library that is not there is found")
        endif()
    endif()
endforeach()
find_package(nlcontact 0.1 REQUIRED COMPONENTS ${KINDS})
find_package(nlcontact 0.1 REQUIRED)
if(NOT nlcontact_VERSION STREQUAL EXPECTED)
    message(FATAL_ERROR "version ${nlcontact_VERSION}")
endif()
if(NOT EXISTS "${NLCONTACT_FORTRAN_MODULE}")
    message(FATAL_ERROR "no Fortran module ${NLCONTACT_FORTRAN_MODULE}")
endif()
foreach(kind nlcontact ${KINDS})
    add_executable(with_${kind} program.c)
    target_link_libraries(with_${kind} nlcontact::${kind})
endforeach()
END
with_cmake='and CMake'
if [ -n "${EMULATOR-}" ] || ! command -v cmake >/dev/null; then with_cmake='(no CMake)'; fi
cmake_finds() {
    [ "$with_cmake" = 'and CMake' ] || return 0
    rm -rf "$tmp/cmake"
    { CC="$CC" CFLAGS="${CFLAGS-}" cmake -S "$tmp/project" -B "$tmp/cmake" -G 'Unix Makefiles' -DCMAKE_PREFIX_PATH="$1" -DKINDS="$2" \
        -DEXPECTED="$VERSION" &&
        cmake --build "$tmp/cmake"; } >"$tmp/log" 2>&1 || { cat "$tmp/log"; fail "CMake does not build with the library below $1"; }
    for kind in nlcontact $(echo "$2" | tr ';' ' '); do
        "$tmp/cmake/with_$kind" "$VERSION" || fail "a program that CMake linked with nlcontact::$kind fails"
    done
    case $2 in
    *shared*) needs_shared "$tmp/cmake/with_nlcontact" || fail "nlcontact::nlcontact is not the shared library" ;;
    esac
    case $2 in
    *static*) ! needs_shared "$tmp/cmake/with_static" || fail "nlcontact::static is the shared library" ;;
    esac
}

# A prefix of one's own: C and C++, with the shared library.
home=$tmp/home
run_make -j2 install DESTDIR= PREFIX="$home"
{
    echo include/nlcontact.f90
    echo include/nlcontact.h
    for name in libnlcontact.a libnlcontact.so libnlcontact.so.0 libnlcontact.so."$VERSION" pkgconfig/nlcontact.pc \
        cmake/nlcontact/nlcontact-config.cmake cmake/nlcontact/nlcontact-config-version.cmake; do
        echo "lib/$name"
    done
    (cd "$S/man" && for page in *; do echo "share/man/man${page##*.}/$page"; done)
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
    needs_shared "$tmp/program" || fail "the program does not need libnlcontact.so.0"
    LD_LIBRARY_PATH="$home/lib" ${EMULATOR-} "$tmp/program" "$VERSION" || fail "the program with the shared library fails"
done
cmake_finds "$home" 'static;shared'

# Moved as a whole.
mv "$home" "$tmp/moved" && home=$tmp/moved
cmake_finds "$home" 'static;shared'

# Only the static library is there.
rm "$home"/lib/libnlcontact.so*
for language in c cc; do
    case $language in c) compiler=$CC ;; *) compiler=$CXX ;; esac
    $compiler "$tmp/program.$language" -o "$tmp/program" $(config "$home/lib" --define-variable=prefix="$home" --static --cflags --libs) ||
        fail "$compiler does not find the installed header or static library"
    ${EMULATOR-} "$tmp/program" "$VERSION" || fail "the program with the static library fails"
done
cmake_finds "$home" static

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
cmake_finds "$libdir/cmake/nlcontact" 'static;shared'
run_make uninstall $where
left=$(find "$stage" ! -type d)
[ -z "$left" ] || fail "uninstall leaves:" $left

# A folder that make would take apart, or that is another one elsewhere, is refused before anything is touched.
mkdir "$tmp/odd" && touch "$tmp/odd/My"
refused() { # the name of a variable, its value
    ! (cd "$tmp/odd" && $MAKE -s -f "$S/Makefile" B="$B" DESTDIR="$stage" "$3" "$1=$2" >"$tmp/log" 2>&1) || fail "make $3 $1=$2 is not refused"
    grep -q "$1=" "$tmp/log" || { cat "$tmp/log"; fail "make $3 $1=$2 does not say why it is refused"; }
    [ "$(ls "$tmp/odd")" = My ] || fail "make $3 $1=$2 does something"
}
for goal in install uninstall; do
    refused prefix "$tmp/odd/My Files" $goal
    refused DESTDIR "$tmp/odd/My Files" $goal
    refused libdir lib $goal
done

# Each folder's variable moves what belongs there and nothing else, and uninstall follows; what others put there stays.
run_make install DESTDIR="$stage" PREFIX=/p
(cd "$stage" && find . ! -type d | sort) >"$tmp/plain"
run_make uninstall DESTDIR="$stage" PREFIX=/p
moves() { # variable, its value, the folder that moves, whereto
    run_make install DESTDIR="$stage" PREFIX=/p "$1=$2"
    (cd "$stage" && find . ! -type d | sort) >"$tmp/found"
    sed "s|^\.$3/|.$4/|" "$tmp/plain" | sort >"$tmp/expected"
    ! cmp -s "$tmp/plain" "$tmp/expected" || fail "$1 moves nothing"
    diff "$tmp/expected" "$tmp/found" || fail "$1=$2: expected (<) and installed (>) files differ"
    folder=$stage$(grep -v '^\./p/' "$tmp/found" | head -n 1 | sed 's|^\.||; s|/[^/]*$||')
    touch "$folder/another"
    run_make uninstall DESTDIR="$stage" PREFIX=/p "$1=$2"
    left=$(find "$stage" ! -type d)
    is "$left" "$folder/another" "what is left after uninstalling with $1=$2"
    rm "$folder/another"
}
moves prefix /q /p /q
moves exec_prefix /e/x /p/lib /e/x/lib
moves libdir /l /p/lib /l
moves includedir /i /p/include /i
moves datarootdir /d /p/share /d
moves mandir /m /p/share/man /m
moves pkgconfigdir /c /p/lib/pkgconfig /c
moves cmakedir /k /p/lib/cmake/nlcontact /k
[ ! -e "$stage/p/lib/cmake/nlcontact" ] || fail "uninstall leaves the folder of the CMake files"
echo "test_install: shared, static, C, C++, pkg-config $with_cmake, staged, every folder's variable, uninstalled: ok"

#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# The fuzzing programs on their corpus, and on a thousand inputs made from it: `make fuzz` goes on from there.
set -eu
fail() { echo "test_fuzz: $*" >&2; exit 1; }
tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT
trap 'exit 1' HUP INT TERM
cd "$tmp"
replayed=0
for source in "$S"/tests/fuzz/fuzz_*.c; do
    name=$(basename "$source" .c) corpus=$S/tests/fuzz/corpus/$(basename "$source" .c | sed 's/^fuzz_//')
    count=$(find "$corpus" -type f | wc -l)
    [ "$count" -ge 3 ] || fail "$name has no corpus"
    ${EMULATOR-} "$B/tests/fuzz/$name" --random 1000 1 "$corpus" >log 2>&1 || {
        cat log
        [ ! -s fuzz-failed-input ] || od -An -tx1 fuzz-failed-input
        fail "$name fails"
    }
    replayed=$((replayed + count))
done
# what it demands is looked at: an input without bytes is one, too
${EMULATOR-} "$B/tests/fuzz/fuzz_network" </dev/null >log 2>&1 || fail "an empty input fails"
echo "test_fuzz: $replayed files, 1000 altered ones for each program: ok"

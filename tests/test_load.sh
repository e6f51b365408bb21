#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# The programs of `make load` on a small scale: small networks of every kind, one large one,
# a host that goes on, and many contacts in little memory.
set -eu
fail() { echo "test_load: $*" >&2; exit 1; }
run() { ${EMULATOR-} "$B/tests/load/$@" >"$tmp/log" 2>&1 || { cat "$tmp/log"; fail "$* fails"; }; }
tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT
trap 'exit 1' HUP INT TERM
run solves 25000
run contacts 1e5
run contacts 1e5 lean
run soak 4000
done_here='25000 small networks, 1e5 contacts in one of either size, 4000 time steps'
if [ -z "${EMULATOR-}" ]; then # which maps memory in its own way
    run counts 1e7
    done_here="$done_here, 1e7 in arrays"
fi
echo "test_load: $done_here: ok"

#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# LAMMPS as a host: forces, sums and pressure are those of the library called directly, in the first step and after a hundred.
set -eu
fail() { echo "test_lammps: $*" >&2; exit 1; }
tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT
trap 'exit 1' HUP INT TERM
unset MAKEFLAGS MFLAGS GNUMAKEFLAGS MAKELEVEL
lammps=$S/examples/lammps
export OMP_NUM_THREADS=1 ASAN_OPTIONS="${ASAN_OPTIONS-}:detect_leaks=0" TMPDIR="$tmp"

$MAKE -s -C "$S" B="$B" CC="$CC" CXX="$CXX" WARNINGS='-Wall -Wextra -Werror' examples >"$tmp/log" 2>&1 ||
    { cat "$tmp/log"; fail "make examples fails"; }
[ -x "$B/examples/nlc-lammps" ] && [ -z "${EMULATOR-}" ] ||
    { echo "test_lammps: no LAMMPS to link with (make setup-examples installs it): skipped"; exit 0; }
under=
run() { # script name variables...
    (cd "$tmp" && $under "$B/examples/nlc-lammps" -in "$lammps/$1" -log "$2.log" -var out "$2" $3 >"$2.out" 2>&1) ||
        { tail -5 "$tmp/$2.out"; fail "$1 $3 fails"; }
}
near() { # what found expected relative
    awk -v a="$2" -v b="$3" -v t="$4" 'BEGIN { d = a - b; exit !(a != "" && b != "" && d <= t * (b < 0 ? -b : b) && -d <= t * (b < 0 ? -b : b)) }' ||
        fail "$1: $2 in LAMMPS, $3 by the library"
}
thermo() { awk -v step="$2" -v column="$3" '$1 == "Step" { on = 1; next } on && $1 == step { print $column; exit }' "$tmp/$1.log"; }
row() { sed -n "s/^$1,[^,]*,[^,]*,//p" "$tmp/expected"; }

# LAMMPS' forces on the particles, its own Hertz included, are the sums of P n over the contacts.  1e-9 of the largest: printed
# with 16 digits, of sums of forces that cancel.
forces() {
    awk -F'[ ,]' '
        FNR == 1 { file++ }
        file == 1 && FNR > 9 { for (k = 0; k < 3; k++) F[$1, k] = $(7 + k); n++ }
        file == 2 && FNR > 1 {
            if ($4 > most) most = $4
            for (k = 0; k < 3; k++) { F[$1, k] += $4 * $(6 + k); if ($2 > 0) F[$2, k] -= $4 * $(6 + k) }
        }
        END { for (key in F) { f = F[key]; if (f < 0) f = -f; if (f > worst) worst = f }
              if (!(n > 0 && most > 0 && worst <= 1e-9 * most)) { print worst, most; exit 1 } }' "$tmp/$1.dump" "$tmp/$1.csv" >"$tmp/log" ||
        fail "forces on particles, $1: off by, of: $(cat "$tmp/log")"
}

# The packing as LAMMPS left it, solved by the packing program.
compare() { # name step packing model wall-columns
    {
        sed -n '/^#/p' "$S/bench/data/$3.csv" && echo id,x,y,z,radius,type
        awk 'NR > 9 { print $1 "," $2 "," $3 "," $4 "," $5 "," $6 }' "$tmp/$1.$2.dump"
    } >"$tmp/now.csv"
    "$B/bench/packing" --csv --model "$4" "$tmp/now.csv" >"$tmp/all"
    cut -d, -f1,2,3,4 "$tmp/all" >"$tmp/expected"
    near "$1, step $2, sum of forces" "$(thermo "$1" "$2" 10)" "$(row total_force)" 1e-7
    near "$1, step $2, coordination" "$(thermo "$1" "$2" 9)" "$(row coordination)" 1e-9
    forces "$1.$2"
    found=$(awk -F, 'NR > 1 { if ($3 <= 0 && $4 > 0) made++; if ($3 > 0 && $4 == 0) lost++ } END { print made + 0, lost + 0 }' "$tmp/$1.$2.csv")
    [ "$found" = "$(row created) $(row lost)" ] || fail "$1, step $2: made and lost $found, by the library $(row created) $(row lost)"
}
data() { awk -f "$lammps/data.awk" "$S/bench/data/$1.csv" >"$tmp/$1.data"; }

data c_hydrogel514_strain13
run in.packing die "-var data c_hydrogel514_strain13.data -var young 23300 -var poisson 0.4999 -var nlc_model sphere"
compare die 0 c_hydrogel514_strain13 sphere
run in.packing let_go "-var data c_hydrogel514_strain13.data -var young 23300 -var poisson 0.4999 -var steps 100 -var dt 2e-4"
compare let_go 0 c_hydrogel514_strain13 gonzalez-cuitino
compare let_go 100 c_hydrogel514_strain13 gonzalez-cuitino
data a_mono1000_periodic
run in.packing periodic "-var data a_mono1000_periodic.data -var periodic 1 -var steps 100 -var dt 2e-6"
compare periodic 0 a_mono1000_periodic gonzalez-cuitino
near "periodic, pressure" "$(thermo periodic 0 5)" "$(row pressure)" 1e-7
compare periodic 100 a_mono1000_periodic gonzalez-cuitino

# Solved every fourth step only: what is extrapolated over so little is right to 1e-4.
run in.packing interval "-var data a_mono1000_periodic.data -var periodic 1 -var steps 102 -var dt 2e-7 -var nlc_interval 4"
run in.packing each "-var data a_mono1000_periodic.data -var periodic 1 -var steps 102 -var dt 2e-7"
near "interval, sum of forces" "$(thermo interval 102 10)" "$(thermo each 102 10)" 1e-4
[ "$(thermo interval 102 6) $(thermo each 102 6)" != "0 0" ] && [ "$(thermo interval 102 6)" = 0 ] || fail "nothing is extrapolated"

# With nlc_turning the forces are all of -dE/dx, and LAMMPS' nve keeps kinetic energy plus that of the network to the second order of
# the time step: with half of it a quarter is missing.  Along the normals alone it does not.
change() { awk '/^ *Step/ { on = 1; next } /^Loop/ { on = 0 } on { if (!n++) first = $4; last = $4; ke = $2 } END { printf "%.9g", (last - first) / ke }' "$tmp/$1.log"; }
mono="-var data a_mono1000_periodic.data -var periodic 1"
run in.packing turning "$mono -var steps 50 -var dt 1e-6 -var nlc_turning 1"
run in.packing finer "$mono -var steps 100 -var dt 5e-7 -var nlc_turning 1"
run in.packing normals "$mono -var steps 100 -var dt 5e-7"
awk -v a="$(change turning)" -v b="$(change finer)" -v c="$(change normals)" 'BEGIN { r = a / b; exit !(r > 3.6 && r < 4.4 && b * b < 1e-6 && c * c > 9 * b * b) }' ||
    fail "energy with turning changes by $(change turning), $(change finer) with half the time step, $(change normals) without"

# A grain between two plates with two neighbours.  One, 50 degrees from the pole, overlaps, and its contact is drawn open: LAMMPS
# adds Hertz' force and the callback takes it away.  The other one, at the equator, does not touch, and is pushed.
cat >"$tmp/three.data" <<EOF
# three grains

3 atoms
1 atom types

-3 3 xlo xhi
-3 3 ylo yhi
-0.97 0.97 zlo zhi

Atoms # sphere

1 1 2 1000 0 0 0
2 1 0.3 1000 0.8808746 0 0.7391418
3 1 1 1000 -1.5001 0 0
EOF
run in.packing three "-var data three.data"
forces three.0
awk -F, 'NR > 1 && $2 > 0 {
    if ($1 + $2 == 3) lost = $3 > 0 && $4 == 0 && $5 > 0
    if ($1 + $2 == 4) made = $3 < 0 && $4 > 0 && $5 == 0
} END { exit !(lost && made) }' "$tmp/three.0.csv" || { cat "$tmp/three.0.csv"; fail "no contact is drawn open, or none made"; }
awk '$1 == 2 && NR > 9 { open = $7 * $7 + $9 * $9 } $1 == 3 && NR > 9 { pushed = -$7 } END { exit !(open < 1e-24 * pushed * pushed && pushed > 0) }' \
    "$tmp/three.0.dump" || { cat "$tmp/three.0.dump"; fail "forces on the neighbours are wrong"; }

# A grain that flies at another one from beyond the reach: found on its way, while LAMMPS keeps its list.
sed '/^3 1 1 /s/-1.5001/-1.99/' "$tmp/three.data" >"$tmp/flying.data"
printf '\nVelocities\n\n1 0 0 0 0 0 0\n2 0 0 0 0 0 0\n3 2600 0 0 0 0 0\n' >>"$tmp/flying.data"
run in.packing flying "-var data flying.data -var steps 100 -var dt 2e-6"
awk -F, 'NR > 1 && $1 + $2 == 4 && $2 > 0 && $3 > 0.01 && $4 > 0 { met = 1 } END { exit !met }' "$tmp/flying.100.csv" ||
    { cat "$tmp/flying.100.csv"; fail "grains that meet are not found"; }

# On several ranks, more than there may be processors: the same forces to 1e-12 of the largest and, a hundred steps later, the same
# energies to 1e-9.  The packing drifts through its periodic box by half of a rank's part of it, so particles change ranks.  The
# tolerance is so small that rounding alone is left.
ranks=
same_forces() {
    awk 'FNR == 1 { file++ } FNR <= 9 { next }
        { for (k = 7; k <= 9; k++) { if (file == 1) F[$1, k] = $k; d = $k - F[$1, k]; d = d < 0 ? -d : d; a = $k < 0 ? -$k : $k
          if (d > worst) worst = d; if (a > most) most = a } n[file]++ }
        END { if (!(n[1] > 0 && n[1] == n[2] && worst <= 1e-12 * most)) { print worst, most; exit 1 } }' "$tmp/$1.dump" "$tmp/$2.dump" >"$tmp/log" ||
        fail "forces of $1 and $2 differ by, of: $(cat "$tmp/log")"
}
# Who owns what is in the dump's last column.  Particles under load with neighbours on two other ranks or more, so that they are ghosts
# on these; contacts of two ranks, both of whose ends are ghosts of a third one; and particles that have another owner at the end.
meetings() {
    awk -F'[ ,]' '
        FNR == 1 { file++ }
        file == 1 && FNR > 9 { owner[$1] = $12 }
        file == 2 && FNR > 1 && $2 > 0 && $4 > 0 && owner[$1] != owner[$2] { i[++n] = $1; j[n] = $2; on[$1, owner[$2]] = 1; on[$2, owner[$1]] = 1 }
        file == 3 && FNR > 9 { moved += owner[$1] != $12 }
        END { for (k in owner) { m = on[k, 0] + on[k, 1] + on[k, 2] + on[k, 3]; several += m > 1; three += m > 2 }
              for (c = 1; c <= n; c++) for (r = 0; r < 4; r++) if (on[i[c], r] && on[j[c], r]) { seen++; break }
              print n + 0, several + 0, three + 0, seen + 0, moved + 0 }' "$tmp/$1.0.dump" "$tmp/$1.0.csv" "$tmp/$1.100.dump"
}
sweeps() { sed -n 's/^nlc: .* \([0-9.]*\) sweeps a step.*/\1/p' "$tmp/$1.out"; }
if command -v mpirun >/dev/null; then
    export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_mpi_yield_when_idle=1 \
        OMPI_MCA_rmaps_base_oversubscribe=1 OMPI_MCA_hwloc_base_binding_policy=none
    for n in 1 2 4; do
        under="mpirun -np $n"
        run in.packing drift$n "-var data a_mono1000_periodic.data -var periodic 1 -var steps 100 -var dt 2e-6 -var drift 25 -var nlc_tolerance 1e-13"
        same_forces drift1.0 drift$n.0
        for column in 2 3; do
            near "$n ranks, energy" "$(thermo drift$n 100 $column)" "$(thermo drift1 100 $column)" 1e-9
        done
        run in.packing turning$n "$mono -var steps 20 -var dt 2e-6 -var nlc_tolerance 1e-13 -var nlc_turning 1"
        same_forces turning1.0 turning$n.0
        near "$n ranks, energy with turning" "$(thermo turning$n 20 2)" "$(thermo turning1 20 2)" 1e-9
        near "$n ranks, sweeps" "$(sweeps drift$n)" "$(sweeps drift1)" 0.02 # the start has come along with the particles
        run in.packing walls$n "-var data c_hydrogel514_strain13.data -var young 23300 -var poisson 0.4999 -var nlc_model sphere -var nlc_tolerance 1e-13"
        same_forces walls1.0 walls$n.0
        near "$n ranks, sum of forces" "$(thermo walls$n 0 10)" "$(thermo walls1 0 10)" 1e-12
        forces walls$n.0
    done
    under=
    set -- $(meetings drift4)
    [ "$1" -gt 100 ] && [ "$2" -gt 20 ] && [ "$3" -gt 2 ] && [ "$4" -gt 20 ] && [ "$5" -gt 100 ] ||
        fail "4 ranks: $1 contacts between ranks, $2 particles that meet two others, $3 three, $4 contacts that a third one sees, $5 moved"
    ranks=", 1, 2 and 4 ranks ($1 contacts between them, $2 particles that meet two others, $3 three, $5 have moved)"
else
    ranks=' (no mpirun: not looked at on several ranks)'
fi

# The compression's plate comes down: what is printed is the sum over the contacts at that wall, the sixth.
data c_hydrogel514_rest
run in.compression plate "-var data c_hydrogel514_rest.data -var settle 0 -var steps 200 -var hold 0 -var strain 0.02"
near "force on the plate" "$(sed -n '$p' "$tmp/plate.csv" | cut -d, -f3)" \
    "$(awk -F, '$2 == -6 && $8 == 1 { sum += $4 } END { print sum }' "$tmp/plate.200.csv")" 1e-5
awk -F, 'NR == 2 { before = $3 } END { exit !($2 == 0.02 && $3 > 10 * before) }' "$tmp/plate.csv" || fail "the plate does not come down"
$CC -std=c11 -D_POSIX_C_SOURCE=200809L -Wall -Wextra -Werror -I"$S/bench" -o "$tmp/plot" "$lammps/plot.c" "$S/bench/line_chart.c" -lm
(cd "$tmp" && mv plate.csv hertz.csv && mv plate.200.csv hertz.200.csv && ./plot picture.svg data.csv 200 hertz >/dev/null && [ -s picture.svg ]) ||
    fail "there is no picture"
sh -n "$S/bench/peers/price"

# Without the fix it is LAMMPS; what is missing is said.
printf 'units si\nprint "just LAMMPS"\n' >"$tmp/plain.in"
(cd "$tmp" && "$B/examples/nlc-lammps" -in plain.in | grep -q '^just LAMMPS') || fail "a script without the fix does not run"
(cd "$tmp" && ! "$B/examples/nlc-lammps" -in "$lammps/in.packing" -var data three.data -var nlc_model sponge >out 2>&1) || fail "a sponge is a model"
grep -q "there is no model 'sponge'" "$tmp/out" || { cat "$tmp/out"; fail "a wrong model is not named"; }
[ -z "$(ls "$tmp" | grep nlc-lammps)" ] || fail "pieces of scripts are left behind"
echo "test_lammps: walls, periodic, opened and made contacts$ranks: ok"

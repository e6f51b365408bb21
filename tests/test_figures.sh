#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# bench/figures: the numbers that [GC] states, some of [MC], and others by closed forms and by solutions of [GC]'s equations in
# awk that share nothing with the library.
set -eu
export LC_ALL=C
fail() { echo "test_figures: $*" >&2; exit 1; }
tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT
trap 'exit 1' HUP INT TERM
${EMULATOR-} "$B/bench/figures/figures" "$S/bench" "$tmp" >"$tmp/out" || fail "figures fails"

for name in fig02_surface fig07_rubber_sphere fig08_lateral_plates fig10_cubic_crystals fig11_rotated_square fig12_close_packed \
    fig13_preloaded_square fig14_preloaded_forces fig16_bcc_hydrostatic fig17_bcc_die fig19_bed_loads; do
    tail -n 1 "$tmp/$name.svg" | grep -q '^</svg>$' || fail "$name.svg is not a whole picture"
    ! grep -qiE 'nan|inf[^o]' "$tmp/$name.svg" || fail "$name.svg shows numbers that are none"
    [ "$(wc -l <"$tmp/$name.csv")" -gt 100 ] || fail "$name.csv has hardly any points"
done

number() { # FIGURE WHAT
    awk -F, -v f="$1" -v w="$2" '$1 == f && $2 == w { print $3 }' "$tmp/numbers.csv"
}
at() { # FILE PANEL CURVE X
    awk -F, -v p="$2" -v c="$3" -v x="$4" '$1 == p && $2 == c && ($3 - x)^2 < 1e-16 { print $4; exit }' "$tmp/$1.csv"
}
near() { # VALUE EXPECTED ABSOLUTE-TOLERANCE WHAT
    awk -v a="$1" -v b="$2" -v t="$3" 'BEGIN { exit !(a != "" && a + 0 == a && (a - b)^2 <= t * t) }' ||
        fail "$4: ${1:-nothing}, expected $2 +- $3"
}
above() { # VALUE LOW WHAT
    awk -v a="$1" -v b="$2" 'BEGIN { exit !(a != "" && a + 0 == a && a > b) }' ||
        fail "$3: ${1:-nothing}, expected more than $2"
}

# What [GC] states, to the digits stated.
near "$(number fig16 'Case I: second contacts nu 0.45')" 0.95 0.005 'second contacts, hydrostatic'
near "$(number fig17 'Case I: second contacts nu 0.45')" 0.780 0.0005 'second contacts, die'
near "$(number fig16 'Case I: D at full density nu 0.44')" 2 0.05 '200 % near full compaction'
near "$(number fig12 'Case I: close-packed D at 0.1 nu 0.5')" 0.40 0.01 '40 % in two dimensions'
above "$(number fig12 'Case I: gap / R at 0.1 nu 0')" 0 'a gap between horizontal neighbours'
near "$(number fig12 'Case I: gap up to nu at 0.1')" 0.25 0.2 'and none for large nu'
# "1.04" and "0.786" there are pi/3 and pi/4
near "$(number fig16 'Hertz: second contacts nu 0.45')" 1.0471976 2e-6 'second contacts, hydrostatic, Hertz'
near "$(number fig17 'Hertz: second contacts nu 0.45')" 0.7853982 2e-6 'second contacts, die, Hertz'
# third contacts, 0.96 there: not on the stable branch; the end by Newton's method on the reduced equations, in a program apart
[ "$(number fig17 'Case I: third contacts nu 0.46')" = none ] || fail "third contacts form"
near "$(number fig17 'Case I: end of the stable branch nu 0.46')" 0.96342289 2e-7 'end of the branch, die'

# The equations again, for crystals of equal spheres, R = E = 1, by plain iteration; a contact's image at -n has the same force.
# Prints D of the load and the gap of the third contact, in a cell of bcc those of the second and third neighbours.
cat >"$tmp/oracle.awk" <<'END'
function contact(x, y, z) { n++; d = sqrt(x * x + y * y + z * z); X[n] = x / d; Y[n] = y / d; Z[n] = z / d; overlap[n] = 2 - d }
function w(s) { return (1 + nu) / (4 * pi) * (-2 * (1 - nu) - 2 * (1 - 2 * nu) * s + (7 - 8 * nu) * s * s) / s }
function half(a, b, sign) { return sqrt((X[a] - sign * X[b])^2 + (Y[a] - sign * Y[b])^2 + (Z[a] - sign * Z[b])^2) / 2 }
function coupling(    a, b) { # of both spheres
    for (a = 1; a <= n; a++)
        for (b = 1; b <= n; b++) C[a, b] = 2 * w(half(a, b, -1)) + (a == b ? 0 : 2 * w(half(a, b, 1)))
}
function law(x) { return x > 0 ? sqrt(2) / 3 / (1 - nu * nu) * x * sqrt(x) : 0 }
function sweep(    a, b, force, change) {
    change = 0
    for (a = 1; a <= n; a++) {
        x[a] = overlap[a]
        for (b = 1; b <= n; b++) x[a] += C[a, b] * P[b]
    }
    for (a = 1; a <= n; a++) {
        force = law(x[a])
        if ((force - P[a])^2 > change) change = (force - P[a])^2
        P[a] = force
    }
    return change
}
function cell(x, z) {
    contact(x, x, z); contact(x, -x, z); contact(x, x, -z); contact(x, -x, -z)
    contact(0, 0, 2 * z); contact(2 * x, 0, 0); contact(0, 2 * x, 0)
}
BEGIN {
    pi = atan2(0, -1)
    edge = 2 / sqrt(3); small = pi * sqrt(3) / 8 / at # at: eps or relative density
    bcc = type == "die" || type == "hydrostatic"
    if (type == "1-D") contact(0, 0, 2 - 2 * at)
    if (type == "square") { contact(0, 0, 2 - 2 * at); contact(2, 0, 0) }
    if (type == "3-D") { contact(0, 0, 2 - 2 * at); contact(2, 0, 0); contact(0, 2, 0) }
    r = sqrt(2)
    if (type == "rotated square") { contact(r, 0, r * (1 - at)); contact(r, 0, r * (at - 1)) }
    if (type == "close-packed") { contact(1, 0, sqrt(3) * (1 - at)); contact(1, 0, -sqrt(3) * (1 - at)); contact(2, 0, 0) }
    if (type == "preloaded square") { contact(0, 0, 1.92 - 2 * at); contact(1.92, 0, 0) }
    if (type == "die") cell(edge, edge * small)
    if (type == "hydrostatic") cell(edge * small^(1 / 3), edge * small^(1 / 3))
    coupling()
    for (k = 0; k < 9000 && change < 1e6; k++) if ((change = sweep()) < 1e-26) break
    if (k == 9000 || change >= 1e6) { print "none none none"; exit }
    load = P[1]; hertz = law(overlap[1])
    if (bcc) { load = 4 * P[1] * Z[1] + 2 * P[5]; hertz = 4 * law(overlap[1]) * Z[1] + 2 * law(overlap[5]) }
    printf "%.9f %.9f\n", load / hertz - 1, -x[bcc ? 6 : 3]
}
END
oracle() { awk -v type="$1" -v nu="$2" -v at="$3" -f "$tmp/oracle.awk" </dev/null; }
crystal() { # FILE PANEL
    for nu in 0 0.3 0.5; do
        for eps in 0.01 0.1; do
            near "$(at "$1" "$2" "Case I nu $nu" $eps)" "$(oracle "$2" $nu $eps | cut -d' ' -f1)" 1e-8 "$2: D at $eps, nu $nu"
        done
    done
}
for type in 1-D square 3-D; do crystal fig10_cubic_crystals $type; done
crystal fig11_rotated_square 'rotated square'
crystal fig12_close_packed close-packed
crystal fig13_preloaded_square 'preloaded square'
near "$(at fig12_close_packed gap 'Case I nu 0' 0.1)" "$(oracle close-packed 0 0.1 | cut -d' ' -f2)" 1e-8 'gap at 0.1, nu 0'
for type in hydrostatic die; do
    figure=$([ $type = die ] && echo fig17 || echo fig16)
    for nu in 0 0.2 0.44; do
        near "$(number $figure "Case I: D at full density nu $nu")" "$(oracle $type $nu 1 | cut -d' ' -f1)" 1e-6 \
            "$type: D, nu $nu"
    done
done
near "$(number fig17 'Case I: gap / R of third contacts at 0.96 nu 0.46')" "$(oracle die 0.46 0.96 | cut -d' ' -f2)" 1e-7 \
    'gap at .96'
[ "$(oracle die 0.46 0.9636 | cut -d' ' -f1)" = none ] || fail "plain iteration converges beyond the end"

fig10() { at fig10_cubic_crystals "$@"; }
# The asymptotes, [GC] 17 and 18.  With y = (3-2nu) eps^(1/2) / (3 pi (1-nu)) the chain's next term is 5 y^3 ...
for nu in 0 0.5; do
    rest=$(awk -v d="$(fig10 1-D "Case I nu $nu" 0.002)" -v s="$(fig10 1-D "series nu $nu" 0.002)" -v nu=$nu \
        'BEGIN { y = (3 - 2 * nu) * sqrt(.002) / (3 * atan2(0, -1) * (1 - nu)); print (d - s) / y^3 }')
    near "$rest" 5 0.6 "1-D: third term, nu $nu"
done
# ... and lateral neighbours add one in eps^(5/4), twice as large for two pairs of them
ratio=$(awk -v a="$(fig10 1-D 'Case I nu 0.5' 0.002)" -v b="$(fig10 square 'Case I nu 0.5' 0.002)" \
    -v c="$(fig10 3-D 'Case I nu 0.5' 0.002)" -v A="$(fig10 1-D 'Case I nu 0.5' 0.004)" \
    -v B="$(fig10 square 'Case I nu 0.5' 0.004)" 'BEGIN { print log((B - A) / (b - a)) / log(2), (c - a) / (b - a) }')
near "${ratio% *}" 1.25 0.15 'power of the lateral term'
near "${ratio#* }" 2 0.1 'two pairs of lateral neighbours over one'

# Fig. 7 in closed form: Hertz, [GC] 12, and x of overlap = x - n w x^(3/2) by Newton's method.
for eps in 0.1 0.4; do
    set -- $(awk -v e=$eps 'BEGIN { pi = atan2(0, -1); R = .01; E = 1.85e6; nu = .46; n = 4 / 3 * E / (1 - nu * nu) * sqrt(R)
        d = e * R; c = n * (1 + nu) * (3 - 2 * nu) / (4 * pi * R * E); x = d
        for (k = 0; k < 60; k++) x += (d - x + c * x^1.5) / (1 - 1.5 * c * sqrt(x))
        y = c * sqrt(d); printf "%.9g %.9g %.9g", n * d^1.5, n * x^1.5, n * d^1.5 * (1 + 1.5 * y + 21 / 8 * y * y) }')
    near "$(number fig07 "Hertz: load at $eps [N]")" "$1" 1e-4 'Fig. 7: Hertz'
    near "$(number fig07 "Case I: load at $eps [N]")" "$2" 1e-4 'Fig. 7: Case I'
    near "$(number fig07 "three terms: load at $eps [N]")" "$3" 1e-4 'Fig. 7: three terms'
done

# The exact sphere against exact linear elasticity, and what Case I misses.
compare() { # FILE PANEL X TOLERANCE
    exact=$(at "$1" "$2" 'exact linear elasticity' "$3")
    near "$(at "$1" "$2" 'exact sphere' "$3")" "$exact" "$(awk -v e="$exact" -v t="$4" 'BEGIN { print e * t }')" "$1, $2 at $3"
}
for x in 0.01 0.1; do # worst found 0.07 %, lateral 0.12 %, preloaded 0.16 %, all at .1
    compare fig07_rubber_sphere load $x 0.001
    for pair in 'one pair' 'two pairs'; do
        compare fig08_lateral_plates "$pair axial" $x 0.001
        compare fig08_lateral_plates "$pair lateral" $x 0.002
        case_1=$(at fig08_lateral_plates "$pair lateral" 'Case I' $x)
        above "$exact" "$(awk -v c="$case_1" 'BEGIN { print 1.2 * c }')" "$pair: lateral reaction over that of Case I"
    done
    compare fig14_preloaded_forces axial $x 0.002
    compare fig14_preloaded_forces lateral $x 0.002
done
# Those of [MC] hold what the runs do: test_hydrogel.sh says more of these.
for name in mc_03_top_force mc_04_force_distribution mc_05_coordination mc_06_scaling_law; do
    tail -n 1 "$tmp/$name.svg" | grep -q '^</svg>$' || fail "$name.svg is not a whole picture"
    ! grep -qiE 'nan|inf[^o]' "$tmp/$name.svg" || fail "$name.svg shows numbers that are none"
    [ "$(wc -l <"$tmp/$name.csv")" -gt 100 ] || fail "$name.csv has hardly any points"
done
for model in hertz mc-paper sphere; do # [MC]: half the largest force at 18 mm; F ~ Z phi b f
    mean=$(awk -F, '$1 > 1 && $3 == 0.134 { sum += $4; n++ } END { print sum / n }' "$S/bench/hydrogel/$model.csv")
    near "$(number mc_03 "$model: top force [N]")" "$mean" 1e-4 "$model: top force"
    near "$(number mc_04 "$model: top force over the largest")" 0.5 0.11 "$model: top force at 18 mm"
    near "$(number mc_06 "$model: farthest from that / largest F")" 0 0.15 "$model: scaling law"
done

# Fig. 2: from 30 degrees on; 0.05 is 2 % of the displacement at the pole
for model in 'Case I' 'Case II'; do
    near "$(number fig02 "$model: worst difference from 30 degrees on")" 0 0.05 "surface, $model"
done
near "$(number fig02 'exact sphere: worst difference from 30 degrees on')" 0 0.001 'surface, exact sphere'
above "$(number fig02 'half-space: worst difference from 30 degrees on')" 0.3 'surface, half-space'
near "$(number fig02 'Case I at 180 degrees')" 0.2387324 1e-6 'surface, Case I, 3/(4 pi)'

# ---- Figs. 18 and 19, the bed of powders: the beds in bench/data/bed, and one compacted anew to a relative density of 0.6

# The forces of a bed from its centres and radii alone, by plain iteration of [GC] 5, 9 and 10 (coupled = 0: Hertz').  Prints the
# largest net force on a sphere over the mean contact force, the load, both lateral reactions.
cat >"$tmp/bed.awk" <<'END'
BEGIN { FS = "[ ,]"; pi = atan2(0, -1); split("19e9 7e9", E, " "); split(".3 .2", nu, " ") }
/^# box_z/ { height = $4 }
/^[0-9]/ { x[$1] = $2; y[$1] = $3; z[$1] = $4; R[$1] = $5; m[$1] = $6; N++ }
function soft(a) { return a ? (1 - nu[m[a]]^2) / E[m[a]] : 0 }
function contact(a, b, dx, dy, dz, overlap, w,    d) { # of a with b, or b = 0 with wall w
    if (overlap < -60e-6) return
    d = sqrt(dx * dx + dy * dy + dz * dz); n++
    i[n] = a; j[n] = b; X[n] = dx / d; Y[n] = dy / d; Z[n] = dz / d; gap[n] = -overlap; wall[n] = w
    k[n] = 4 / 3 / ((soft(a) + soft(b)) * sqrt(1 / R[a] + (b ? 1 / R[b] : 0)))
    at[a, ++count[a]] = n; if (b) at[b, ++count[b]] = n
}
function couple(a,    c, d, e, f, s, v) {
    v = nu[m[a]]
    for (c = 1; c <= count[a]; c++)
        for (d = 1; d < c; d++) {
            e = at[a, c]; f = at[a, d]; s = (i[e] == a) == (i[f] == a) ? 1 : -1
            s = sqrt((X[e] - s * X[f])^2 + (Y[e] - s * Y[f])^2 + (Z[e] - s * Z[f])^2) / 2
            one[++pairs] = e; other[pairs] = f
            W[pairs] = (1 + v) / (4 * pi * R[a] * E[m[a]]) * (-2 * (1 - v) - 2 * (1 - 2 * v) * s + (7 - 8 * v) * s * s) / s
        }
}
END {
    for (a = 1; a <= N; a++) {
        for (b = a + 1; b <= N; b++) {
            dx = x[b] - x[a]; dy = y[b] - y[a]; dz = z[b] - z[a]
            contact(a, b, dx, dy, dz, R[a] + R[b] - sqrt(dx * dx + dy * dy + dz * dz), 0)
        }
        contact(a, 0, -1, 0, 0, R[a] - x[a], 1); contact(a, 0, 1, 0, 0, R[a] - (.001 - x[a]), 2)
        contact(a, 0, 0, -1, 0, R[a] - y[a], 3); contact(a, 0, 0, 1, 0, R[a] - (.001 - y[a]), 4)
        contact(a, 0, 0, 0, -1, R[a] - z[a], 5); contact(a, 0, 0, 0, 1, R[a] - (height - z[a]), 6)
    }
    for (a = 1; a <= N && coupled; a++) couple(a)
    for (sweep = 0; sweep < 200; sweep++) {
        for (c = 1; c <= n; c++) { u = g[c] - gap[c]; P[c] = u > 0 ? k[c] * u * sqrt(u) : 0; g[c] = 0 }
        for (p = 1; p <= pairs; p++) { g[one[p]] += W[p] * P[other[p]]; g[other[p]] += W[p] * P[one[p]] }
    }
    for (c = 1; c <= n; c++) {
        if (P[c] > 0) { active++; sum += P[c] }
        Fx[i[c]] -= P[c] * X[c]; Fy[i[c]] -= P[c] * Y[c]; Fz[i[c]] -= P[c] * Z[c]
        Fx[j[c]] += P[c] * X[c]; Fy[j[c]] += P[c] * Y[c]; Fz[j[c]] += P[c] * Z[c]
        on[wall[c]] += P[c]
    }
    for (a = 1; a <= N; a++) { F = Fx[a]^2 + Fy[a]^2 + Fz[a]^2; if (F > worst) worst = F }
    printf "%d %.9g %.9g %.9g %.9g\n", N, sqrt(worst) * active / sum, on[6], (on[1] + on[2]) / 2, (on[3] + on[4]) / 2
}
END
bed() { # FOLDER MODEL DENSITY: is it in equilibrium, and are its loads those of the table?
    set -- "$1" "$2" "$3" $(awk -v coupled=$([ "$2" = hertz ] && echo 0 || echo 1) -f "$tmp/bed.awk" "$1/bed_$2_$3.csv") \
        $(awk -F, -v m="$2" -v d="$3" '$1 == 6 && $2 == m && $3 == "itself" && ($4 - d)^2 < 1e-9 { print $6, $7, $8 }' "$1/bed.csv")
    [ "$#" = 11 ] && [ "$4" = 125 ] || fail "bed $1 $2 $3: not in the table, or not 125 spheres"
    near "$5" 0 1e-6 "$1 $2 $3: net force on a sphere over mean contact force" # stopped at 1e-8
    for k in 6 7 8; do # the table has six digits
        eval "near \${$k} \${$((k + 3))} \$(awk -v l=\$9 'BEGIN { print 2e-5 * l }') \"\$1 \$2 \$3: load or reaction\""
    done
}
bed "$S/bench/data/bed" hertz 0.80
bed "$S/bench/data/bed" gonzalez-cuitino 0.80
mkdir "$tmp/beds"
${EMULATOR-} "$B/bench/figures/bed/compact" "$tmp/beds" 6 6 .02 .6 >"$tmp/out" || fail "compact fails"
bed "$tmp/beds" hertz 0.60
bed "$tmp/beds" gonzalez-cuitino 0.60

# Poured: no two spheres overlap, none sticks out of the die, and each has the floor or three others to lie on.
for folder in "$S/bench/data/bed" "$tmp/beds"; do
    awk -F, '/^[0-9]/ { x[++N] = $2; y[N] = $3; z[N] = $4; R[N] = $5 }
        function touch(gap) { if (gap < -1e-9 * R[a]) bad = 1; if (gap < 1e-3 * R[a]) held++ }
        END { for (a = 1; a <= N; a++) {
                  held = z[a] - R[a] < 1e-3 * R[a] ? 3 : 0
                  touch(x[a] - R[a]); touch(.001 - R[a] - x[a]); touch(y[a] - R[a]); touch(.001 - R[a] - y[a])
                  for (b = 1; b <= N; b++)
                      if (b != a) touch(sqrt((x[a] - x[b])^2 + (y[a] - y[b])^2 + (z[a] - z[b])^2) - R[a] - R[b])
                  if (held < 3) bad = 1
              }
              exit bad || N != 125 }' "$folder/bed_poured.csv" || fail "$folder: not a bed as poured"
done

# Both tables: in equilibrium wherever loaded, no warning there, no load while the bed consolidates.
for folder in "$S/bench/data/bed" "$tmp/beds"; do
    awk -F, '/^[0-9]/ { n++; if ($5 && $11 > 1e-6 || $12 || $5 && $4 < .52 || !$5 && ($4 > .59 || $6 > 1e-5)) bad = 1 }
        END { exit bad || n < 20 }' "$folder/bed.csv" || fail "$folder: a state is out of balance, has a warning or a wrong load"
done
tail -n 1 "$tmp/fig18_bed.svg" | grep -q '^</svg>$' && [ "$(grep -c '<circle' "$tmp/fig18_bed.svg")" = 375 ] || fail "fig18_bed.svg"
near "$(number fig19 'relative density when poured')" 0.42 0.05 'bed as poured'
for model in Hertz 'Case I'; do near "$(number fig19 "$model: resists from relative density")" 0.55 0.02 "$model: first load"; done
# "50 %": the largest of each bed, in the mean; at 0.8 it is less, see README.  The same bed has it more exactly.
near "$(number fig19 'Case I: largest D of a bed from 0.6')" 0.5 0.1 'bed: largest D'
near "$(number fig19 'Case I: D of the load at 0.8')" 0.29 0.05 'bed: D at 0.8'
above "$(number fig19 'Case I: D of the load at 0.8 least')" 0 'bed: D at 0.8 of every bed'
near "$(number fig19 "Case I from Hertz's bed: D of the load at 0.8")" 0.29 0.03 'the same bed: D at 0.8'
near "$(number fig19 "exact sphere from Hertz's bed: D of the load at 0.8")" 0.5 0.05 'the same bed, exact sphere: D at 0.8'

# A folder that is none, and tables that are not there.
! ${EMULATOR-} "$B/bench/figures/figures" "$S/bench" "$tmp/none" >"$tmp/out" 2>&1 || fail "a folder that is none is accepted"
! ${EMULATOR-} "$B/bench/figures/figures" "$tmp" "$tmp" >"$tmp/out" 2>&1 || fail "missing tables are not noticed"
! ${EMULATOR-} "$B/bench/figures/figures" "$S/bench" "$tmp" "$tmp" >"$tmp/out" 2>&1 || fail "missing beds are not noticed"
! ${EMULATOR-} "$B/bench/figures/bed/compact" "$tmp/none" 6 6 .02 .6 >"$tmp/out" 2>&1 || fail "a folder that is none: beds"
echo "test_figures: what [GC] states, crystals and beds solved again, closed forms, exact elasticity: ok"

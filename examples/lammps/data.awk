# SPDX-License-Identifier: BSD-2-Clause
# data.awk - a packing file (bench/README has the format) as LAMMPS' read_data wants it: awk -v density=D -f data.awk FILE
BEGIN { FS = ","; if (!density) density = 1000 }
{ sub(/\r$/, "") }
/^# N:/ { split($0, f, " "); count = f[3] }
/^# box_[xyz]:/ { split($0, f, " "); axis = substr(f[2], 5, 1); low[axis] = f[3]; high[axis] = f[4] }
/^# material type/ { split($0, f, /[ :]+/); if (f[4] + 0 > types) types = f[4] + 0 }
/^id,/ {
    printf "# a packing of spheres\n\n%d atoms\n%d atom types\n\n", count, types
    split("x y z", axes, " ")
    for (k = 1; k <= 3; k++) printf "%s %s %slo %shi\n", low[axes[k]], high[axes[k]], axes[k], axes[k]
    printf "\nAtoms # sphere\n\n"
}
/^[0-9]/ { printf "%d %d %.17g %s %s %s %s\n", $1, $6, 2 * $5, density, $2, $3, $4 }

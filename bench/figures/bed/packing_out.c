/* SPDX-License-Identifier: BSD-2-Clause */
#include "packing_out.h"

void packing_write(FILE *out, const bed *b, const char *name)
{
    fprintf(out, "# packing: %s\n# N: %d\n# box_x: 0 %.17g\n# box_y: 0 %.17g\n# box_z: 0 %.17g\n# periodic: 0 0 0\n", name,
            BED_SPHERES, die_side, die_side, b->height);
    fprintf(out, "# wall 1: plane rigid point 0 0 0 inward_normal 1 0 0\n");
    fprintf(out, "# wall 2: plane rigid point %.17g 0 0 inward_normal -1 0 0\n", die_side);
    fprintf(out, "# wall 3: plane rigid point 0 0 0 inward_normal 0 1 0\n");
    fprintf(out, "# wall 4: plane rigid point 0 %.17g 0 inward_normal 0 -1 0\n", die_side);
    fprintf(out, "# wall 5: plane rigid point 0 0 0 inward_normal 0 0 1\n");
    fprintf(out, "# wall 6: plane rigid point 0 0 %.17g inward_normal 0 0 -1\n", b->height);
    for (int p = 0; p < POWDERS; p++)
        fprintf(out, "# material type %d: E %.17g nu %.17g\n", p + 1, powders[p].material.young, powders[p].material.poisson);
    fputs("id,x,y,z,radius,type\n", out);
    for (int k = 0; k < BED_SPHERES; k++)
        fprintf(out, "%d,%.17g,%.17g,%.17g,%.17g,%d\n", k + 1, b->x[k][0], b->x[k][1], b->x[k][2], b->radius[k],
                (int)b->material[k] + 1);
}

/* Three Gauss nodes in |z| for each hemisphere, with 3, 5 and 3 azimuths.
 *
 * Canopies are wide: what matters is how light leaves a layer, integrals over |z| from 0 to
 * 1 with e^(-tau/|z|) in them, which half-range Gauss does to 1-2 % where sets of equal
 * weights on the sphere are 14 % off (tests/tree/test_lattice.c). Fluxes and second moments
 * are exact. A ring's azimuths are turned off the axes of the grid, and the lower
 * hemisphere is the upper one's antipode. Numbers of azimuths are odd: four of them are one
 * and the same where plants repeat along x and y, and a forest of hollow crowns was 4 %
 * bright.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "tree/ordinates.h"

#include <math.h>

static const double PI = 3.14159265358979323846;

static const struct {
    double z, weight; /* Gauss-Legendre on (0, 1) */
    int n;            /* azimuths */
    double turn;      /* of the first, in steps of the ring */
} rings[] = {
    {0.11270166537925831, 5.0 / 18, 3, .125},
    {0.5, 8.0 / 18, 5, .125},
    {0.88729833462074169, 5.0 / 18, 3, .05},
};

void pps_ordinates(double to[PPS_ORDINATES][3], double weight[PPS_ORDINATES]) {
    int j = 0;
    for (int r = 0; r < 3; r++) {
        for (int k = 0; k < rings[r].n; k++, j += 2) {
            double phi = 2 * PI * (k + rings[r].turn) / rings[r].n;
            double z = rings[r].z, s = sqrt(1 - z * z);
            double at[3] = {s * cos(phi), s * sin(phi), z};
            for (int i = 0; i < 3; i++) {
                to[j][i] = at[i];
                to[j + 1][i] = -at[i];
            }
            weight[j] = weight[j + 1] = rings[r].weight / (2 * rings[r].n);
        }
    }
}

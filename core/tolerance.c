/* How far two answers to one case lie apart.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/tolerance.h"

#include <math.h>

static const double FLOOR = 1e-3;     /* of the largest radiance */
static const double NOTHING = 1e-290; /* below which numbers lose digits */

double pps_tolerance_missed(bool radiances, size_t n, const double *coarse,
                            const double *fine) {
    double largest = 0, worst = 0;

    for (size_t i = 0; radiances && i < n; i++) {
        largest = fmax(largest, fabs(fine[i]));
    }
    for (size_t i = 0; i < n; i++) {
        double scale = fmax(fabs(fine[i]), FLOOR * largest);
        double error = fabs(fine[i] - coarse[i]);
        if (!(error < NOTHING)) { /* a NaN counts */
            worst = fmax(worst, isnan(error) ? HUGE_VAL : error / scale);
        }
    }
    return worst;
}

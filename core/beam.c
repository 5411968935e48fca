/* Integrals of a beam along rays, the vector loop.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/beam.h"

#include <math.h>

#include "core/lanes.h"

PPS_CLONES void pps_beam_integrals(double mu0, double tau, double rest, bool down,
                                   size_t n, const double *mu, double *integral) {
    double q = 1 / mu0;
    four root = four_exp(four_of(-q * tau / 2)), eqt = root * root;
    for (size_t i = 0; i < n; i += FOUR) {
        four c = 1 / four_at(mu + i), part;
        if (down) {
            four half = four_exp(-c * (tau / 2));
            part = four_exp1(tau, four_of(q), c, eqt, half * half, root, half);
        } else {
            four rate = q + c, half = four_exp(-rate * (rest / 2));
            part = eqt * four_exp1(rest, four_of(0), rate, four_of(1), half * half,
                                   four_of(1), half);
        }
        four_to(integral + i, c * part);
    }
}

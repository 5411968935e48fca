/* Until the species are there.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <ppscat/tree/grow.h>

#include "tree/problem.h"

pps_status pps_species_grow(const char *name, uint64_t seed, pps_mesh **out,
                            pps_problem *problem) {
    (void)seed;
    *out = NULL;
    return pps_complain(problem, PPS_ERR_UNSUPPORTED, "no species '%s'", name);
}

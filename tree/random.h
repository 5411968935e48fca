/* Random numbers by counter: what is drawn depends on (seed, stream, item, event) alone,
 * never on the order or the thread that draws it.
 *
 * Reference: Salmon et al. 2011 (Philox).
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_TREE_RANDOM_H
#define PPS_TREE_RANDOM_H

#include <stdint.h>

#include <Random123/philox.h>

/* One stream a use, so that no two uses share numbers. */
typedef enum {
    PPS_RANDOM_CROWN,
    PPS_RANDOM_SPECIES,
    PPS_RANDOM_SUN,
    PPS_RANDOM_SKY,
    PPS_RANDOM_GATHER,
    PPS_RANDOM_CELLS,
    PPS_RANDOM_RENDER,
    PPS_RANDOM_OCTANTS,
    PPS_RANDOM_SCENE,
    PPS_RANDOM_RADIOSITY
} pps_random_stream;

typedef struct {
    double u[4]; /* in (0, 1) */
} pps_uniforms;

static inline pps_uniforms pps_random(uint64_t seed, pps_random_stream stream,
                                      uint64_t item, uint64_t event) {
    philox4x64_ctr_t counter = {{item, event, 0, 0}};
    philox4x64_key_t key = {{seed, (uint64_t)stream}};
    philox4x64_ctr_t bits = philox4x64(counter, key);
    pps_uniforms r;
    for (int i = 0; i < 4; i++) {
        r.u[i] = ((double)(bits.v[i] >> 11) + 0.5) * 0x1p-53;
    }
    return r;
}

#endif

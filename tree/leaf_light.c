/* The per-leaf model's closed forms: sky, sun, and the sun by way of one leaf.
 *
 *   omega_l   towards the sun          M(x) = max(x, 0)        tau s_max_j = -ln att_j
 *   att_j     of the leaf's octant j   T    = e^(-tau s_max(omega_l))
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>

#include "tree/leaf_light_terms.h"
#include "tree/vec.h"

static const double PI = 3.14159265358979323846;

double pps_leaf_through_mean(double alpha) {
    return ((PI - alpha) * cos(alpha) + sin(alpha)) / (6 * PI);
}

double pps_leaf_back_mean(double alpha) {
    return (sin(alpha) - alpha * cos(alpha)) / (6 * PI);
}

/* A leaf between omega_j and the sun shows the viewer the side that the sun does not see
 * where the angle is small: hence "through" at alpha = 0. Both faces, equally often.
 * A G1/tau = 2 (4 pi/8) [(rf + rb)/pi back + (tf + tb)/pi through] (B-Eqs. 10, 12, 16). */
double pps_leaf_turned(const pps_leaf_optics *optics, int band, double alpha) {
    double r = optics->reflectance[0][band] + optics->reflectance[1][band];
    double t = optics->transmittance[0][band] + optics->transmittance[1][band];
    return 8 / (double)PPS_OCTANTS *
           (r * pps_leaf_back_mean(alpha) + t * pps_leaf_through_mean(alpha));
}

/* What comes through as a function of direction, linear in each coordinate: its mean over
 * octant j is its value where they all are +-1/2, so it is read off those eight values.
 * Weighted by cosines instead, leaves in the crown's shade saw the sun beside it. */
static double interpolated(int j, const double to[3]) {
    double weight = 1;
    for (int k = 0; k < 3; k++) {
        weight *= (1 + (j >> k & 1 ? 2 : -2) * to[k]) / 2;
    }
    return weight;
}

void pps_leaf_sun_init(pps_leaf_sun *sun, const double to[3]) {
    double omega[PPS_OCTANTS][3], sum = 0;
    for (int j = 0; j < PPS_OCTANTS; j++) {
        pps_octant_direction(j, omega[j]);
        double cosine = vec_dot(omega[j], to);
        sun->alpha[j] = acos(fmax(-1, fmin(1, cosine)));
        sun->weight[j] = fmax(cosine, 0);
        sum += sun->weight[j];
    }
    for (int j = 0; j < PPS_OCTANTS; j++) {
        sun->weight[j] /= sum;
    }
    for (int j = 0; j < PPS_OCTANTS; j++) {
        sun->mean[j] = interpolated(j, to);
        sun->turn[j] = 0;
        for (int i = 0; i < PPS_OCTANTS; i++) {
            sun->turn[j] += sun->weight[i] * vec_dot(omega[j], omega[i]);
        }
    }
}

void pps_leaf_octants_init(pps_leaf_octants *octants, const float *att) {
    for (int j = 0; j < PPS_OCTANTS; j++) {
        octants->att[j] = (double)att[j];
        octants->depth[j] = -log(fmax((double)att[j], 1e-37));
    }
}

double pps_leaf_sun_through(const pps_leaf_sun *sun, const pps_leaf_octants *octants,
                            pps_sun_mean mean) {
    double depth = 0, through = 0;
    for (int j = 0; j < PPS_OCTANTS; j++) {
        depth += sun->weight[j] * octants->depth[j];
        through += sun->mean[j] * octants->att[j];
    }
    return mean == PPS_SUN_PRINTED ? exp(-depth) : fmax(0, fmin(1, through));
}

/* (1 - e^(-a x))/a for any sign of a. */
static double decayed(double a, double x) { return a == 0 ? x : -expm1(-a * x) / a; }

/* 1 - omega_i.omega_j, by the signs that differ. */
static double apart(int i, int j) {
    int differ = i ^ j;
    return 2 / 3.0 * ((differ & 1) + (differ >> 1 & 1) + (differ >> 2 & 1));
}

/* Along omega_j the sun's depth changes by -turn_j a unit (B-Eq. 22), so B-Eq. 20 is
 * T int_0^x e^(-s (1 - turn)) ds, x = tau s_max_j. Unbiased, there is one such
 * integral for each octant the sun shines through. */
void pps_leaf_sun_depths(const pps_leaf_sun *sun, const pps_leaf_octants *octants,
                         pps_sun_mean mean, double out[PPS_OCTANTS]) {
    double through = pps_leaf_sun_through(sun, octants, mean);
    for (int j = 0; j < PPS_OCTANTS; j++) {
        double x = octants->depth[j];
        out[j] = mean == PPS_SUN_PRINTED ? through * decayed(1 - sun->turn[j], x) : 0;
        for (int i = 0; i < PPS_OCTANTS && mean == PPS_SUN_UNBIASED; i++) {
            if (sun->weight[i] > 0) {
                out[j] += sun->weight[i] * octants->att[i] * decayed(apart(i, j), x);
            }
        }
    }
}

/* The sky's mean radiance over each octant: z has the mean 1/2 over an upper one. With a
 * ground the lower ones see it under the irradiance of the open sky. */
static void octant_sky(const pps_scene *scene, int band, double sky[PPS_OCTANTS]) {
    double zenith = scene->sky.zenith[band], horizon = scene->sky.horizon[band];
    double irradiance = PI * (horizon / 3 + 2 * zenith / 3);
    double below = scene->ground.present
                       ? scene->ground.reflectance[band] * irradiance / PI
                       : scene->sky.below[band];
    for (int j = 0; j < PPS_OCTANTS; j++) {
        sky[j] = j >> 2 & 1 ? (horizon + zenith) / 2 : below;
    }
}

/* What holds for all leaves of a scene in one band. */
typedef struct {
    double omega[PPS_OCTANTS][3];
    double sky[PPS_OCTANTS]; /* radiance; 0 where it is not asked for */
    pps_leaf_sun sun;
    double irradiance; /* of the sun */
    double to[3];
    pps_sun_mean mean;
    unsigned sources;
} lights;

/* turned[j]: pps_leaf_turned of the leaf's optics. */
static void light_leaf(const lights *l, const double normal[3], const float *att,
                       const double turned[PPS_OCTANTS], double face[2]) {
    double from[PPS_OCTANTS] = {0}; /* radiance times solid angle */
    bool sun = l->sources & PPS_SUN && l->irradiance > 0;
    bool indirect = l->sources & PPS_SUN_INDIRECT && l->irradiance > 0;
    pps_leaf_octants octants;
    if (sun || indirect) {
        pps_leaf_octants_init(&octants, att);
    }
    if (indirect) {
        pps_leaf_sun_depths(&l->sun, &octants, l->mean, from);
    }
    for (int j = 0; j < PPS_OCTANTS; j++) {
        from[j] *= turned[j] * l->irradiance;
        from[j] += 4 * PI / PPS_OCTANTS * (double)att[j] * l->sky[j];
    }
    face[0] = face[1] = 0;
    for (int j = 0; j < PPS_OCTANTS; j++) {
        double cosine = vec_dot(normal, l->omega[j]);
        face[0] += fmax(cosine, 0) * from[j];
        face[1] += fmax(-cosine, 0) * from[j];
    }
    if (sun) {
        double cosine = vec_dot(normal, l->to);
        face[cosine < 0] += fabs(cosine) * l->irradiance *
                            pps_leaf_sun_through(&l->sun, &octants, l->mean);
    }
}

static void light_band(const pps_scene *scene, const lights *l, const float *att,
                       int band, pps_irradiance *out) {
    for (size_t k = 0; k < scene->n_instances; k++) {
        const pps_prototype *p = &scene->prototype[scene->instance[k].prototype];
        double turned[PPS_OCTANTS];
        for (int j = 0; j < PPS_OCTANTS; j++) {
            turned[j] = pps_leaf_turned(&p->optics, band, l->sun.alpha[j]);
        }
        for (size_t i = 0; i < p->mesh->n_leaves; i++) {
            size_t number = scene->first_leaf[k] + i;
            double normal[3], face[2];
            pps_instance_direction(&scene->instance[k], p->mesh->leaf[i].normal,
                                   normal);
            light_leaf(l, normal, att + PPS_OCTANTS * number, turned, face);
            out->front[number * (size_t)out->n_bands + (size_t)band] = face[0];
            out->back[number * (size_t)out->n_bands + (size_t)band] = face[1];
        }
    }
}

pps_status pps_leaf_light(const pps_scene *scene, const float *att, pps_sun_mean mean,
                          unsigned sources, pps_irradiance *out) {
    if (!scene || !att || !out || out->n_leaves != scene->n_leaves ||
        out->n_bands != scene->n_bands) {
        return PPS_ERR_ARGUMENT;
    }
    if (sources & ~(unsigned)(PPS_SUN | PPS_SUN_INDIRECT | PPS_SKY)) {
        return PPS_ERR_UNSUPPORTED;
    }
    for (int band = 0; band < scene->n_bands; band++) {
        lights l = {.irradiance = scene->sun.irradiance[band],
                    .to = {scene->sun.to[0], scene->sun.to[1], scene->sun.to[2]},
                    .mean = mean,
                    .sources = sources};
        if (sources & PPS_SKY) {
            octant_sky(scene, band, l.sky);
        }
        for (int j = 0; j < PPS_OCTANTS; j++) {
            pps_octant_direction(j, l.omega[j]);
        }
        pps_leaf_sun_init(&l.sun, l.to);
        light_band(scene, &l, att, band, out);
    }
    return PPS_OK;
}

/* One mode of a slab lit by a beam.
 *
 *   E1, E2, E3   divided differences of exponentials (expdiff.h)
 *   Theta(t)     E1(t; k, q) = (e^(-k t) - e^(-q t)) / (q - k)
 *   Sh(t)        E2(t; -k, k, q), the convolution of sinh(k .)/k with e^(-q .)
 *   C(t)         the convolution of cosh(k .) with e^(-q .) = sinh(k t)/k - q Sh(t)
 *   x            w - tau
 *
 * Why four kinds: e^(-q tau) as particular solution is 0/0 at k = q; Theta is right there
 * but leaves a constant to be cancelled in thick slabs with small k; the exponentials of
 * the homogeneous part coincide as k w -> 0; and in thin slabs the particular solution
 * has to vanish at tau = 0 or everything is a difference of nearly equal numbers.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/mode.h"

#include <math.h>

#include <ppscat/expdiff.h>

/* sinh(k t) / k, smooth at k = 0. Only for k t < 1. */
static double sinh_over(double k, double t) {
    double z = k * t;
    return z > 1e-4 ? sinh(z) / k : t * (1 + z * z / 6);
}

static pps_mode_kind choose_kind(double k, double w, double q) {
    if (k * w < 1) { /* false for k = 0 in a half-space, where 0 * inf is NaN */
        return w * q < 2 ? PPS_MODE_THIN : PPS_MODE_SMALL;
    }
    return fabs(k - q) < q / 2 ? PPS_MODE_RESONANT : PPS_MODE_NORMAL;
}

void pps_mode_beam(pps_mode *mode, double k, double w, double q, double alpha,
                   double beta) {
    pps_mode_beam_of_kind(mode, choose_kind(k, w, q), k, w, q, alpha, beta);
}

void pps_mode_beam_of_kind(pps_mode *mode, pps_mode_kind kind, double k, double w,
                           double q, double alpha, double beta) {
    *mode =
        (pps_mode){.kind = kind, .k = k, .q = q, .w = w, .alpha = alpha, .beta = beta};
    switch (mode->kind) {
    case PPS_MODE_THIN:
        mode->p = mode->r = 0;
        break;
    case PPS_MODE_RESONANT: /* psi = p Theta, phi = k p Theta + r e^(-q tau) */
        mode->p = (alpha + q * beta) / (k + q);
        mode->r = (k * beta - alpha) / (k + q);
        break;
    case PPS_MODE_SMALL:
    case PPS_MODE_NORMAL: /* psi = p e^(-q tau), phi = r e^(-q tau) */
        mode->p = -(alpha + q * beta) / ((q - k) * (q + k));
        mode->r = -(q * alpha + k * k * beta) / ((q - k) * (q + k));
        break;
    }
}

void pps_mode_dark(pps_mode *mode, double k, double w) {
    /* q = 1 stands for "thin means w < 2"; the particular solution is 0. */
    pps_mode_beam(mode, k, w, 1, 0, 0);
}

/* C(t) and Sh(t). */
static void thin_beam(const pps_mode *mode, double t, double *c, double *sh) {
    *sh = pps_exp2(t, -mode->k, mode->k, mode->q);
    *c = sinh_over(mode->k, t) - mode->q * *sh;
}

static void particular(const pps_mode *mode, double tau, double *psi, double *phi) {
    double k = mode->k, q = mode->q, p = mode->p, eqt = exp(-q * tau);
    double c, sh, theta;
    switch (mode->kind) {
    case PPS_MODE_THIN:
        thin_beam(mode, tau, &c, &sh);
        *psi = mode->beta * c - mode->alpha * sh;
        *phi = mode->alpha * c - mode->beta * k * k * sh;
        break;
    case PPS_MODE_RESONANT:
        theta = isinf(tau) ? 0 : pps_exp1(tau, k, q);
        *psi = p * theta;
        *phi = mode->r * eqt + k * p * theta;
        break;
    case PPS_MODE_SMALL:
    case PPS_MODE_NORMAL:
        *psi = p * eqt;
        *phi = mode->r * eqt;
        break;
    }
}

void pps_mode_particular(const pps_mode *mode, double psi[2], double phi[2]) {
    particular(mode, 0, &psi[0], &phi[0]);
    particular(mode, mode->w, &psi[1], &phi[1]);
}

double pps_k_tanh(double k, double half) { return k > 0 ? k * tanh(k * half) : 0; }

double pps_k_coth(double k, double half) {
    double z = k * half;
    return z > 1e-4 ? k / tanh(z) : isinf(half) ? 0 : (1 + z * z / 3) / half;
}

double pps_2k_csch(double k, double w) {
    double z = k * w;
    if (isinf(w) || z > 700) {
        return 0;
    }
    return z > 1e-4 ? 2 * k / sinh(z) : 2 / (w * (1 + z * z / 6));
}

void pps_mode_close(pps_mode *mode, const pps_mode_edges *edges) {
    double k = mode->k, half = mode->w / 2;
    switch (mode->kind) {
    case PPS_MODE_THIN: /* phi_h = -psi_h'; the particular part is 0 at tau = 0 ... */
        mode->c1 = edges->even - edges->odd;
        mode->c2 = edges->even * pps_k_tanh(k, half) - edges->odd * pps_k_coth(k, half);
        break;
    case PPS_MODE_SMALL:
        mode->c1 = edges->bottom;
        mode->c2 = edges->top;
        break;
    case PPS_MODE_RESONANT:
    case PPS_MODE_NORMAL: {
        /* [bottom sinh(k tau) + top sinh(k x)] / sinh(k w), by exponentials. */
        double ekw = k > 0 ? exp(-k * mode->w) : 0;
        double scale = -expm1(-2 * k * mode->w);
        if (isinf(mode->w)) {
            scale = 1;
        }
        mode->c1 = (edges->top - edges->bottom * ekw) / scale;
        mode->c2 = (edges->bottom - edges->top * ekw) / scale;
        break;
    }
    }
}

void pps_mode_solve(pps_mode *mode, double g, double top) {
    double psi[2], phi[2], half = mode->w / 2;
    pps_mode_particular(mode, psi, phi);
    double r_top = top - (g * psi[0] + phi[0]), r_bottom = -(g * psi[1] - phi[1]);
    double even = g + pps_k_tanh(mode->k, half), odd = g + pps_k_coth(mode->k, half);
    double cross = isinf(half) ? 0 : pps_2k_csch(mode->k, mode->w) / (even * odd);
    double mean = (1 / even + 1 / odd) / 2;
    pps_mode_edges edges = {
        .even = (r_top + r_bottom) / (2 * even),
        .odd = (r_bottom - r_top) / (2 * odd),
        .bottom = mean * r_bottom + cross * r_top / 2,
        .top = mean * r_top + cross * r_bottom / 2,
    };
    if (isinf(half)) { /* even and odd solutions coincide: G + k */
        edges.top = r_top / (g + mode->k);
        edges.bottom = 0;
    }
    pps_mode_close(mode, &edges);
}

/* e^(-k w) sinh(k t) / k over (1 - e^(-2 k w)) / (2 k): sinh(k t) / sinh(k w). */
static double sinh_share(double k, double w, double t) {
    return exp(-k * (w - t)) * pps_exp1(t, 0, 2 * k) / pps_exp1(w, 0, 2 * k);
}

/* k cosh(k t) / sinh(k w). */
static double cosh_share(double k, double w, double t) {
    return (exp(-k * (w - t)) + exp(-k * (w + t))) / (2 * pps_exp1(w, 0, 2 * k));
}

void pps_mode_state(const pps_mode *mode, double tau, double *psi, double *phi) {
    double k = mode->k, w = mode->w, x = w - tau;
    particular(mode, tau, psi, phi);
    switch (mode->kind) {
    case PPS_MODE_THIN: {
        double ch = cosh(k * tau), sh = sinh_over(k, tau);
        *psi += ch * mode->c1 - sh * mode->c2;
        *phi += ch * mode->c2 - k * k * sh * mode->c1;
        break;
    }
    case PPS_MODE_SMALL:
        *psi += mode->c1 * sinh_share(k, w, tau) + mode->c2 * sinh_share(k, w, x);
        *phi += mode->c2 * cosh_share(k, w, x) - mode->c1 * cosh_share(k, w, tau);
        break;
    case PPS_MODE_RESONANT:
    case PPS_MODE_NORMAL: {
        pps_mode_depth at = pps_mode_at(mode, tau);
        *psi += mode->c1 * at.ekt + mode->c2 * at.ekx;
        *phi += k * (mode->c1 * at.ekt - mode->c2 * at.ekx);
        break;
    }
    }
}

void pps_ray_init(pps_ray *ray, double w, double q, double tau, double mu) {
    double x = w - tau, c = 1 / fabs(mu);
    *ray = (pps_ray){.tau = tau,
                     .x = x,
                     .c = c,
                     .ect = exp(-c * tau),
                     .ecx = exp(-c * x),
                     .eqt = exp(-q * tau),
                     .down = mu > 0};
    ray->beam =
        c * (ray->down ? pps_exp1(tau, q, c) : ray->eqt * pps_exp1(x, 0, q + c));
}

pps_mode_depth pps_mode_at(const pps_mode *mode, double tau) {
    double x = mode->w - tau;
    return (pps_mode_depth){exp(-mode->k * tau), isinf(x) ? 0 : exp(-mode->k * x)};
}

/* E1(t; 0, a) where eat = e^(-a t) is at hand. */
static double decay_known(double t, double a, double eat) {
    return a * t > 0.5 ? (1 - eat) / a : -expm1(-a * t) / a;
}

/* The ray integrals of e^(-k t) and of e^(-k (w - t)): what decays away from the edge
 * where the ray enters, and what grows. */
static void ray_exponentials(const pps_mode *mode, const pps_ray *ray,
                             const pps_mode_depth *at, double *from_top,
                             double *from_bottom) {
    double k = mode->k, c = ray->c;
    if (ray->down) {
        *from_top = c * pps_exp1_known(ray->tau, k, c, at->ekt, ray->ect);
        *from_bottom = c * at->ekx * decay_known(ray->tau, k + c, at->ekt * ray->ect);
    } else {
        *from_top = c * at->ekt * decay_known(ray->x, k + c, at->ekx * ray->ecx);
        *from_bottom =
            mode->c2 != 0 ? c * pps_exp1_known(ray->x, k, c, at->ekx, ray->ecx) : 0;
    }
}

double pps_ray_exp(const pps_ray *ray, double k) {
    double c = ray->c;
    return ray->down ? c * pps_exp1(ray->tau, k, c)
                     : c * exp(-k * ray->tau) * pps_exp1(ray->x, 0, k + c);
}

double pps_ray_theta(const pps_ray *ray, double k, double q) {
    double c = ray->c;
    if (ray->down) {
        return c * pps_exp2(ray->tau, k, q, c);
    }
    return c * (pps_exp1(ray->tau, k, q) * pps_exp1(ray->x, 0, k + c) +
                exp(-q * ray->tau) * pps_exp2(ray->x, 0, k + c, q + c));
}

/* sinh measured from the edge where the ray enters, `run` away; `rest` to the other. */
static double sinh_near(double c, double k, double run, double rest) {
    return c * exp(-k * rest) * pps_exp2(run, 0, 2 * k, c + k);
}

/* sinh measured from the edge that the ray runs towards. */
static double sinh_far(double c, double k, double run, double rest) {
    double near = exp(-k * rest);
    return c * (pps_exp1(rest, 0, 2 * k) * pps_exp1(run, k, c) +
                near * near * pps_exp2(run, k, c, c + 2 * k));
}

double pps_ray_sinh_top(const pps_ray *ray, double k) {
    return ray->down ? sinh_near(ray->c, k, ray->tau, ray->x)
                     : sinh_far(ray->c, k, ray->x, ray->tau);
}

double pps_ray_sinh_bottom(const pps_ray *ray, double k) {
    return ray->down ? sinh_far(ray->c, k, ray->tau, ray->x)
                     : sinh_near(ray->c, k, ray->x, ray->tau);
}

/* The ray integrals of k cosh(k t)/sinh(k w) and k cosh(k (w - t))/sinh(k w). */
static void ray_cosh(const pps_ray *ray, double k, double w, double *top,
                     double *bottom) {
    double scale = ray->c / (2 * pps_exp1(w, 0, 2 * k));
    double run = ray->down ? ray->tau : ray->x, rest = ray->down ? ray->x : ray->tau;
    double grow = pps_exp1(run, 0, k + ray->c), fall = pps_exp1(run, k, ray->c);
    double near = scale * (exp(-k * rest) * grow + exp(-k * w) * fall);
    double far = scale * (fall + exp(-k * (w + rest)) * grow);
    *top = ray->down ? near : far;
    *bottom = ray->down ? far : near;
}

/* A thin slab, downward: from the state at tau = 0. Upward: from the state at tau, with
 * the kernel e^(-c s) over 0 < s < x. */
static void ray_thin(const pps_mode *mode, const pps_ray *ray, double *psi,
                     double *phi) {
    double k = mode->k, q = mode->q, c = ray->c, beam = 1;
    double psi0 = mode->c1, phi0 = mode->c2;
    double ch, sh, beam_sh; /* integrals of cosh(k s), sinh(k s)/k and Sh(s) */
    if (ray->down) {
        double t = ray->tau;
        ch = c / 2 * (pps_exp1(t, -k, c) + pps_exp1(t, k, c));
        sh = c * pps_exp2(t, -k, k, c);
        beam_sh = c * pps_exp3(t, -k, k, q, c);
    } else {
        double x = ray->x;
        ch = c / 2 * (pps_exp1(x, 0, c - k) + pps_exp1(x, 0, c + k));
        sh = c * pps_exp2(x, 0, c - k, c + k);
        beam_sh = c * pps_exp3(x, 0, c - k, c + k, c + q);
        beam = ray->eqt;
        pps_mode_state(mode, ray->tau, &psi0, &phi0);
    }
    double beam_c = sh - q * beam_sh;
    *psi = ch * psi0 - sh * phi0 + beam * (mode->beta * beam_c - mode->alpha * beam_sh);
    *phi = ch * phi0 - k * k * sh * psi0 +
           beam * (mode->alpha * beam_c - mode->beta * k * k * beam_sh);
}

void pps_mode_ray(const pps_mode *mode, const pps_ray *ray, const pps_mode_depth *at,
                  double *psi, double *phi) {
    double k = mode->k, p = mode->p, top, bottom;
    switch (mode->kind) {
    case PPS_MODE_THIN:
        ray_thin(mode, ray, psi, phi);
        return;
    case PPS_MODE_SMALL: {
        double s = pps_exp1(mode->w, 0, 2 * k);
        ray_cosh(ray, k, mode->w, &top, &bottom);
        *psi = (mode->c1 * pps_ray_sinh_top(ray, k) +
                mode->c2 * pps_ray_sinh_bottom(ray, k)) /
                   s +
               p * ray->beam;
        *phi = mode->c2 * bottom - mode->c1 * top + mode->r * ray->beam;
        return;
    }
    case PPS_MODE_RESONANT: {
        double theta = pps_ray_theta(ray, k, mode->q);
        ray_exponentials(mode, ray, at, &top, &bottom);
        *psi = mode->c1 * top + mode->c2 * bottom + p * theta;
        *phi = k * (mode->c1 * top - mode->c2 * bottom) + k * p * theta +
               mode->r * ray->beam;
        return;
    }
    case PPS_MODE_NORMAL:
        ray_exponentials(mode, ray, at, &top, &bottom);
        *psi = mode->c1 * top + mode->c2 * bottom + p * ray->beam;
        *phi = k * (mode->c1 * top - mode->c2 * bottom) + mode->r * ray->beam;
        return;
    }
}

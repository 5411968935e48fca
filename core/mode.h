/* One mode of a slab lit by a beam: the scalar problem that every plane-parallel model
 * of this library comes down to,
 *
 *     psi' = -phi + beta e^(-q tau),    phi' = -k^2 psi + alpha e^(-q tau),
 *
 * on 0 <= tau <= w, with k >= 0 and q = 1/mu0. Discrete ordinates have n such modes an
 * azimuthal order, a two-stream model has one. The solution is a particular part plus a
 * homogeneous one, each in the form that keeps its digits in the case at hand.
 *
 * Reference: docs/theory.md section 4.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_CORE_MODE_H
#define PPS_CORE_MODE_H

typedef enum {
    PPS_MODE_THIN,     /* k w < 1, w q < 2: all from the state at tau = 0 */
    PPS_MODE_SMALL,    /* k w < 1, w q >= 2: hyperbolic, both edges */
    PPS_MODE_RESONANT, /* k w >= 1, k near q: exponentials and their difference */
    PPS_MODE_NORMAL    /* k w >= 1 otherwise: exponentials */
} pps_mode_kind;

typedef struct pps_mode {
    pps_mode_kind kind;
    double k, q, w;
    double alpha, beta;
    double p, r; /* amplitudes of the particular solution, psi and phi */
    /* Homogeneous part. THIN: psi, phi of the whole solution at tau = 0. SMALL: psi_h at
     * the bottom, at the top. Else: the factors of e^(-k tau), e^(-k (w - tau)). */
    double c1, c2;
} pps_mode;

/* Set up the beam part: chooses the kind and the particular solution. */
void pps_mode_beam(pps_mode *mode, double k, double w, double q, double alpha,
                   double beta);

/* The same with a kind of the caller's choice among those that are good there. */
void pps_mode_beam_of_kind(pps_mode *mode, pps_mode_kind kind, double k, double w,
                           double q, double alpha, double beta);

/* The particular solution at the top (tau = 0) and the bottom (tau = w). */
void pps_mode_particular(const pps_mode *mode, double psi[2], double phi[2]);

/* Boundary values of the homogeneous part as the boundary solve finds them: psi_h is
 * even + odd at the bottom and even - odd at the top, or `bottom` and `top`. Both pairs
 * say the same; each is exact where the other cancels. */
typedef struct pps_mode_edges {
    double even, odd, bottom, top;
} pps_mode_edges;
void pps_mode_close(pps_mode *mode, const pps_mode_edges *edges);

/* Solve a single mode with the boundary conditions G psi + phi = top at the top (0 when
 * nothing diffuse falls in) and G psi - phi = 0 at the bottom, G > 0. */
void pps_mode_solve(pps_mode *mode, double g, double top);

/* A mode without a beam: light comes in through the boundary. */
void pps_mode_dark(pps_mode *mode, double k, double w);

/* The homogeneous boundary problem of one mode needs k tanh(k w/2), k coth(k w/2) and
 * 2 k / sinh(k w), right down to k = 0 and up to w = infinity. */
double pps_k_tanh(double k, double half);
double pps_k_coth(double k, double half);
double pps_2k_csch(double k, double w);

/* psi and phi at depth tau. */
void pps_mode_state(const pps_mode *mode, double tau, double *psi, double *phi);

/* A depth and a direction; what depends on them alone is computed once for all modes. */
typedef struct pps_ray {
    double tau, x, c; /* x = w - tau, c = 1/|mu| */
    double ect, ecx;  /* e^(-c tau), e^(-c x) */
    double eqt;       /* e^(-q tau) */
    double beam;      /* the integral below of e^(-q t) */
    int down;         /* mu > 0 */
} pps_ray;
void pps_ray_init(pps_ray *ray, double w, double q, double tau, double mu);

/* Ray integrals of the functions that solutions are made of:
 *   e^(-k t), Theta(t) = E1(t; k, q), and with s(t) = E1(t; 0, 2k) = (1 - e^(-2kt))/(2k)
 *   from_top:    e^(-k w) sinh(k t)/k       = e^(-k (w - t)) s(t)
 *   from_bottom: e^(-k w) sinh(k (w - t))/k = e^(-k t) s(w - t)
 * All positive, smooth at k = 0; w may be infinite when k > 0. */
double pps_ray_exp(const pps_ray *ray, double k);
double pps_ray_theta(const pps_ray *ray, double k, double q);
double pps_ray_sinh_top(const pps_ray *ray, double k);
double pps_ray_sinh_bottom(const pps_ray *ray, double k);

/* e^(-k tau) and e^(-k (w - tau)), shared by all rays through a depth. */
typedef struct pps_mode_depth {
    double ekt, ekx;
} pps_mode_depth;
pps_mode_depth pps_mode_at(const pps_mode *mode, double tau);

/* Integrals of psi and phi along the ray, from the edge where it enters:
 *   down: c int_0^tau f(t) e^(-c (tau - t)) dt,  up: c int_tau^w f(t) e^(-c (t - tau)) dt */
void pps_mode_ray(const pps_mode *mode, const pps_ray *ray, const pps_mode_depth *at,
                  double *psi, double *phi);

#endif

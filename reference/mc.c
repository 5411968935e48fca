/* The method "mc": Monte Carlo of the slab by next-event estimation.
 *
 * A flight is a straight run of a photon from depth t0 with cosine s and weight W (power
 * per horizontal area). Wherever on it the photon scatters next, it may be sent along mu
 * to depth tau; averaged over that place this adds to the radiance
 *     albedo W p(s, mu) X,   X = int a e^(-a |t - t0|) c e^(-c |tau - t|) dt,
 * a = 1/|s|, c = 1/|mu|, over the part of the flight from which mu leads to tau. X is
 * bounded by min(a, c), where the estimate from a sampled place has the factor 1/|mu|;
 * so grazing directions, and depths next to a scattering, cost no variance. For fluxes
 * mu is sampled from p and adds |mu| X to the flux and X/(4 pi) to the mean intensity.
 *
 * The first flight of the beam is not random: radiances have single scattering exactly.
 * A ground of reflectance A adds, for a flight that reaches it with power P, the radiance
 * A P/pi attenuated; light that has reached it starts again as a flight from below.
 *
 * Sampled is the rest: the photon flies, scatters with weight albedo, is reflected or
 * escapes. Light photons and, in thick slabs, long histories are thinned by roulette.
 *
 * References: Marchuk80 for local estimates; Salmon11 for counter-based random numbers.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/mc.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include <Random123/philox.h>

#include <ppscat/phase.h>

#include "core/method.h"

static const double PI = 3.14159265358979323846;

enum {
    DEFAULT_PHOTONS = 100000,
    BLOCK = 1024,        /* photons summed together, whatever computes them */
    N_POWERS = 4,        /* sums of y, y^2, y^3, y^4 over photons */
    LONG_HISTORY = 1024, /* scatterings after which histories are thinned */
};

/* Roulette: photons below this share of their start survive one in ten. */
static const double LIGHT_WEIGHT = 1e-6;

/* Long histories: at every doubling of the scatterings these survive. In a conservative
 * half-space n scatterings are survived as n^-1/2; the further n^-1/4 leaves third moments
 * of the weight finite and the work of N photons as N^4/3. */
static const double LONG_SURVIVAL = 0.8408964152537145; /* 2^(-1/4) */

/* Below this thickness no photon is let out of a slab over a black ground. */
static const double THIN = 0.3;

/* What is further than this from a flight gets less than e^-80 of it: left out. */
static const double REACH = 80;

/* A standard error is trusted up to these: the relative variance of the variance, and the
 * error relative to the sampled part of the value. */
static const double MOST_VARIANCE_OF_VARIANCE = 0.05, MOST_RELATIVE_ERROR = 0.2;

/* ... and, for radiances, from so many photons times (1 - |g|)^2 on. */
static const double LEAST_PHOTONS_IN_PEAK = 30;

typedef enum { BEAM, SKY, N_SOURCES } source;

typedef struct {
    double mu, x, y; /* unit vector: along depth, towards azimuth 0, azimuth 90 */
} direction;

typedef struct {
    double tau, weight;
    direction to;
} flight;

typedef struct {
    double u[4]; /* in (0, 1) */
} uniforms;

/* The problem, and the outputs wanted of it. */
typedef struct problem problem;
struct problem {
    pps_slab slab;
    double mu0;
    pps_light light; /* ground is 0 below a half-space */
    uint64_t photons, seed;
    size_t n_tau, n_mu, n_phi; /* fluxes: n_mu and n_phi are 0 */
    const double *tau, *mu;
    double *sine, *cos_phi, *sin_phi; /* of mu, of phi */
    size_t n;                         /* outputs */
    /* Add what the next scattering of a flight sends to the outputs within reach. */
    void (*scatter)(const problem *p, const flight *f, const direction *next,
                    double reach, double *phase, double *y);
    double *from_ground; /* output per power that the ground receives */
    double *fixed;       /* the part of the output that is not sampled */
};

/* ---- random numbers ---- */

static uniforms draw(const problem *p, uint64_t photon, source from, uint64_t event) {
    philox4x64_ctr_t counter = {{photon, event, 0, 0}};
    philox4x64_key_t key = {{p->seed, (uint64_t)from}};
    philox4x64_ctr_t bits = philox4x64(counter, key);
    uniforms r;
    for (int i = 0; i < 4; i++) {
        r.u[i] = ((double)(bits.v[i] >> 11) + 0.5) * 0x1p-53;
    }
    return r;
}

/* The inverse of the distribution of Henyey-Greenstein, for |g| and turned round for
 * g < 0: 1 - cos = 2 (1 - g)^2 (1 - u) (1 + g u)/D^2, D = 1 - g + 2 g u. */
double pps_mc_versine(double g, double u) {
    double b = fabs(g), d = 1 - b + 2 * b * u;
    double versine = 2 * (1 - b) * (1 - b) * (1 - u) * (1 + b * u) / (d * d);
    return g >= 0 ? versine : 2 - versine;
}

/* The direction at angle theta and azimuth psi about `axis`; never horizontal. */
static direction turned(direction axis, double versine, double psi) {
    double cosine = 1 - versine, sine = sqrt(versine * (2 - versine));
    double along = sine * cos(psi), across = sine * sin(psi);
    /* Two vectors normal to the axis (Duff17). */
    double sign = copysign(1, axis.mu), a = -1 / (sign + axis.mu);
    double b = axis.x * axis.y * a;
    direction to = {
        axis.mu * cosine - sign * axis.x * along - axis.y * across,
        axis.x * cosine + (1 + sign * axis.x * axis.x * a) * along + b * across,
        axis.y * cosine + sign * b * along + (sign + axis.y * axis.y * a) * across};
    double scale = 1 / sqrt(to.mu * to.mu + to.x * to.x + to.y * to.y);
    to.mu = copysign(fmax(fabs(to.mu * scale), 1e-100), to.mu);
    to.x *= scale;
    to.y *= scale;
    return to;
}

/* A direction of Lambert's law about the vertical; sign +1 downward. */
static direction lambertian(double sign, double u, double v) {
    double mu = sqrt(u), sine = sqrt(1 - u);
    return (direction){sign * mu, sine * cos(2 * PI * v), sine * sin(2 * PI * v)};
}

/* ---- what a flight sends where ---- */

/* X of the file's head, in a slab of thickness w. */
static double meeting(double w, double t0, double s, double tau, double mu) {
    double a = 1 / fabs(s), c = 1 / fabs(mu);
    if ((s > 0) == (mu > 0)) {
        double run = s > 0 ? tau - t0 : t0 - tau, z = fabs(c - a) * run;
        if (run <= 0) {
            return 0;
        }
        return a * c * run * exp(-fmin(a, c) * run) * (z > 0 ? -expm1(-z) / z : 1);
    }
    /* It turns back between the further of both depths and the edge of the slab. */
    double far = s > 0 ? fmax(t0, tau) : fmin(t0, tau);
    double rest = s > 0 ? w - far : far;
    return -expm1(-(a + c) * rest) * a * c / (a + c) *
           exp(-a * fabs(far - t0) - c * fabs(far - tau));
}

static void scatter_radiance(const problem *p, const flight *f, const direction *next,
                             double reach, double *phase, double *y) {
    (void)next;
    for (size_t j = 0; j < p->n_mu; j++) {
        for (size_t i = 0; i < p->n_phi; i++) {
            double level = f->to.x * p->cos_phi[i] + f->to.y * p->sin_phi[i];
            double cosine = f->to.mu * p->mu[j] + p->sine[j] * level;
            phase[j * p->n_phi + i] = pps_hg(p->slab.g, fmax(-1, fmin(1, cosine)));
        }
    }
    for (size_t k = 0; k < p->n_tau; k++) {
        for (size_t j = 0; fabs(p->tau[k] - f->tau) <= reach && j < p->n_mu; j++) {
            double sent =
                meeting(p->slab.thickness, f->tau, f->to.mu, p->tau[k], p->mu[j]) *
                p->slab.albedo * f->weight;
            double *out = y + (k * p->n_mu + j) * p->n_phi;
            for (size_t i = 0; sent > 0 && i < p->n_phi; i++) {
                out[i] += sent * phase[j * p->n_phi + i];
            }
        }
    }
}

/* Fluxes at depth k are outputs 3k: up, down, mean intensity. */
static void scatter_flux(const problem *p, const flight *f, const direction *next,
                         double reach, double *phase, double *y) {
    (void)phase;
    for (size_t k = 0; k < p->n_tau; k++) {
        if (fabs(p->tau[k] - f->tau) <= reach) {
            double sent =
                meeting(p->slab.thickness, f->tau, f->to.mu, p->tau[k], next->mu) *
                p->slab.albedo * f->weight;
            y[3 * k + (next->mu > 0)] += sent * fabs(next->mu);
            y[3 * k + 2] += sent / (4 * PI);
        }
    }
}

static void scatter_nothing(const problem *p, const flight *f, const direction *next,
                            double reach, double *phase, double *y) {
    (void)p, (void)f, (void)next, (void)reach, (void)phase, (void)y;
}

/* Power reaching the ground adds light from there. */
static void light_ground(const problem *p, double power, double *y) {
    for (size_t i = 0; p->light.ground > 0 && i < p->n; i++) {
        y[i] += power * p->from_ground[i];
    }
}

static double reaching_ground(const problem *p, const flight *f) {
    return f->to.mu > 0 ? f->weight * exp(-(p->slab.thickness - f->tau) / f->to.mu) : 0;
}

/* ---- the history of a photon ---- */

static flight launch(const problem *p, uint64_t photon, source from) {
    if (from == BEAM) {
        direction beam = {p->mu0, sqrt((1 - p->mu0) * (1 + p->mu0)), 0};
        return (flight){0, p->light.beam * p->mu0, beam};
    }
    uniforms r = draw(p, photon, from, 0);
    return (flight){0, p->light.sky * PI, lambertian(1, r.u[0], r.u[1])};
}

/* Where the flight ends: beyond an edge it leaves. Over a black ground the first flight,
 * and all in thin slabs, are made to end inside, lest multiple scattering be rare; what
 * would have left is settled here. */
static double flight_end(const problem *p, flight *f, bool first, double u,
                         pps_mc_budget *budget) {
    double w = p->slab.thickness, mu = f->to.mu;
    if (p->light.ground > 0 || !(first || w < THIN)) {
        return f->tau - mu * log(u);
    }
    double stays = mu > 0 ? -expm1(-(w - f->tau) / mu) : -expm1(f->tau / mu);
    *(mu > 0 ? &budget->transmitted : &budget->reflected) += f->weight * (1 - stays);
    f->weight *= stays;
    return fmax(0, fmin(f->tau - mu * log1p(-u * stays), w));
}

/* The chance to go on after n scatterings. */
static double survival(double weight, double start, uint64_t n) {
    double chance = weight < LIGHT_WEIGHT * start ? 0.1 : 1;
    bool doubled = n >= LONG_HISTORY && (n & (n - 1)) == 0;
    return doubled ? chance * LONG_SURVIVAL : chance;
}

/* The photon leaves, or starts again from the ground; false when it is gone. */
static bool leave(const problem *p, flight *f, double tau, const uniforms *r,
                  pps_mc_budget *budget) {
    if (tau < 0) {
        budget->reflected += f->weight;
        return false;
    }
    budget->transmitted += f->weight * (1 - p->light.ground);
    f->tau = p->slab.thickness;
    f->weight *= p->light.ground;
    f->to = lambertian(-1, r->u[1], r->u[2]);
    return f->weight > 0;
}

/* From one flight to the next; false when the history ends. */
static bool advance(const problem *p, flight *f, direction next, double start,
                    uint64_t n, const uniforms *r, pps_mc_budget *budget) {
    double tau = flight_end(p, f, n == 1, r->u[0], budget);
    bool inside = tau >= 0 && tau <= p->slab.thickness;
    if (!inside && !leave(p, f, tau, r, budget)) {
        return false;
    }
    if (inside) {
        budget->absorbed += f->weight * (1 - p->slab.albedo);
        *f = (flight){tau, f->weight * p->slab.albedo, next};
    }
    double chance = survival(f->weight, start, n);
    if (!(r->u[3] < chance)) { /* the spare number of this event */
        budget->roulette -= f->weight;
        return false;
    }
    budget->roulette += f->weight * (1 / chance - 1);
    f->weight /= chance;
    return f->weight > 0;
}

/* Event 0 launches; event n decides the end of flight n and the direction after it. */
static void history(const problem *p, uint64_t photon, source from, double *phase,
                    double *y, pps_mc_budget *budget) {
    flight f = launch(p, photon, from);
    double start = f.weight;
    budget->launched += start;
    for (uint64_t n = 1;; n++) {
        uniforms r = draw(p, photon, from, n);
        direction next =
            turned(f.to, pps_mc_versine(p->slab.g, r.u[1]), 2 * PI * r.u[2]);
        if (n > 1 || from == SKY || p->n_mu == 0) {
            p->scatter(p, &f, &next, REACH, phase, y);
        }
        if (n > 1) { /* what comes there first is in `fixed` */
            light_ground(p, reaching_ground(p, &f), y);
        }
        if (!advance(p, &f, next, start, n, &r, budget)) {
            return;
        }
    }
}

/* ---- sums over photons ---- */

/* One block: power[i * N_POWERS + q] += y_i^(q+1), and the energy. y and phase are
 * scratch. Blocks know nothing of each other. */
static void run_block(const problem *p, uint64_t first, uint64_t end, double *phase,
                      double *y, double *power, pps_mc_budget *budget) {
    for (uint64_t photon = first; photon < end; photon++) {
        memset(y, 0, p->n * sizeof *y);
        if (p->light.beam > 0) {
            history(p, photon, BEAM, phase, y, budget);
        }
        if (p->light.sky > 0) {
            history(p, photon, SKY, phase, y, budget);
        }
        for (size_t i = 0; i < p->n; i++) {
            double *sums = power + i * N_POWERS, square = y[i] * y[i];
            sums[0] += y[i];
            sums[1] += square;
            sums[2] += square * y[i];
            sums[3] += square * square;
        }
    }
}

static void add_budget(pps_mc_budget *sum, const pps_mc_budget *part) {
    sum->launched += part->launched;
    sum->reflected += part->reflected;
    sum->transmitted += part->transmitted;
    sum->absorbed += part->absorbed;
    sum->roulette += part->roulette;
}

/* All photons: blocks are added in their order. `total` gets the sums of powers. */
static pps_status run_blocks(const problem *p, double *total, pps_mc_budget *energy) {
    size_t n_power = p->n * N_POWERS, n_phase = p->n_mu * p->n_phi;
    double *memory = malloc((n_power + p->n + n_phase + 1) * sizeof *memory);
    if (!memory) {
        return PPS_ERR_MEMORY;
    }
    double *power = memory, *y = power + n_power, *phase = y + p->n;
    *energy = (pps_mc_budget){0};
    memset(total, 0, n_power * sizeof *total);
    for (uint64_t first = 0; first < p->photons; first += BLOCK) {
        uint64_t left = p->photons - first;
        pps_mc_budget budget = {0};
        memset(power, 0, n_power * sizeof *power);
        run_block(p, first, first + (left < BLOCK ? left : BLOCK), phase, y, power,
                  &budget);
        for (size_t i = 0; i < n_power; i++) {
            total[i] += power[i];
        }
        add_budget(energy, &budget);
    }
    free(memory);
    return PPS_OK;
}

/* The standard error of a mean over n photons from the sums of its powers; INFINITY
 * where few photons carry it, by the variance of the variance. */
static double standard_error_of(const double *sums, double n) {
    double m = sums[0] / n, second = sums[1] / n, m2 = second - m * m;
    double m4 =
        sums[3] / n - 4 * m * sums[2] / n + 6 * m * m * second - 3 * m * m * m * m;
    double error = sqrt(fmax(m2, 0) / (n - 1));
    if (n > 1 && m > 0 && m2 <= 1e-12 * m * m) {
        return error; /* all photons alike */
    }
    bool known = (m4 / (m2 * m2) - 1) / n <= MOST_VARIANCE_OF_VARIANCE &&
                 error <= MOST_RELATIVE_ERROR * m;
    return known ? error : (double)INFINITY;
}

/* Where no light can be but what is in `fixed`. */
static bool nothing_sampled(const problem *p, size_t i) {
    size_t per_depth = p->n / p->n_tau;
    double tau = p->tau[i / per_depth];
    bool radiance = p->n_mu > 0, mean = !radiance && i % 3 == 2;
    bool down = radiance ? p->mu[i / p->n_phi % p->n_mu] > 0 : i % 3 == 1;
    bool at_end = down ? tau == 0 : tau == p->slab.thickness && p->light.ground == 0;
    return p->slab.albedo == 0 || (at_end && !mean);
}

/* Whether the spread of radiances may miss what carries them: light that comes within the
 * phase function's peak, 1 - |g| wide, of a wanted direction. A sample that happens to
 * have none of it looks narrow, and is wrong. */
static bool peak_is_missed(const problem *p) {
    double width = 1 - fabs(p->slab.g);
    return p->n_mu > 0 && (double)p->photons * width * width < LEAST_PHOTONS_IN_PEAK;
}

/* Values and standard errors of all outputs from the sums of powers. */
static void summarise(const problem *p, const double *total, double *value,
                      double *error) {
    double n = (double)p->photons;
    for (size_t i = 0; i < p->n; i++) {
        value[i] = p->fixed[i] + total[i * N_POWERS] / n;
        error[i] = nothing_sampled(p, i) ? 0
                   : peak_is_missed(p)   ? (double)INFINITY
                                         : standard_error_of(total + i * N_POWERS, n);
    }
}

/* ---- the part that is not sampled ---- */

/* E1 by its series below 1, E2 by its continued fraction above (AS64
 * 5.1.11, 5.1.22), the others by n E_(n+1) = e^-x - x E_n. */
void pps_mc_expint(double x, double *e2, double *e3) {
    if (x < 1) {
        double e1 = 0, term = 1;
        for (int k = 1; k <= 20; k++) {
            term *= -x / k;
            e1 -= term / k;
        }
        e1 -= x > 0 ? 0.57721566490153286061 + log(x) : 0; /* times x below */
        *e2 = exp(-x) - x * e1;
        *e3 = (exp(-x) - x * *e2) / 2;
        return;
    }
    for (int order = 2; order <= 3; order++) {
        double fraction = x + order + 200; /* the tail, from term 100 up */
        for (int k = 100; k >= 1; k--) {
            fraction = x + order + 2 * (k - 1) - (double)k * (k + order - 1) / fraction;
        }
        *(order == 2 ? e2 : e3) = exp(-x) / fraction;
    }
}

/* Sky light that has not collided, and light that the ground returns uncollided per
 * power received. */
static void uncollided_radiance(problem *p) {
    double w = p->slab.thickness;
    for (size_t i = 0; i < p->n; i++) {
        double tau = p->tau[i / (p->n_mu * p->n_phi)];
        double mu = p->mu[i / p->n_phi % p->n_mu];
        p->fixed[i] = mu > 0 ? p->light.sky * exp(-tau / mu) : 0;
        p->from_ground[i] = p->light.ground > 0 && mu < 0
                                ? p->light.ground / PI * exp((w - tau) / mu)
                                : 0;
    }
}

static void uncollided_flux(problem *p) {
    for (size_t k = 0; k < p->n_tau; k++) {
        double e2, e3, *fixed = p->fixed + 3 * k, *from = p->from_ground + 3 * k;
        pps_mc_expint(p->tau[k], &e2, &e3);
        fixed[0] = 0;
        fixed[1] = p->light.sky * 2 * PI * e3;
        fixed[2] = p->light.sky * e2 / 2;
        memset(from, 0, 3 * sizeof *from);
        if (p->light.ground > 0) {
            pps_mc_expint(p->slab.thickness - p->tau[k], &e2, &e3);
            from[0] = p->light.ground * 2 * e3;
            from[2] = p->light.ground * e2 / (2 * PI);
        }
    }
}

/* The ground lit through the slab, and for radiances single scattering of the beam. */
static void add_first_flights(problem *p, double *phase) {
    flight beam = launch(p, 0, BEAM);
    if (p->light.beam > 0 && p->n_mu > 0) {
        p->scatter(p, &beam, NULL, (double)INFINITY, phase, p->fixed);
    }
    if (p->light.ground > 0) {
        double e2, e3;
        pps_mc_expint(p->slab.thickness, &e2, &e3);
        light_ground(p, reaching_ground(p, &beam) + p->light.sky * 2 * PI * e3,
                     p->fixed);
    }
}

/* ---- the public calls ---- */

static pps_status problem_of(problem *p, const pps_slab *slab, double mu0,
                             const pps_mc_opts *opts) {
    pps_mc_opts o = opts ? *opts : (pps_mc_opts){0};
    bool ok = !pps_slab_check(slab) && !pps_mu0_check(mu0) && o.light.beam >= 0 &&
              isfinite(o.light.beam) && o.light.sky >= 0 && isfinite(o.light.sky) &&
              o.light.ground >= 0 && o.light.ground <= 1;
    if (!ok) {
        return PPS_ERR_ARGUMENT;
    }
    if (o.light.beam == 0 && o.light.sky == 0) {
        o.light.beam = 1;
    }
    if (isinf(slab->thickness)) {
        o.light.ground = 0;
    }
    *p = (problem){.slab = *slab,
                   .mu0 = mu0,
                   .light = o.light,
                   .photons = o.photons ? o.photons : DEFAULT_PHOTONS,
                   .seed = o.seed,
                   .scatter = scatter_nothing};
    return PPS_OK;
}

/* Values and standard errors of all outputs of a problem that is set up. */
static pps_status answer(problem *p, double *value, double *error) {
    double *total = malloc((p->n * N_POWERS + 1) * sizeof *total);
    if (!total) {
        return PPS_ERR_MEMORY;
    }
    pps_mc_budget energy;
    pps_status status = run_blocks(p, total, &energy);
    if (!status && p->n > 0) {
        summarise(p, total, value, error);
    }
    free(total);
    return status;
}

static void set_directions(problem *p, const pps_grid *at, double *memory) {
    p->sine = memory;
    p->cos_phi = p->sine + at->n_mu;
    p->sin_phi = p->cos_phi + at->n_phi;
    for (size_t j = 0; j < at->n_mu; j++) {
        p->sine[j] = sqrt((1 - at->mu[j]) * (1 + at->mu[j]));
    }
    for (size_t i = 0; i < at->n_phi; i++) {
        p->cos_phi[i] = pps_cos_degrees(at->phi[i]);
        p->sin_phi[i] = pps_cos_degrees(at->phi[i] - 90);
    }
}

pps_status pps_mc_radiance(const pps_slab *slab, double mu0, const pps_mc_opts *opts,
                           const pps_grid *at, double *radiance,
                           double *standard_error) {
    problem p;
    if (problem_of(&p, slab, mu0, opts) || pps_grid_check(at, slab->thickness)) {
        return PPS_ERR_ARGUMENT;
    }
    size_t n_phase = at->n_mu * at->n_phi, n = at->n_tau * n_phase;
    if (n == 0) {
        return PPS_OK;
    }
    if (!radiance) {
        return PPS_ERR_ARGUMENT;
    }
    double *memory =
        malloc((3 * n + n_phase + at->n_mu + 2 * at->n_phi) * sizeof *memory);
    if (!memory) {
        return PPS_ERR_MEMORY;
    }
    double *error = memory + 2 * n, *phase = error + n;
    p.n_tau = at->n_tau, p.n_mu = at->n_mu, p.n_phi = at->n_phi, p.n = n;
    p.tau = at->tau, p.mu = at->mu;
    p.scatter = scatter_radiance;
    p.fixed = memory;
    p.from_ground = memory + n;
    set_directions(&p, at, phase + n_phase);
    uncollided_radiance(&p);
    add_first_flights(&p, phase);
    pps_status status = answer(&p, radiance, standard_error ? standard_error : error);
    free(memory);
    return status;
}

/* The three numbers of a depth as fluxes. */
static pps_flux flux_of(const double *y, double direct, double direct_mean) {
    return (pps_flux){.up = y[0],
                      .down = y[1],
                      .direct = direct,
                      .mean_diffuse = y[2],
                      .mean = y[2] + direct_mean};
}

pps_status pps_mc_flux(const pps_slab *slab, double mu0, const pps_mc_opts *opts,
                       size_t n, const double *tau, pps_flux *flux,
                       pps_flux *standard_error) {
    problem p;
    if (problem_of(&p, slab, mu0, opts) || pps_tau_check(n, tau, slab->thickness)) {
        return PPS_ERR_ARGUMENT;
    }
    if (n == 0) {
        return PPS_OK;
    }
    if (!flux) {
        return PPS_ERR_ARGUMENT;
    }
    double *memory = malloc(12 * n * sizeof *memory);
    if (!memory) {
        return PPS_ERR_MEMORY;
    }
    double *value = memory + 6 * n, *error = memory + 9 * n;
    p.n_tau = n, p.n = 3 * n, p.tau = tau;
    p.scatter = scatter_flux;
    p.fixed = memory;
    p.from_ground = memory + 3 * n;
    uncollided_flux(&p);
    add_first_flights(&p, NULL);
    pps_status status = answer(&p, value, error);
    for (size_t k = 0; !status && k < n; k++) {
        double beam = p.light.beam * exp(-tau[k] / mu0);
        flux[k] = flux_of(value + 3 * k, mu0 * beam, beam / (4 * PI));
        if (standard_error) {
            standard_error[k] = flux_of(error + 3 * k, 0, 0);
        }
    }
    free(memory);
    return status;
}

pps_status pps_mc_energy(const pps_slab *slab, double mu0, const pps_mc_opts *opts,
                         pps_mc_budget *budget) {
    problem p;
    double nothing[1];
    pps_status status = problem_of(&p, slab, mu0, opts);
    return status ? status : run_blocks(&p, nothing, budget);
}

/* ---- the method ---- */

typedef struct {
    pps_slab slab;
    double mu0;
    pps_mc_opts opts;
    double error; /* the largest relative standard error of the last output */
} mc;

static pps_status mc_init(void *state, const pps_slab *slab, const pps_options *opts) {
    *(mc *)state = (mc){
        .slab = *slab,
        .opts = {.light = opts->light, .photons = opts->photons, .seed = opts->seed},
        .error = (double)NAN};
    return PPS_OK;
}

static pps_status mc_solve(void *state, double thickness, double mu0) {
    mc *m = state;
    m->slab.thickness = thickness;
    m->mu0 = mu0;
    return PPS_OK;
}

/* The largest of errors relative to their values; an exact value has none. */
static double widen(double worst, double error, double value) {
    return error > 0 ? fmax(worst, error / fabs(value)) : worst;
}

static pps_status mc_radiance(void *state, const pps_grid *at, double *radiance) {
    mc *m = state;
    size_t n = at->n_tau * at->n_mu * at->n_phi;
    double *error = malloc((n + 1) * sizeof *error);
    if (!error) {
        return PPS_ERR_MEMORY;
    }
    pps_status status =
        pps_mc_radiance(&m->slab, m->mu0, &m->opts, at, radiance, error);
    m->error = status ? (double)NAN : 0;
    for (size_t i = 0; !status && i < n; i++) {
        m->error = widen(m->error, error[i], radiance[i]);
    }
    free(error);
    return status;
}

static pps_status mc_flux(void *state, size_t n, const double *tau, pps_flux *flux) {
    mc *m = state;
    pps_flux *error = malloc((n + 1) * sizeof *error);
    if (!error) {
        return PPS_ERR_MEMORY;
    }
    pps_status status = pps_mc_flux(&m->slab, m->mu0, &m->opts, n, tau, flux, error);
    m->error = status ? (double)NAN : 0;
    for (size_t k = 0; !status && k < n; k++) {
        m->error = widen(m->error, error[k].up, flux[k].up);
        m->error = widen(m->error, error[k].down, flux[k].down);
        m->error = widen(m->error, error[k].mean_diffuse, flux[k].mean_diffuse);
    }
    free(error);
    return status;
}

static void mc_query(const void *state, pps_info *info) {
    info->error_estimate = ((const mc *)state)->error;
}

static const pps_method_ops ops = {.state_size = sizeof(mc),
                                   .init = mc_init,
                                   .solve = mc_solve,
                                   .own_light = true,
                                   .radiance = mc_radiance,
                                   .flux = mc_flux,
                                   .query = mc_query};

const pps_method pps_method_mc = {
    .name = "mc",
    .cost = "a photon scatters as often as the slab is optically thick; each time one "
            "exponential or two per wanted number",
    .summary = "Monte Carlo by next-event estimation; error estimate is the largest "
               "relative standard error",
    .limits = "error falls as photons^-1/2; where few photons come (deep in absorbing "
              "slabs) the error estimate is infinite and the value may be wrong by any "
              "factor",
    .fields = true,
    .fluxes = true,
    .half_space = true,
    .ops = &ops,
};

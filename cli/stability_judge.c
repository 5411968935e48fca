/* Is an answer right? Each method is held to the accuracy that it states.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "stability_judge.h"

#include <math.h>
#include <string.h>

/* Methods that state an accuracy. The others are closed forms, approximations that
 * state none for every slab: their reflectance is to be within half of the true one. */
typedef struct {
    const char *method;
    truth_kind truth;
    enum { EACH_NUMBER, FIELD, STANDARD_ERRORS } measure; /* of the tolerance */
} promise;
static const promise promises[] = {{"auto", BY_ADDING, FIELD},
                                   {"exact", BY_ADDING, EACH_NUMBER},
                                   {"adding", BY_STREAMS, EACH_NUMBER},
                                   {"rk", ON_OWN_NODES, EACH_NUMBER},
                                   {"rk-shooting", ON_OWN_NODES, EACH_NUMBER},
                                   {"mc", BY_ADDING, STANDARD_ERRORS}};
static const double closed_form_limit = 0.5;

/* `auto` states its error over the sphere and the first ten depths; a few directions,
 * grazing ones among them, and deeper places may have more. */
static const double few_directions = 3;

/* Standard errors: of the 35,000 numbers of the map one in 50 maps is further off. */
static const double by_chance = 5;

static const double nothing = 1e-290;   /* below, numbers lose digits */
static const double negligible = 1e-12; /* below zero by that share of the largest */
static const double small_share = 1e-3; /* radiances below that share count as it */

const char *verdict_text(verdict v) {
    static const char *const text[] = {[OK] = "ok",
                                       [INACCURATE] = "inaccurate",
                                       [NOT_FINITE] = "not_finite",
                                       [NEGATIVE] = "negative",
                                       [REFUSED] = "refused",
                                       [TOO_SLOW] = "too_slow"};

    return text[v];
}

static const promise *promise_of(const pps_method *method) {
    for (size_t i = 0; i < sizeof promises / sizeof promises[0]; i++) {
        if (strcmp(promises[i].method, method->name) == 0)
            return &promises[i];
    }
    return NULL;
}

truth_kind truth_for(const pps_method *method) {
    const promise *kept = promise_of(method);

    return kept ? kept->truth : BY_ADDING;
}

bool judged_in_full(const pps_method *method) { return promise_of(method) != NULL; }

/* ---- judging ---- */

/* The numbers of a sample in a row: 3 fluxes, then radiances. */
static size_t numbers(const sample *s, double x[SAMPLE_NUMBERS]) {
    size_t n = 0;

    if (s->has_flux) {
        x[n++] = s->up;
        x[n++] = s->down;
        x[n++] = s->mean;
    }
    for (size_t i = 0; s->has_radiance && i < SAMPLE_RADIANCES; i++)
        x[n++] = s->radiance[i];
    return n;
}

static double largest(size_t n, const double *x) {
    double most = 0;

    for (size_t i = 0; i < n; i++)
        most = fmax(most, fabs(x[i]));
    return most;
}

/* What no right answer is, whatever its accuracy. */
static verdict judge_sanity(const sample *got) {
    double x[SAMPLE_NUMBERS];
    size_t n = numbers(got, x);
    double most = largest(n, x);

    for (size_t i = 0; i < n; i++) {
        if (!isfinite(x[i]))
            return NOT_FINITE;
    }
    for (size_t i = 0; i < n; i++) {
        if (x[i] < -negligible * most)
            return NEGATIVE;
    }
    return OK;
}

static double relative(double got, double want, double scale) {
    double difference = fabs(got - want);

    return difference < nothing ? 0 : difference / fmax(fabs(want), scale);
}

static double flux_error(const sample *got, const sample *want) {
    double worst = relative(got->up, want->up, 0);

    worst = fmax(worst, relative(got->down, want->down, 0));
    return fmax(worst, relative(got->mean, want->mean, 0));
}

static double radiance_error(const sample *got, const sample *want) {
    double scale = small_share * largest(SAMPLE_RADIANCES, want->radiance), worst = 0;

    for (size_t i = 0; i < SAMPLE_RADIANCES; i++)
        worst = fmax(worst, relative(got->radiance[i], want->radiance[i], scale));
    return worst;
}

/* The rms over directions by the mean, the mean of it over depths. */
static double field_error(const sample *got, const sample *want) {
    enum { DIRECTIONS = SAMPLE_MUS * SAMPLE_PHIS };
    double sum = 0;

    for (size_t k = 0; k < SAMPLE_DEPTHS; k++) {
        double square = 0, mean = 0;
        for (size_t i = k * DIRECTIONS; i < (k + 1) * DIRECTIONS; i++) {
            double off = got->radiance[i] - want->radiance[i];
            square += off * off / DIRECTIONS;
            mean += want->radiance[i] / DIRECTIONS;
        }
        sum += mean > nothing ? sqrt(square) / mean : 0;
    }
    return sum / SAMPLE_DEPTHS;
}

/* The most standard errors that a number is off, where that is known. */
static double chance_error(const sample *got, const sample *want) {
    double x[SAMPLE_NUMBERS], y[SAMPLE_NUMBERS], worst = 0;
    size_t n = numbers(got, x);

    numbers(want, y);
    for (size_t i = 0; i < n; i++) {
        double off = fabs(x[i] - y[i]) - want->accuracy * fabs(y[i]);
        if (off > nothing && isfinite(got->deviation[i]))
            worst = fmax(worst, off / got->deviation[i]);
    }
    return worst;
}

/* A Monte Carlo that met too few photons says so. */
static bool knows_reflectance(const sample *got) { return isfinite(got->deviation[0]); }

static double each_error(const sample *got, const sample *want) {
    double error = got->has_flux ? flux_error(got, want) : 0;

    return got->has_radiance && want->has_radiance
               ? fmax(error, radiance_error(got, want))
               : error;
}

verdict judge_sample(const pps_method *method, double tolerance, const sample *got,
                     const sample *want, double *error) {
    const promise *kept = promise_of(method);
    verdict v = judge_sanity(got);
    bool right;

    *error = (double)NAN;
    if (v == NOT_FINITE)
        return v;
    if (!kept) {
        *error = got->has_flux ? relative(got->up, want->up, 0) : (double)NAN;
        right = !(*error > closed_form_limit);
    } else if (kept->measure == FIELD) {
        *error = field_error(got, want);
        right = *error <= few_directions * tolerance + want->accuracy;
    } else if (kept->measure == STANDARD_ERRORS && !knows_reflectance(got)) {
        return REFUSED;
    } else {
        *error = each_error(got, want);
        right = kept->measure == STANDARD_ERRORS ? chance_error(got, want) <= by_chance
                                                 : *error <= tolerance + want->accuracy;
    }
    return v == OK && !right ? INACCURATE : v;
}

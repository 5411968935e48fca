/* Discrete ordinates on the crown's cells: sweeps, source iteration, Anderson's mixing.
 *
 * Arrays of leaf cells hold only the cells with leaves, [i] with cell leaf_cell[i]. The
 * sides of a periodic grid and the ground pass on what the sweep before brought there;
 * so they are unknowns too, and follow phi in the state that is iterated.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "tree/lattice.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tree/anderson.h"
#include "tree/grid.h"
#include "tree/ordinates.h"
#include "tree/sweep.h"
#include "tree/vec.h"
#include "tree/wood.h"

static const double PI = 3.14159265358979323846;
static const double KAPPA_MIN = 0.5, KAPPA_MAX = 3;
enum { SWEEPS_MAX = 200, DARK_SWEEPS_MAX = 60, PARALLEL_CELLS = 1500 };

struct pps_lattice {
    size_t n_cells, n_leaf_cells, n_columns;
    int n_directions, threads;
    bool ground, isotropic;
    double gap, kappa_given, excess[PPS_BANDS_MAX];
    pps_leaf_optics *optics; /* of the prototypes, as albedo and excess were found */
    uint32_t *leaf_cell;
    float *leaf_depth;          /* per leaf cell: of its leaves alone */
    float *depth;               /* per cell: sigma times side */
    float *kappa[2];            /* per leaf cell: escape factors of light from outside,
                                   and of light from inside, scattered before */
    pps_bands *albedo, *direct; /* per leaf cell */
    pps_bands *source, *beam;   /* per cell: scattered evenly, and of the sun alone */
    pps_bands
        phase[PPS_SWEEP_DIRECTIONS_MAX]; /* of the sun's first scattering, less 1 */
    pps_bands *sum[2], *flux[2];         /* per cell, downward and upward half */
    pps_bands *fall, *ground_direct,
        *ground_light; /* per column; the last: and beside them */
    size_t n_state;
    pps_bands *state, *image; /* phi of leaf cells, sides if periodic, fall if ground */
    float *weight;            /* per leaf cell: depth */
    float *sky_below; /* [j * n_columns + column]: the share that reaches the ground */
    pps_sweeper sweeper;
    pps_anderson anderson;
};

/* From the grid to the ground, in cells. */
static double gap_below(const pps_scene *scene, const pps_cells *cells) {
    return scene->ground.present
               ? fmax(cells->low[2] - scene->ground.height, 0) / cells->size
               : 0;
}

void pps_lattice_free(pps_lattice *l) {
    if (l) {
        pps_sweeper_clear(&l->sweeper);
        pps_anderson_clear(&l->anderson);
        free(l->optics);
        free(l->leaf_cell);
        free(l->depth);
        free(l->kappa[0]);
        free(l->leaf_depth);
        free(l->state);
        free(l->weight);
        free(l->albedo);
        free(l->source);
        free(l->sky_below);
        free(l);
    }
}

bool pps_lattice_fits(const pps_lattice *l, const pps_lit_scene *lit) {
    const pps_ground *ground = &lit->scene->ground;
    return l->kappa_given == lit->options.kappa && l->ground == ground->present &&
           l->gap == gap_below(lit->scene, lit->cells);
}

void pps_lattice_set_isotropic(pps_lattice *l) { l->isotropic = true; }

const pps_bands *pps_lattice_ground(const pps_lattice *l) {
    return l->ground ? l->ground_light : NULL;
}

void pps_lattice_forget(pps_lattice *l) {
    memset(l->state, 0, l->n_state * sizeof *l->state);
}

double pps_lattice_kappa(const pps_lattice *l, size_t c) {
    for (size_t i = 0; i < l->n_leaf_cells; i++) {
        if (l->leaf_cell[i] == c) {
            return (double)l->kappa[1][i];
        }
    }
    return 1;
}

/* ---- sweeps over both halves of the directions ---- */

static void sweep_both(pps_lattice *l, const pps_sweep half[2]) {
#pragma omp parallel for num_threads(l->threads) if (l->n_cells >= PARALLEL_CELLS)
    for (int h = 0; h < 2; h++) {
        memset(half[h].sum, 0, l->n_cells * sizeof(pps_bands));
        if (half[h].flux) {
            memset(half[h].flux, 0, 3 * l->n_cells * sizeof(pps_bands));
        }
        (h == 0 ? pps_sweep_down : pps_sweep_up)(&l->sweeper, &half[h]);
    }
}

/* The share of light from outside that reaches the cells of a lattice without sources,
 * mean over directions, to 1e-4. */
static void sweep_dark(pps_lattice *l, pps_sweeper *sweeper, const pps_sweep half[2]) {
    double before = -1, now = 0;
    for (int k = 0; k < DARK_SWEEPS_MAX && fabs(now - before) > 1e-4 * now; k++) {
        before = now;
        for (int h = 0; h < 2; h++) {
            memset(half[h].sum, 0, l->n_cells * sizeof(pps_bands));
        }
        pps_sweep_down(sweeper, &half[0]);
        pps_sweep_up(sweeper, &half[1]);
        now = 0;
        for (size_t c = 0; c < l->n_cells; c++) {
            now += (double)(half[0].sum[c][0] + half[1].sum[c][0]);
        }
        if (!sweeper->periodic) {
            break;
        }
    }
}

/* ---- the static part ---- */

static pps_bands *bands_array(size_t n) {
    pps_bands *array = aligned_alloc(sizeof(pps_bands), (n + 1) * sizeof(pps_bands));
    if (array) {
        memset(array, 0, (n + 1) * sizeof(pps_bands));
    }
    return array;
}

static pps_status allocate(pps_lattice *l) {
    size_t n = l->n_cells, m = l->n_leaf_cells;
    l->depth = calloc(n + 1, sizeof *l->depth);
    l->leaf_cell = malloc((m + 1) * sizeof *l->leaf_cell);
    l->kappa[0] = malloc((2 * m + 1) * sizeof *l->kappa[0]);
    l->leaf_depth = malloc((m + 1) * sizeof *l->leaf_depth);
    l->albedo = bands_array(2 * m);
    l->source = bands_array(10 * n + 3 * l->n_columns + 1);
    l->sky_below = calloc(l->n_columns * (size_t)l->n_directions, sizeof(float));
    if (!l->depth || !l->leaf_cell || !l->kappa[0] || !l->leaf_depth || !l->albedo ||
        !l->source || !l->sky_below) {
        return PPS_ERR_MEMORY;
    }
    l->direct = l->albedo + m;
    l->kappa[1] = l->kappa[0] + m;
    for (size_t h = 0; h < 2; h++) {
        l->sum[h] = l->source + (1 + h) * n;
        l->flux[h] = l->source + (3 + 3 * h) * n;
    }
    l->beam = l->source + 9 * n;
    l->fall = l->beam + n;
    l->ground_direct = l->fall + l->n_columns;
    l->ground_light = l->ground_direct + l->n_columns;
    return PPS_OK;
}

/* What the sweeps iterate. Leaves alone are measured: light that crosses the sides settles
 * by itself in a few sweeps, and only has to be mixed as the leaves' light is. */
static pps_status make_state(pps_lattice *l) {
    size_t n = l->n_leaf_cells;
    l->n_state = n + (l->sweeper.periodic ? l->sweeper.n_sides : 0) +
                 (l->ground ? l->n_columns : 0);
    l->state = bands_array(2 * l->n_state);
    l->weight = malloc((n + 1) * sizeof *l->weight);
    if (!l->state || !l->weight) {
        return PPS_ERR_MEMORY;
    }
    l->image = l->state + l->n_state;
    for (size_t i = 0; i < n; i++) {
        l->weight[i] = l->leaf_depth[i];
    }
    return pps_anderson_init(&l->anderson, l->n_state, n);
}

static void set_leaf_cells(pps_lattice *l, const pps_cells *cells) {
    double face = 2 * cells->size * cells->size;
    for (size_t c = 0, i = 0; c < l->n_cells; c++) {
        l->depth[c] = (float)pps_wood_depth(cells, c);
        if (!(cells->area[c] > 0)) {
            continue;
        }
        l->leaf_cell[i] = (uint32_t)c;
        l->leaf_depth[i] = (float)(cells->area[c] / face);
        l->depth[c] += l->leaf_depth[i];
        i++;
    }
}

/* How much of each direction's light reaches the ground. */
static void note_sky_below(pps_lattice *l, const pps_sweeper *sweeper) {
    for (int k = 0; k < sweeper->n_down; k++) {
        const pps_sweep_group *g = &sweeper->group[k];
        for (int d = 0; d < g->n; d++) {
            pps_sweep_clear(sweeper, g, d,
                            l->sky_below + (size_t)g->direction[d] * l->n_columns);
        }
    }
}

/* Seen from the leaves of a cell: the share of the sphere that is clear, and that share
 * squared, more where those leaves that light reaches are those it leaves from again. */
typedef struct {
    double clear, twice;
} outlook;

static outlook look_out(const pps_cells *cells, size_t c) {
    int n = cells->directions.n;
    double sum = 0, squares = 0;
    for (int j = 0; j < n; j++) {
        double v = (double)cells->visibility[c * (size_t)n + (size_t)j];
        sum += v;
        squares += v * v;
    }
    double unrelated = (sum * sum - squares) / (n * (n - 1.0));
    double related = unrelated > 0 ? cells->both_clear[c] / unrelated : 1,
           mean = sum / n;
    return (outlook){mean, fmin(related * mean, 1) * mean};
}

/* Light scattered by leaves that does not get out, over the same on the lattice, by leaf
 * area over 3^3 cells. Light from outside has come by a clear way, and a share twice/clear
 * of it finds one back. What is left for light from inside follows from an enclosure
 * of one radiance, where leaves that do not absorb must not change it: of such light
 * 1 - clear is from inside, and as much must come back of both together. */
static pps_status set_kappa(pps_lattice *l, const pps_cells *cells, double given) {
    size_t n = l->n_cells;
    double *sum = calloc(8 * n + 1, sizeof *sum), *mean = sum ? sum + 4 * n : NULL;
    if (!sum) {
        return PPS_ERR_MEMORY;
    }
    for (size_t i = 0; i < l->n_leaf_cells; i++) {
        size_t c = l->leaf_cell[i];
        outlook o = look_out(cells, c);
        double kept = 1 - (double)(l->sum[0][c][0] + l->sum[1][c][0]);
        const double part[4] = {o.clear - o.twice, o.clear * kept,
                                1 - 2 * o.clear + o.twice, (1 - o.clear) * kept};
        for (size_t k = 0; k < 4; k++) {
            sum[k * n + c] = cells->area[c] * part[k];
        }
    }
    for (size_t k = 0; k < 4; k++) {
        pps_grid_smooth(cells, sum + k * n, mean + k * n);
    }
    for (size_t i = 0; i < 2 * l->n_leaf_cells; i++) {
        size_t k = i / l->n_leaf_cells, m = i % l->n_leaf_cells;
        const double *at = mean + 2 * k * n + l->leaf_cell[m];
        double ratio = at[n] > 0 ? at[0] / at[n] : k > 0 ? (double)l->kappa[0][m] : 1;
        l->kappa[k][m] =
            (float)(given > 0 ? given : fmin(fmax(ratio, KAPPA_MIN), KAPPA_MAX));
    }
    free(sum);
    return PPS_OK;
}

/* What of light from outside, along the directions that visibilities are known for,
 * reaches cells and ground through a lattice without sources. */
static pps_status measure_escape(pps_lattice *l, const pps_cells *cells, double kappa) {
    double weight[PPS_SWEEP_DIRECTIONS_MAX];
    pps_sweeper sweeper = {0};
    pps_bands one = pps_bands_all(1);
    pps_sweep half[2] = {{.source = l->source,
                          .beam = l->beam,
                          .phase = l->phase,
                          .top = one,
                          .side = one,
                          .sum = l->sum[0]},
                         {.source = l->source,
                          .beam = l->beam,
                          .phase = l->phase,
                          .top = one,
                          .side = one,
                          .sum = l->sum[1]}};
    for (int j = 0; j < l->n_directions; j++) {
        weight[j] = 1.0 / l->n_directions;
    }
    pps_status status =
        pps_sweeper_init(&sweeper, cells->n, cells->periodic, l->depth, l->n_directions,
                         cells->directions.to, weight, l->gap);
    if (!status) {
        sweep_dark(l, &sweeper, half);
        note_sky_below(l, &sweeper);
        status = set_kappa(l, cells, kappa);
    }
    pps_sweeper_clear(&sweeper);
    return status;
}

static pps_status plan_sweeps(pps_lattice *l, const pps_cells *cells) {
    double to[PPS_ORDINATES][3], weight[PPS_ORDINATES];
    pps_ordinates(to, weight);
    return pps_sweeper_init(&l->sweeper, cells->n, cells->periodic, l->depth,
                            PPS_ORDINATES, (const double(*)[3])to, weight, l->gap);
}

/* (rho - tau) / (rho + tau) of the scene's leaves, by area. */
static double reflected_excess(const pps_scene *scene, int band) {
    double excess = 0, sum = 0;
    for (size_t k = 0; k < scene->n_instances; k++) {
        const pps_prototype *p = &scene->prototype[scene->instance[k].prototype];
        const pps_leaf_optics *o = &p->optics;
        double area = 0, square = pow(scene->instance[k].scale, 2);
        for (size_t i = 0; i < p->mesh->n_leaves; i++) {
            area += square * p->mesh->leaf[i].area;
        }
        for (int face = 0; face < 2; face++) {
            double r = o->reflectance[face][band], t = o->transmittance[face][band];
            excess += area * (r - t);
            sum += area * (r + t);
        }
    }
    return sum > 0 ? excess / sum : 0;
}

/* What leaves do with light, unless it is known already. */
static pps_status set_optics(pps_lattice *l, const pps_scene *scene,
                             const pps_cells *cells) {
    size_t n = scene->n_prototypes, bands = (size_t)scene->n_bands;
    bool same = l->optics;
    for (size_t p = 0; p < n && same; p++) {
        same =
            memcmp(&l->optics[p], &scene->prototype[p].optics, sizeof *l->optics) == 0;
    }
    if (same) {
        return PPS_OK;
    }
    float *albedo = NULL;
    l->optics = l->optics ? l->optics : calloc(n, sizeof *l->optics);
    if (!l->optics || pps_cell_albedos(scene, cells, &albedo)) {
        return PPS_ERR_MEMORY;
    }
    for (size_t p = 0; p < n; p++) {
        l->optics[p] = scene->prototype[p].optics;
    }
    for (size_t b = 0; b < bands; b++) {
        l->excess[b] = reflected_excess(scene, (int)b);
        for (size_t i = 0; i < l->n_leaf_cells; i++) {
            l->albedo[i][b] = albedo[l->leaf_cell[i] * bands + b];
        }
    }
    free(albedo);
    return PPS_OK;
}

static void count_cells(pps_lattice *l, const pps_scene *scene,
                        const pps_cells *cells) {
    l->n_cells = cells->n_cells;
    l->n_columns = (size_t)cells->n[0] * (size_t)cells->n[1];
    l->n_directions = cells->directions.n;
    l->ground = scene->ground.present;
    l->gap = gap_below(scene, cells);
    for (size_t c = 0; c < cells->n_cells; c++) {
        l->n_leaf_cells += cells->area[c] > 0;
    }
}

pps_status pps_lattice_create(const pps_scene *scene, const pps_cells *cells,
                              double kappa, int threads, pps_lattice **out) {
    *out = NULL;
    pps_lattice *l = calloc(1, sizeof *l);
    if (!l) {
        return PPS_ERR_MEMORY;
    }
    count_cells(l, scene, cells);
    l->kappa_given = kappa;
    l->threads = pps_thread_count(threads) > 1 ? 2 : 1;
    pps_status status = allocate(l);
    if (!status) {
        status = plan_sweeps(l, cells);
    }
    if (!status) {
        set_leaf_cells(l, cells);
        status = set_optics(l, scene, cells);
    }
    if (!status) {
        status = measure_escape(l, cells, kappa);
    }
    if (!status) {
        status = make_state(l);
    }
    if (status) {
        pps_lattice_free(l);
        return status;
    }
    *out = l;
    return PPS_OK;
}

/* ---- the light ---- */

/* Leaves of random orientation that scatter by Lambert's law have the phase function
 *     1 - 4/3 (rho - tau)/(rho + tau) cos + 5/16 P2(cos) + ..
 * (its moments are those of the leaf's |n.s|, squared). It counts where light has one
 * direction: the first time the sun's is scattered. */
static void set_phase(pps_lattice *l, const pps_scene *scene) {
    double to[PPS_ORDINATES][3], weight[PPS_ORDINATES];
    pps_ordinates(to, weight);
    pps_bands odd = {0};
    for (int b = 0; b < scene->n_bands; b++) {
        odd[b] = (float)(-4.0 / 3 * l->excess[b]);
    }
    double even = l->isotropic ? 0 : 5.0 / 32;
    for (int j = 0; j < PPS_ORDINATES; j++) {
        double mu = vec_dot(to[j], scene->sun.to);
        l->phase[j] = (float)(l->isotropic ? 0 : mu) * odd +
                      pps_bands_all((float)(even * (3 * mu * mu - 1)));
    }
}

/* Fluence of sun and sky at the leaves, by measured visibilities, times the escape factor
 * of what is scattered of it. */
static void set_direct(pps_lattice *l, const pps_lit_scene *lit) {
    const pps_scene *scene = lit->scene;
    const pps_cells *cells = lit->cells;
    bool sun = lit->options.sources & PPS_SUN_INDIRECT,
         sky = lit->options.sources & PPS_SKY_INDIRECT;
    pps_bands e = {0}, part[PPS_SWEEP_DIRECTIONS_MAX] = {0};
    for (int b = 0; b < scene->n_bands; b++) {
        e[b] = sun ? (float)scene->sun.irradiance[b] : 0;
        for (int j = 0; sky && j < l->n_directions; j++) {
            part[j][b] =
                (float)(4 * PI / l->n_directions * pps_sky_part(scene, cells, j, b));
        }
    }
    set_phase(l, scene);
    for (size_t i = 0; i < l->n_leaf_cells; i++) {
        size_t c = l->leaf_cell[i];
        const float *seen = &cells->visibility[c * (size_t)l->n_directions];
        l->direct[i] = l->kappa[0][i] * (float)cells->sun_visibility[c] * e;
        l->beam[c] = l->leaf_depth[i] * l->albedo[i] * l->direct[i];
        for (int j = 0; sky && j < l->n_directions; j++) {
            l->direct[i] += l->kappa[0][i] * seen[j] * part[j];
        }
    }
}

/* The share of the sun's light that reaches the ground: a sweep of its own direction. */
static pps_status sun_below(pps_lattice *l, const pps_lit_scene *lit, float *clear) {
    pps_sweeper sweeper;
    double to[1][3];
    memcpy(to, lit->scene->sun.to, sizeof to);
    pps_status status =
        pps_sweeper_init(&sweeper, lit->cells->n, lit->cells->periodic, l->depth, 1,
                         (const double(*)[3])to, &(double){1}, l->gap);
    if (status) {
        return status;
    }
    pps_bands one = pps_bands_all(1);
    memset(l->source, 0, l->n_cells * sizeof(pps_bands));
    pps_sweep half[2] = {
        {.source = l->source,
         .beam = l->source,
         .phase = l->phase,
         .top = one,
         .side = one,
         .sum = l->sum[0]},
        {.source = l->source, .beam = l->source, .phase = l->phase, .sum = l->sum[1]}};
    sweep_dark(l, &sweeper, half);
    pps_sweep_clear(&sweeper, &sweeper.group[0], 0, clear);
    pps_sweeper_clear(&sweeper);
    return PPS_OK;
}

/* Irradiance of the ground by sun and sky: in the columns under the grid, and `far`, where
 * nothing shades it. */
static pps_status light_ground(pps_lattice *l, const pps_lit_scene *lit,
                               pps_bands *far) {
    const pps_scene *scene = lit->scene;
    float *clear = malloc((l->n_columns + 1) * sizeof *clear);
    pps_distant lights[PPS_SWEEP_DIRECTIONS_MAX + 1];
    int n = pps_distant_lights(lit, lights);
    pps_status status = clear ? PPS_OK : PPS_ERR_MEMORY;
    memset(l->ground_direct, 0, l->n_columns * sizeof(pps_bands));
    *far = pps_bands_all(0);
    for (int k = 0; k < n && !status; k++) {
        const pps_distant *light = &lights[k];
        if (!(light->to[2] > 0)) {
            continue;
        }
        const float *share = clear;
        if (light->direction >= 0) {
            share = l->sky_below + (size_t)light->direction * l->n_columns;
        } else {
            status = sun_below(l, lit, clear);
        }
        pps_bands e = {0};
        for (int b = 0; b < scene->n_bands; b++) {
            e[b] = (float)(light->irradiance[b] * light->to[2]);
        }
        *far += e;
        for (size_t i = 0; i < l->n_columns && !status; i++) {
            l->ground_direct[i] += share[i] * e;
        }
    }
    free(clear);
    return status;
}

/* ---- source iteration ---- */

/* What leaves scatter of their direct light and phi, the state's first part; what stays
 * among them, that is, as if it did so on the lattice. */
static void set_source(pps_lattice *l) {
    for (size_t i = 0; i < l->n_leaf_cells; i++) {
        size_t c = l->leaf_cell[i];
        l->source[c] = l->leaf_depth[i] * l->albedo[i] *
                       (l->direct[i] + l->kappa[1][i] * l->state[i]);
    }
}

/* What the ground sends up, I = 4 pi times its radiance: 4 times its exitance. */
static void set_ground_light(pps_lattice *l, const pps_bands *reflectance,
                             const pps_bands *fall) {
    for (size_t i = 0; i < l->n_columns; i++) {
        l->ground_light[i] = 4 * *reflectance * (l->ground_direct[i] + fall[i]);
    }
}

/* Carry the state's light once through the grid: sums over directions in l->sum, sides in
 * the sweeper, and l->fall. */
static void sweep_once(pps_lattice *l, const pps_bands *reflectance, pps_bands far,
                       bool flux) {
    pps_sweep half[2] = {
        {.source = l->source, .beam = l->beam, .phase = l->phase, .sum = l->sum[0]},
        {.source = l->source, .beam = l->beam, .phase = l->phase, .sum = l->sum[1]}};
    const pps_bands *sides = l->state + l->n_leaf_cells;
    size_t n_sides = l->sweeper.periodic ? l->sweeper.n_sides : 0;
    memcpy(l->sweeper.faces, sides, n_sides * sizeof *sides);
    if (l->ground) {
        set_ground_light(l, reflectance, sides + n_sides);
        memset(l->fall, 0, l->n_columns * sizeof(pps_bands));
        half[0].fall = l->fall;
        half[1].ground = l->ground_light;
        half[1].side = 4 * *reflectance * far;
    }
    for (int h = 0; h < 2 && flux; h++) {
        half[h].flux = l->flux[h];
    }
    set_source(l);
    sweep_both(l, half);
}

static void take_image(pps_lattice *l) {
    pps_bands *image = l->image;
    for (size_t i = 0; i < l->n_leaf_cells; i++) {
        size_t c = l->leaf_cell[i];
        *image++ = l->sum[0][c] + l->sum[1][c];
    }
    if (l->sweeper.periodic) {
        memcpy(image, l->sweeper.faces, l->sweeper.n_sides * sizeof *image);
        image += l->sweeper.n_sides;
    }
    if (l->ground) {
        memcpy(image, l->fall, l->n_columns * sizeof *image);
    }
}

static pps_status iterate(pps_lattice *l, const pps_bands *reflectance, pps_bands far,
                          double tolerance, int *sweeps) {
    double change = (double)INFINITY;
    pps_anderson_restart(&l->anderson);
    for (*sweeps = 0; change > tolerance; ++*sweeps) {
        if (*sweeps == SWEEPS_MAX) {
            return PPS_ERR_CONVERGENCE;
        }
        sweep_once(l, reflectance, far, false);
        take_image(l);
        change = pps_anderson_step(&l->anderson, l->weight, l->state, l->image);
    }
    return PPS_OK;
}

static void give(const pps_lattice *l, pps_light_field *field) {
    size_t bands = (size_t)field->n_bands;
    for (size_t i = 0; i < l->n_leaf_cells; i++) {
        size_t c = l->leaf_cell[i];
        for (size_t b = 0; b < bands; b++) {
            field->diffuse[c * bands + b] = (l->sum[0][c] + l->sum[1][c])[b];
            for (size_t k = 0; k < 3; k++) {
                field->flux[3 * (c * bands + b) + k] =
                    (l->flux[0][3 * c + k] + l->flux[1][3 * c + k])[b];
            }
        }
    }
}

pps_status pps_lattice_solve(pps_lattice *l, const pps_lit_scene *lit, double tolerance,
                             pps_light_field *field) {
    pps_bands reflectance = {0}, far = {0};
    for (int b = 0; b < lit->scene->n_bands; b++) {
        reflectance[b] = (float)lit->scene->ground.reflectance[b];
    }
    pps_status status = set_optics(l, lit->scene, lit->cells);
    set_direct(l, lit);
    if (!status && l->ground) {
        status = light_ground(l, lit, &far);
    }
    if (!status) {
        memset(l->source, 0, l->n_cells * sizeof(pps_bands));
        status = iterate(l, &reflectance, far, tolerance, &field->sweeps);
    }
    if (!status) { /* once more, for the net flux too */
        sweep_once(l, &reflectance, far, true);
        l->ground_light[l->n_columns] = 4 * reflectance * far;
        field->sweeps++;
        give(l, field);
    }
    return status;
}

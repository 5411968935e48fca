/* How long the steps and frames take.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PREVIEW_BENCH_H
#define PREVIEW_BENCH_H

#include "preview/options.h"

/* Open OpenGL and the scene, and print CSV: step,work,ms,... (docs/preview.md). An exit
 * code, its problem. */
int bench_run(const preview_options *options, pps_problem *problem);

#endif

/* The window: orbit, a moving sun, models by key.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PREVIEW_WINDOW_H
#define PREVIEW_WINDOW_H

#include "preview/options.h"

/* Until the window is closed. An exit code, and its problem. */
int window_run(const preview_options *options, pps_problem *problem);

#endif

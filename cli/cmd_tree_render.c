/* ppscat tree render: a scene as a PNG, by the light on its leaves or in false colour.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli.h"
#include "commands.h"
#include "output.h"
#include "tree_panels.h"
#include "values.h"

enum { SIZE_MIN = 16, SIZE_MAX_PIXELS = 16384, SHEET_MAX = 60000 };

static int read_size(const invocation *call, picture_wish *w) {
    const char *text = option_text(call, OPT_SIZE);
    char end;

    if (sscanf(text, "%5dx%5d%c", &w->width, &w->height, &end) == 2 &&
        w->width >= SIZE_MIN && w->width <= SIZE_MAX_PIXELS && w->height >= SIZE_MIN &&
        w->height <= SIZE_MAX_PIXELS)
        return CLI_DONE;
    return cli_usage(
        "--size: '%.60s' is not possible; allowed: WIDTHxHEIGHT, %d to %d pixels each",
        text, SIZE_MIN, SIZE_MAX_PIXELS);
}

static int read_view(const invocation *call, picture_wish *w) {
    int rc = value_pair(call, OPT_VIEW, w->view);

    if (rc != CLI_DONE || (fabs(w->view[0]) <= 360 && fabs(w->view[1]) <= 90))
        return rc;
    return cli_usage(
        "--view: '%.60s' is out of range; allowed: an azimuth from -360 to 360 and an "
        "elevation from -90 to 90",
        option_text(call, OPT_VIEW));
}

static int read_colors(const invocation *call, picture_wish *w) {
    int what = SHOW_LIGHT, rc = CLI_DONE;

    w->ranged = option_given(call, OPT_RANGE);
    w->title = call->text[OPT_FALSE_COLOR];
    if (w->ranged && !w->title)
        return cli_usage("--range is for --false-color");
    if (w->title)
        rc = value_choice(call, OPT_FALSE_COLOR, &what);
    w->what = (shown)what;
    if (rc == CLI_DONE && w->ranged)
        rc = value_pair(call, OPT_RANGE, w->range);
    if (rc == CLI_DONE && w->ranged && !(w->range[0] < w->range[1]))
        return cli_usage("--range: '%.60s' is empty; allowed: LOW below HIGH",
                         call->text[OPT_RANGE]);
    return rc;
}

static int read_wish(const invocation *call, picture_wish *w) {
    int rc;

    *w = (picture_wish){.path = call->text[OPT_OUTPUT]};
    size_t length = w->path ? strlen(w->path) : 0;
    if (length < 5 || strcmp(w->path + length - 4, ".png") != 0)
        return cli_usage("--output: '%.60s' is not possible; allowed: FILE.png",
                         w->path ? w->path : "");
    if (option_given(call, OPT_EXPOSURE) &&
        (rc = value_number(call, OPT_EXPOSURE, &w->exposure)))
        return rc;
    if ((rc = read_size(call, w)) || (rc = read_view(call, w)))
        return rc;
    return read_colors(call, w);
}

/* Panels are as large as --size says: too many of them are no PNG. */
static int check_sheet(const invocation *call, const picture_wish *w,
                       const tree_asked *asked) {
    int across, down;

    tree_panels_count(asked, w->width, &across, &down);
    if (across * w->width <= SHEET_MAX && down * w->height <= SHEET_MAX)
        return CLI_DONE;
    return cli_usage("--size: '%.60s' is too large for %d x %d panels; allowed: %d "
                     "pixels for all across, and all down",
                     option_text(call, OPT_SIZE), across, down, SHEET_MAX);
}

static int check_split(const picture_wish *w, const tree_asked *asked) {
    for (size_t i = 0; i < asked->n_components; i++) {
        if (asked->component[i]->split && w->what != SHOW_LIGHT)
            return cli_usage("--component: '%s' has colours of its own; allowed with "
                             "--false-color: names without +split",
                             asked->component[i]->name);
    }
    return CLI_DONE;
}

int cmd_tree_render(const invocation *call) {
    pps_scene *scene = NULL;
    tree_settings settings;
    tree_asked asked = {0};
    picture_wish w;
    int rc = tree_settings_read(call, &settings);

    if (rc == CLI_DONE)
        rc = read_wish(call, &w);
    if (rc == CLI_DONE)
        rc = output_writable(w.path);
    if (rc == CLI_DONE)
        rc = tree_asked_read(call, true, &asked);
    if (rc == CLI_DONE)
        rc = check_sheet(call, &w, &asked);
    if (rc == CLI_DONE)
        rc = check_split(&w, &asked);
    if (rc == CLI_DONE)
        rc = tree_scene_open(call, &scene);
    if (rc == CLI_DONE) {
        tree_work work = {.scene = scene, .settings = &settings};
        rc = tree_panels_draw(&w, &work, &asked);
        tree_work_free(&work);
    }
    tree_asked_free(&asked);
    pps_scene_free(scene);
    return rc;
}

/* One headless context, the group's own.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "tests/preview/context.h"

#include "preview/headless.h"
#include "support/support.h"

static headless *context;

int context_setup(void **state) {
    (void)state;
    pps_problem problem = {""};
    context = headless_open(&problem);
    if (!context) {
        print_message("%s\n", problem.text);
    }
    return context ? 0 : -1;
}

int context_teardown(void **state) {
    (void)state;
    headless_close(context);
    return 0;
}

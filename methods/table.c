/* The table of methods.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <string.h>

#include <ppscat/method.h>

#define METHOD(name) extern const pps_method pps_method_##name;
#include "methods/methods.def"
#undef METHOD

static const pps_method *const table[] = {
#define METHOD(name) &pps_method_##name,
#include "methods/methods.def"
#undef METHOD
};

const pps_method *const *pps_method_table(size_t *n) {
    *n = sizeof table / sizeof table[0];
    return table;
}

const pps_method *pps_method_find(const char *name) {
    for (size_t i = 0; name && i < sizeof table / sizeof table[0]; i++) {
        if (strcmp(table[i]->name, name) == 0) {
            return table[i];
        }
    }
    return NULL;
}

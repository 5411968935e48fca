/* The sun over a day: its highest place, its turn, and where it sets.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>

#include "preview/sun_path.h"
#include "support/support.h"

/* On the equator at an equinox: 15 degrees an hour, up from the east and over the head. */
static void an_equinox_on_the_equator(void **state) {
    (void)state;
    double sun[2] = {0, 30};
    assert_close(sun_hour(sun, 0), 8, 1e-12, 0);
    assert_true(sun_pass(sun, 0, 2));
    assert_close(sun[1], 60, 1e-9, 0);
    assert_true(sun_pass(sun, 0, 4));
    assert_close(sun[1], 60, 1e-9, 0);
    assert_close(fabs(sun[0]), 180, 1e-9, 0);
    assert_close(sun_hour(sun, 0), 14, 1e-12, 0);
}

/* Noon at latitude 50: due south, as high as 90 - 50 + declination. */
static void noon_is_due_south(void **state) {
    (void)state;
    double sun[2] = {-90, 63.4};
    assert_close(sun_hour(sun, 50), 12, 1e-12, 0);
    assert_true(sun_pass(sun, 50, -3));
    assert_true(sun[1] < 60 && sun[0] > -90 && sun[0] < 0);
    assert_close(sun_hour(sun, 50), 9, 1e-9, 0);
    assert_true(sun_pass(sun, 50, 3));
    assert_close(sun[0], -90, 1e-9, 0);
    assert_close(sun[1], 63.4, 1e-9, 0);
}

static void the_sun_does_not_set(void **state) {
    (void)state;
    double sun[2] = {-90, 40};
    assert_false(sun_pass(sun, 50, 12));
    assert_close(sun[1], 40, 0, 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(an_equinox_on_the_equator),
                                       cmocka_unit_test(noon_is_due_south),
                                       cmocka_unit_test(the_sun_does_not_set)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

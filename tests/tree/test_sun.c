/* Where the sun stands, against published values.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>

#include <ppscat/tree/scene.h>

#include "support/support.h"
#include "tree/sun.h"

static const double DEGREE = 3.14159265358979323846 / 180;

static void times_are_julian_days(void **state) {
    (void)state;
    static const struct {
        const char *time;
        double julian;
    } rows[] = {
        {"2000-01-01T12:00:00Z", 2451545.0}, /* Meeus, chapter 7 */
        {"1999-01-01T00:00:00Z", 2451179.5},
        {"1987-01-27T00:00:00Z", 2446822.5},
        {"1987-06-19T12:00:00Z", 2446966.0},
        {"1988-01-27T00:00:00Z", 2447187.5},
        {"1900-01-01T00:00:00Z", 2415020.5},
        {"2003-10-17T12:30:30-07:00", 2452930.312847}, /* RA04 */
        {"2026-03-01T01:00+02:00", 2461100.5 - 1 / 24.0},
        {"2024-02-29T00:00Z", 2460369.5},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        double julian;
        assert_true(pps_sun_julian(rows[i].time, &julian));
        assert_close(julian, rows[i].julian, 0, 1e-6);
    }
}

static void other_times_are_refused(void **state) {
    (void)state;
    static const char *const TIMES[] = {
        "",
        "noon",
        "2026-06-21",
        "2026-06-21T12:00",
        "2026-06-21T12:00:00",
        "2026-06-21 12:00:00Z",
        "2026-6-21T12:00:00Z",
        "2026-13-21T12:00:00Z",
        "2026-02-29T12:00:00Z",
        "2026-06-21T24:00:00Z",
        "2026-06-21T12:60:00Z",
        "2026-06-21T12:00:00+2",
        "2026-06-21T12:00:00+0200",
        "2026-06-21T12:00:00Z ",
        "1899-06-21T12:00:00Z",
        "2101-06-21T12:00:00Z",
        "+026-06-21T12:00:00Z",
    };
    for (size_t i = 0; i < sizeof TIMES / sizeof *TIMES; i++) {
        double julian, to[3];
        assert_false(pps_sun_julian(TIMES[i], &julian));
        assert_int_equal(pps_sun_direction(0, 0, TIMES[i], to, NULL), PPS_ERR_ARGUMENT);
    }
}

/* Right ascension and declination. */
static void the_sun_is_among_the_stars_where_almanacs_have_it(void **state) {
    (void)state;
    static const struct {
        double julian, ascension, declination;
    } rows[] = {
        {2448908.5, 198.38083, -7.78507},      /* Meeus, example 25.a */
        {2452930.312847, 202.22741, -9.31434}, /* RA04, Table A5.1 */
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        double ascension, declination, sidereal;
        pps_sun_equator(rows[i].julian, &ascension, &declination, &sidereal);
        assert_close(fmod(ascension / DEGREE + 360, 360), rows[i].ascension, 0, 0.01);
        assert_close(declination / DEGREE, rows[i].declination, 0, 0.01);
    }
}

/* Zenith distance without refraction, and azimuth eastward from north. */
static void the_sun_is_in_the_sky_where_it_is_seen(void **state) {
    (void)state;
    double to[3];
    /* RA04, Table A5.1: Golden, Colorado. */
    assert_int_equal(
        pps_sun_direction(39.742476, -105.1786, "2003-10-17T12:30:30-07:00", to, NULL),
        PPS_OK);
    assert_close(asin(to[2]) / DEGREE, 39.872046, 0, 0.02);
    assert_close(fmod(atan2(to[0], to[1]) / DEGREE + 360, 360), 194.34024, 0, 0.02);
    assert_close(to[0] * to[0] + to[1] * to[1] + to[2] * to[2], 1, 1e-14, 0);
    /* Morning is east; from the south the noon sun is in the north. */
    pps_sun_direction(0, 0, "2026-03-20T08:00Z", to, NULL);
    assert_true(to[0] > 0.8);
    pps_sun_direction(-60, 0, "2026-03-20T12:00Z", to, NULL);
    assert_true(to[1] > 0.8);
    /* At the June solstice of 2026 it is overhead at 23.4363 degrees north (the obliquity),
     * on the meridian where it is noon by the equation of time: -1 min 54 s. */
    pps_sun_direction(23.436, 0, "2026-06-21T12:01:54Z", to, NULL);
    assert_close(acos(to[2]) / DEGREE, 0, 0, 0.02);
}

static void places_off_the_globe_are_refused(void **state) {
    (void)state;
    double to[3];
    pps_problem problem;
    assert_int_equal(pps_sun_direction(91, 0, "2026-06-21T12:00:00Z", to, &problem),
                     PPS_ERR_ARGUMENT);
    assert_string_equal(problem.text,
                        "latitude 91, longitude 0: they must be from -90 to "
                        "90 and from -360 to 360 degrees");
    assert_int_equal(
        pps_sun_direction(0, (double)NAN, "2026-06-21T12:00:00Z", to, NULL),
        PPS_ERR_ARGUMENT);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(times_are_julian_days),
        cmocka_unit_test(other_times_are_refused),
        cmocka_unit_test(the_sun_is_among_the_stars_where_almanacs_have_it),
        cmocka_unit_test(the_sun_is_in_the_sky_where_it_is_seen),
        cmocka_unit_test(places_off_the_globe_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

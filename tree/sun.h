/* Where the sun stands.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_TREE_SUN_H
#define PPS_TREE_SUN_H

#include <stdbool.h>

/* What a time looks like, for messages. */
#define PPS_SUN_TIME                                                                   \
    "a date and time with its zone, as 2026-06-21T12:00:00Z or "                       \
    "2026-06-21T12:00+02:00, of the years 1900 to 2100"

/* The Julian day of such a time; false: it is none. */
bool pps_sun_julian(const char *time, double *julian_day);

/* Apparent right ascension and declination, and Greenwich's apparent sidereal time;
 * radians. */
void pps_sun_equator(double julian_day, double *ascension, double *declination,
                     double *sidereal);

#endif

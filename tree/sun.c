/* Where the sun stands: Meeus98, chapter 25, low
 * accuracy (0.01 degree), with the apparent sidereal time of chapter 12.
 *
 * Geometric: refraction, which lifts the sun by 0.02 degree at 40 degrees of elevation and
 * by half a degree on the horizon, and parallax (0.0024 degree) are left out; so is the
 * difference of terrestrial and universal time, 0.001 degree.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>

#include <ppscat/tree/scene.h>

#include "tree/problem.h"
#include "tree/sun.h"

static const double DEGREE = 3.14159265358979323846 / 180;

/* Exactly n digits, within bounds; moves on. */
static bool number(const char **s, int n, int low, int high, int *out) {
    *out = 0;
    for (int i = 0; i < n; i++, (*s)++) {
        if (**s < '0' || **s > '9') {
            return false;
        }
        *out = 10 * *out + (**s - '0');
    }
    return *out >= low && *out <= high;
}

static bool mark(const char **s, char c) {
    bool here = **s == c;
    *s += here;
    return here;
}

/* Julian day of noon of a day of the Gregorian calendar (Meeus Eq. 7.1). */
static double noon_of(int year, int month, int day) {
    if (month <= 2) {
        year--;
        month += 12;
    }
    int leaps = 2 - year / 100 + year / 400; /* of the Gregorian calendar */
    return floor(365.25 * (year + 4716)) + floor(30.6001 * (month + 1)) + day + leaps -
           1524;
}

static int days_in(int year, int month) {
    static const int DAYS[] = {31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
    bool leap = (year % 4 == 0 && year % 100 != 0) || year % 400 == 0;
    return DAYS[month - 1] + (month == 2 && leap);
}

/* Z, or +hh:mm, in minutes; nothing may follow. */
static bool zone(const char **s, int *minutes) {
    int h, m;
    *minutes = 0;
    if (mark(s, 'Z')) {
        return **s == '\0';
    }
    int sign = mark(s, '+') ? 1 : mark(s, '-') ? -1 : 0;
    if (!sign || !number(s, 2, 0, 14, &h) || !mark(s, ':') ||
        !number(s, 2, 0, 59, &m)) {
        return false;
    }
    *minutes = sign * (60 * h + m);
    return **s == '\0';
}

bool pps_sun_julian(const char *s, double *julian_day) {
    int year, month, day, hour, minute, second = 0, offset;
    bool good = number(&s, 4, 1900, 2100, &year) && mark(&s, '-') &&
                number(&s, 2, 1, 12, &month) && mark(&s, '-') &&
                number(&s, 2, 1, days_in(year, month), &day) && mark(&s, 'T') &&
                number(&s, 2, 0, 23, &hour) && mark(&s, ':') &&
                number(&s, 2, 0, 59, &minute);
    if (good && mark(&s, ':')) {
        good = number(&s, 2, 0, 60, &second);
    }
    if (!good || !zone(&s, &offset)) {
        return false;
    }
    *julian_day = noon_of(year, month, day) +
                  (hour - 12 + (minute - offset + second / 60.0) / 60) / 24;
    return true;
}

void pps_sun_equator(double julian_day, double *ascension, double *declination,
                     double *sidereal) {
    double days = julian_day - 2451545, t = days / 36525;
    double mean = 280.46646 + t * (36000.76983 + t * 0.0003032); /* Eq. 25.2 */
    double anomaly = (357.52911 + t * (35999.05029 - t * 0.0001537)) * DEGREE;
    double center = (1.914602 - t * (0.004817 + t * 0.000014)) * sin(anomaly) +
                    (0.019993 - t * 0.000101) * sin(2 * anomaly) +
                    0.000289 * sin(3 * anomaly);
    double node = (125.04 - 1934.136 * t) * DEGREE;
    double nutation = -0.00478 * sin(node);
    double longitude = (mean + center - 0.00569 + nutation) * DEGREE;
    double obliquity = (23.4392911 - 0.0130042 * t + 0.00256 * cos(node)) * DEGREE;
    *ascension = atan2(cos(obliquity) * sin(longitude), cos(longitude)); /* Eq. 25.6 */
    *declination = asin(sin(obliquity) * sin(longitude));
    *sidereal = (280.46061837 + 360.98564736629 * days + 0.000387933 * t * t +
                 nutation * cos(obliquity)) *
                DEGREE; /* Eq. 12.4, at Greenwich */
}

pps_status pps_sun_direction(double latitude, double longitude, const char *time,
                             double to[3], pps_problem *problem) {
    double julian, ascension, declination, sidereal;
    if (!(fabs(latitude) <= 90) || !(fabs(longitude) <= 360)) {
        return pps_complain(
            problem, PPS_ERR_ARGUMENT,
            "latitude %g, longitude %g: they must be from -90 to 90 and "
            "from -360 to 360 degrees",
            latitude, longitude);
    }
    if (!pps_sun_julian(time, &julian)) {
        return pps_complain(problem, PPS_ERR_ARGUMENT, "time '%.40s': it must be %s",
                            time, PPS_SUN_TIME);
    }
    pps_sun_equator(julian, &ascension, &declination, &sidereal);
    double hour = sidereal + longitude * DEGREE - ascension;
    double phi = latitude * DEGREE;
    to[0] = -cos(declination) * sin(hour); /* Eqs. 13.5, 13.6 as a vector */
    to[1] = sin(declination) * cos(phi) - cos(declination) * cos(hour) * sin(phi);
    to[2] = sin(declination) * sin(phi) + cos(declination) * cos(hour) * cos(phi);
    return PPS_OK;
}

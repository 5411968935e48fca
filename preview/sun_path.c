/* Turning about the pole of the sky.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "preview/sun_path.h"

#include <math.h>

static const double DEGREE = 3.14159265358979323846 / 180, LOWEST = 1;

/* Hour angle, westwards from the meridian, and sine of the declination. The equator's
 * highest point is (0, -sin, cos) of the latitude, the pole (0, cos, sin). */
static void read_sun(const double sun[2], double latitude, double *hour, double *sine) {
    double a = sun[0] * DEGREE, e = sun[1] * DEGREE, l = latitude * DEGREE;
    double east = cos(e) * cos(a), north = cos(e) * sin(a), up = sin(e);
    *hour = atan2(-east, up * cos(l) - north * sin(l)) / DEGREE;
    *sine = north * cos(l) + up * sin(l);
}

double sun_hour(const double sun[2], double latitude) {
    double hour, sine;
    read_sun(sun, latitude, &hour, &sine);
    return 12 + hour / 15;
}

bool sun_pass(double sun[2], double latitude, double hours) {
    double hour, sine, l = latitude * DEGREE;
    read_sun(sun, latitude, &hour, &sine);
    hour = (hour + 15 * hours) * DEGREE;
    double cosine = sqrt(fmax(1 - sine * sine, 0)), east = -cosine * sin(hour),
           high = cosine * cos(hour);
    double north = sine * cos(l) - high * sin(l), up = sine * sin(l) + high * cos(l);
    double elevation = asin(fmin(fmax(up, -1), 1)) / DEGREE;
    if (elevation < LOWEST) {
        return false;
    }
    sun[0] = atan2(north, east) / DEGREE;
    sun[1] = elevation;
    return true;
}

/* Status texts and the version.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <ppscat/ppscat.h>

const char *pps_status_string(pps_status status) {
    switch (status) {
#define PPS_STATUS_TEXT(code, text)                                                    \
    case code:                                                                         \
        return text;
        PPS_STATUS_LIST(PPS_STATUS_TEXT)
#undef PPS_STATUS_TEXT
    }
    return "unknown status";
}

const char *pps_version(void) { return PPS_VERSION_STRING; }

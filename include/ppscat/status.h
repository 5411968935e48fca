/* Status codes: what every call that can fail returns.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPSCAT_STATUS_H
#define PPSCAT_STATUS_H

#include <ppscat/export.h>

#ifdef __cplusplus
extern "C" {
#endif

/* One list yields the enum and its texts. */
#define PPS_STATUS_LIST(X)                                                             \
    X(PPS_OK, "success")                                                               \
    X(PPS_ERR_ARGUMENT, "an argument is outside its range")                            \
    X(PPS_ERR_MEMORY, "out of memory")                                                 \
    X(PPS_ERR_CONVERGENCE, "an eigenproblem did not converge")                         \
    X(PPS_ERR_INDEFINITE,                                                              \
      "the truncated phase function is indefinite on these nodes; "                    \
      "take more streams or scale the forward peak (delta-M)")                         \
    X(PPS_ERR_TOLERANCE,                                                               \
      "the tolerance was not reached with the most streams allowed")                   \
    X(PPS_ERR_UNSUPPORTED, "the method does not cover this case")                      \
    X(PPS_ERR_FILE, "a file cannot be read or written")                                \
    X(PPS_ERR_FORMAT, "the contents of a file are not what they should be")            \
    X(PPS_ERR_CANCELLED, "stopped on request")

typedef enum {
#define PPS_STATUS_ENUM(code, text) code,
    PPS_STATUS_LIST(PPS_STATUS_ENUM)
#undef PPS_STATUS_ENUM
} pps_status;

/* The text of a status, never NULL; static storage. */
PPS_API const char *pps_status_string(pps_status status);

#ifdef __cplusplus
}
#endif
#endif

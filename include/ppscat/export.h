/* Visibility of the public symbols; everything else stays inside the library.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPSCAT_EXPORT_H
#define PPSCAT_EXPORT_H

#if defined(__GNUC__)
#define PPS_API __attribute__((visibility("default")))
#else
#define PPS_API
#endif

#endif

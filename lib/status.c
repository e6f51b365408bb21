/* SPDX-License-Identifier: BSD-2-Clause */
/* status.c - texts of the status codes. */
#include "nlcontact.h"

const char *nlc_strerror(nlc_status status)
{
    /* of several warnings the highest bit is the most severe */
    if (status > 0)
        while (status & (status - 1)) status &= status - 1;
    switch (status) {
#define NLC_STATUS_TEXT(name, value, text, culprit)                                                                         \
    case name:                                                                                                             \
        return text;
        NLC_STATUS_LIST(NLC_STATUS_TEXT)
#undef NLC_STATUS_TEXT
    default:
        return "unknown status";
    }
}

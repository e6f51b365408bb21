/* SPDX-License-Identifier: BSD-2-Clause */
/* version.c - the version of the library, from the header it was built with. */
#include "nlcontact.h"

#define NLC_TEXT_OF(x) #x
#define NLC_TEXT(x) NLC_TEXT_OF(x)

const char *nlc_version(void)
{
    return NLC_TEXT(NLC_VERSION_MAJOR) "." NLC_TEXT(NLC_VERSION_MINOR) "." NLC_TEXT(NLC_VERSION_PATCH);
}

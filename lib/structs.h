/* SPDX-License-Identifier: BSD-2-Clause */
/* structs.h - the rule by which public structs of other versions are read and written. */
#ifndef NLC_STRUCTS_H
#define NLC_STRUCTS_H

#include "nlcontact.h"

/* Largest struct_size that any version will have: a larger one is an uninitialised field. */
#define NLC_STRUCT_MAX 4096

/*
 * Copies a caller's struct into our own version of it.  A shorter one counts as followed by zeros, a field that is cut in two
 * as absent; in a longer one the surplus must be zero.
 * Returns NLC_OK, NLC_ERROR_STRUCT_SIZE or NLC_ERROR_RESERVED.
 */
nlc_status nlc_read_particles(nlc_particles *to, const nlc_particles *from);
nlc_status nlc_read_options(nlc_options *to, const nlc_options *from); /* from NULL: all zero */
nlc_status nlc_read_positions(nlc_positions *to, const nlc_positions *from);
nlc_status nlc_read_lists(nlc_lists *to, const nlc_lists *from);

/* Whether a struct of this size can be written to. */
int nlc_struct_size_is_valid(size_t size);

/*
 * Writes a record of our own size to a caller's struct that begins with such a size: up to the smaller of both, bytes beyond ours
 * are zeroed, the size stays.
 */
void nlc_write_struct(void *to, const void *record, size_t own);

/* Whether info is NULL or has a struct_size that can be written to. */
int nlc_info_is_valid(const nlc_info *info);

/* An info that says that nothing happened. */
nlc_info nlc_new_info(void);

/* Writes the record to the caller's info, if there is one, and returns status. */
nlc_status nlc_report(nlc_info *info, const nlc_info *record, nlc_status status);

/* The same for an error that is all there is to say. */
nlc_status nlc_error(nlc_info *info, nlc_status status, int64_t culprit);

#endif

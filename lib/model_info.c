/* SPDX-License-Identifier: BSD-2-Clause */
/* model_info.c - the table of models, as callers see it. */
#include "model.h"
#include "nlcontact.h"
#include "structs.h"

int32_t nlc_model_count(void)
{
    return nlc_models_count;
}

nlc_status nlc_model_info(int32_t model, nlc_model_record *record, nlc_info *info)
{
    if (!nlc_info_is_valid(info)) return NLC_ERROR_STRUCT_SIZE;
    if (!record) return nlc_error(info, NLC_ERROR_NULL, 1);
    if (!nlc_struct_size_is_valid(record->struct_size)) return nlc_error(info, NLC_ERROR_STRUCT_SIZE, 1);
    if (model < 0 || model >= nlc_models_count) return nlc_error(info, NLC_ERROR_MODEL, model);
    const nlc_model *m = &nlc_models[model];
    const nlc_model_record own = {.name = m->name,
                                  .reference = m->reference,
                                  .doi = m->doi,
                                  .validity = m->validity,
                                  .symmetric = m->symmetric,
                                  .potential = m->potential,
                                  .self_term = m->self != NULL,
                                  .circles = m->shape == NLC_SHAPE_MOMENTS || m->shape == NLC_SHAPE_RADIUS,
                                  .cost = m->cost};
    nlc_write_struct(record, &own, sizeof own);
    return nlc_error(info, NLC_OK, -1);
}

static bool is_same(const char *a, const char *b)
{
    while (*a && *a == *b) a++, b++;
    return *a == *b;
}

int32_t nlc_model_find(const char *name)
{
    for (int32_t k = 0; name && k < nlc_models_count; k++)
        if (is_same(name, nlc_models[k].name)) return k;
    return -1;
}

// The curves of a table that were dug in beds with an effect, beside a table of plain ones.

#ifndef DIG_TABLES_LOAD_EFFECTS_H
#define DIG_TABLES_LOAD_EFFECTS_H

#include "core/effect_set.h"
#include "core/error.h"

/// Opens path read-only, checks it as dig_table_load() does, and builds the set of what was dug
/// with an effect. DIG_EINVAL: there is nothing such in it, or it is of another scene than plain
/// (both named). Allocates; free with dig_effect_set_destroy().
DIG_MUST_CHECK enum dig_status dig_effects_load(const char *path, const struct dig_curve_set *plain,
                                                struct dig_effect_set **set,
                                                struct dig_error       *error);

/// NULL is allowed.
void dig_effect_set_destroy(struct dig_effect_set *set);

#endif // DIG_TABLES_LOAD_EFFECTS_H

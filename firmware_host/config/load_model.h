// Applies a model file: its effects of the soil change the table's curves, those of the machine
// become a correction.

#ifndef DIG_FIRMWARE_HOST_CONFIG_LOAD_MODEL_H
#define DIG_FIRMWARE_HOST_CONFIG_LOAD_MODEL_H

#include "core/curve.h"
#include "core/error.h"
#include "core/machine.h"
#include "estimator/wrench/correction.h"

/// Reads the model file and changes the curves of *set, which was loaded from the table. corrected:
/// the machine with the model's effects of it; machine NULL: nothing is corrected. The table of
/// effects is looked for beside the table first, then where the model names it.
/// DIG_EINVAL, DIG_EIO, DIG_ESCHEMA with the file and what was expected: also a model of another
/// scene, an effect without a table, or a correction the machine cannot have. *set may be half
/// changed then; nothing else is written.
DIG_MUST_CHECK enum dig_status dig_load_model(const char *model_path, const char *table_path,
                                              const struct dig_machine     *machine,
                                              struct dig_curve_set         *set,
                                              struct dig_corrected_machine *corrected,
                                              struct dig_error             *error);

#endif // DIG_FIRMWARE_HOST_CONFIG_LOAD_MODEL_H

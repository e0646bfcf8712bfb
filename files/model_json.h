// A model file (docs/formats/model.md): what the closed loop found, written by `digloop trace
// --add`, loaded by digsightd and digloop.

#ifndef DIG_FILES_MODEL_JSON_H
#define DIG_FILES_MODEL_JSON_H

#include "core/error.h"
#include "core/model.h"

/// Writes one JSON object: PATH.part first, then renamed. A number that is not finite is left out
/// with its key where the key may be missing, and written as 0 elsewhere. DIG_EIO with *error.
DIG_MUST_CHECK enum dig_status dig_model_save(const char *path, const struct dig_model *model,
                                              struct dig_error *error);

/// DIG_EINVAL names file, line, key and what was expected; DIG_EIO: it cannot be opened. Whether an
/// effect has the parameters named is the estimator's to say (dig_effect_values()). Writes on
/// success only.
DIG_MUST_CHECK enum dig_status dig_model_read(const char *path, struct dig_model *model,
                                              struct dig_error *error);

#endif // DIG_FILES_MODEL_JSON_H

// Checks that a table is similar to a campaign's scene and to a machine's bucket.

#ifndef DIG_TOOLS_DIGLOOP_SCENE_H
#define DIG_TOOLS_DIGLOOP_SCENE_H

#include "core/machine.h"
#include "tools/digloop/commands.h"

/// path is a scene file or, where there is no such file, ends in the name of the table's scene.
/// *scale: its bucket over that of the table's scene. DIG_EINVAL for a scene that is not similar
/// (core/similar.h); *error names both and the table.
DIG_MUST_CHECK enum dig_status digloop_check_scene(const struct digloop_job *job, const char *path,
                                                   double *scale, struct dig_error *error);

/// The machine of this file has a bucket as wide to its length as the scene's, within DIG_SIMILAR;
/// else DIG_EINVAL, naming both.
DIG_MUST_CHECK enum dig_status digloop_check_bucket(const struct digloop_job *job, const char *file,
                                                    const struct dig_machine *machine,
                                                    struct dig_error         *error);

#endif // DIG_TOOLS_DIGLOOP_SCENE_H

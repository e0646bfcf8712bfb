// Beds that digtable dig writes with --save-bed and reads with --bed.

#ifndef DIG_TOOLS_DIGTABLE_SAVED_BED_H
#define DIG_TOOLS_DIGTABLE_SAVED_BED_H

#include "core/bed.h"
#include "core/error.h"
#include "core/scene.h"

/// DIG_EINVAL for a scene whose beds a file cannot hold: one with movable rocks.
DIG_MUST_CHECK enum dig_status dig_cli_bed_fits_file(const struct dig_scene *scene,
                                                     struct dig_error       *error);

/// DIG_EINVAL as dig_cli_bed_fits_file() and dig_bed_read() of files/bed_csv.h, and where the scene
/// has layers and the file has no materials. *bed is written on success
/// only.
DIG_MUST_CHECK enum dig_status dig_cli_bed_read(const char *path, const struct dig_scene *scene,
                                                struct dig_bed *bed, struct dig_error *error);

#endif // DIG_TOOLS_DIGTABLE_SAVED_BED_H

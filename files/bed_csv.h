// Beds as CSV (docs/formats/tables.md): x_m,y_m,z_m,radius_m and, where grains are not all alike,
// material and clump; one grain, or one sphere of a clump, a line.

#ifndef DIG_FILES_BED_CSV_H
#define DIG_FILES_BED_CSV_H

#include "core/bed.h"
#include "core/error.h"

/// Reads a whole file; free with dig_bed_finish(). A column that is absent stays NULL. DIG_EINVAL
/// names file, line and column: what dig_csv_read() refuses, a radius that is not > 0, a material
/// that is no whole number from 0 to 255, a clump that is none from 1 to 2^32 - 1. DIG_EIO,
/// DIG_ENOMEM. *bed is written on success only.
DIG_MUST_CHECK enum dig_status dig_bed_read(const char *path, struct dig_bed *bed,
                                            struct dig_error *error);

/// Writes a whole file, into PATH.part, then renamed; numbers so that they are read back bit by
/// bit. Where rocks lie is not in it.
DIG_MUST_CHECK enum dig_status dig_bed_write(const char *path, const struct dig_bed *bed,
                                             struct dig_error *error);

#endif // DIG_FILES_BED_CSV_H

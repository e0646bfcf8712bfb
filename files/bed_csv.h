// Beds as CSV (docs/formats/tables.md): x_m,y_m,z_m,radius_m and, where grains are not all alike,
// material and clump; one grain, or one sphere of a clump, a line.

#ifndef DIG_FILES_BED_CSV_H
#define DIG_FILES_BED_CSV_H

#include "core/error.h"

#include <stddef.h>
#include <stdint.h>

/// The columns of a bed, as offline_dem/kernel/bed.h has them.
struct dig_bed_columns {
    size_t    grains;
    double   *x_m, *y_m, *z_m, *radius_m; // [grains]
    uint8_t  *material;                   // [grains]; NULL: the column is absent
    uint32_t *clump;                      // [grains]; NULL: the column is absent
};

/// Frees the arrays and zeroes it. NULL and a zeroed struct are allowed.
void dig_bed_columns_finish(struct dig_bed_columns *bed);

/// Reads a whole file; every array is malloc'ed. DIG_EINVAL names file, line and column: what
/// dig_csv_read() refuses, a radius that is not > 0, a material that is no whole number from 0 to
/// 255, a clump that is none from 1 to 2^32 - 1. DIG_EIO, DIG_ENOMEM. *bed is written on success
/// only.
DIG_MUST_CHECK enum dig_status dig_bed_read(const char *path, struct dig_bed_columns *bed,
                                            struct dig_error *error);

/// Writes a whole file, into PATH.part, then renamed; numbers so that they are read back bit by
/// bit.
DIG_MUST_CHECK enum dig_status dig_bed_write(const char *path, const struct dig_bed_columns *bed,
                                             struct dig_error *error);

#endif // DIG_FILES_BED_CSV_H

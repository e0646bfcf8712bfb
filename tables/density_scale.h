// One density stands for all, where density is a scale of the scene. Internal to tables/.

#ifndef DIG_TABLES_DENSITY_SCALE_H
#define DIG_TABLES_DENSITY_SCALE_H

#include "tables/grounds.h"

/// Where curves go with the density (head) and all grounds are of one: the grounds at 0.6, 1
/// and 1.6 times it, in the same order, forces, moments and masses in proportion. Else nothing
/// changes. The copies of a ground hold the same packings: they are one sample, not three. Returns
/// how many there are. Nothing where the database has failed.
size_t dig_grounds_spread_density(struct dig_db *db, const struct dig_table_head *head,
                                  struct dig_entry_set **grounds);

#endif // DIG_TABLES_DENSITY_SCALE_H

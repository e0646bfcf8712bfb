// A table as text, for people and for other programs. Formats: docs/formats.md. What differs from
// computation to computation of the same table (wall time, date) is left out, so that two tables
// made by the same command give the same bytes.

#ifndef DIG_TABLES_EXPORT_H
#define DIG_TABLES_EXPORT_H

#include "core/curve.h"
#include "core/entry_set.h"
#include "core/error.h"
#include "tables/store.h"

#include <stdio.h>

/// CSV: one line a point of every curve, those of other approaches behind the plain ones.
void dig_export_curves(const struct dig_curve_set *set, FILE *file);

/// CSV: one line a sample of every run.
DIG_MUST_CHECK enum dig_status dig_export_runs(struct dig_store *store, FILE *file,
                                               struct dig_error *error);

/// The entries, numbered, and their packings, as a text table or as JSON. Either may have no
/// entries.
void dig_export_list(const struct dig_curve_set *set, const struct dig_entry_set *effects,
                     FILE *file);
void dig_export_list_json(const struct dig_curve_set *set, const struct dig_entry_set *effects,
                          FILE *file);

/// As dig_export_curves(), of what was dug with an effect; set names the trajectories.
void dig_export_effects(const struct dig_curve_set *set, const struct dig_entry_set *effects,
                        FILE *file);

/// One curve of an entry, by its number in the list (tables/listed.h): CSV, JSON, or drawn with
/// characters `width` columns wide.
void dig_export_curve_csv(const struct dig_curve_set *set, size_t entry, size_t trajectory,
                          FILE *file);
void dig_export_curve_json(const struct dig_curve_set *set, size_t entry, size_t trajectory,
                           FILE *file);
void dig_export_curve_plot(const struct dig_curve_set *set, size_t entry, size_t trajectory,
                           enum dig_channel channel, size_t width, FILE *file);

#endif // DIG_TABLES_EXPORT_H

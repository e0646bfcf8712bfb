#include "tables/export.h"

#include "core/markup.h"
#include "core/units.h"
#include "tables/listed.h"

#include <assert.h>
#include <math.h>
#include <string.h>

static double progress_of(const size_t k)
{
    return (double)k / (DIG_CURVE_POINTS - 1);
}

static double time_of(const struct dig_trajectory *const trajectory, const double tooth_m,
                      const size_t k)
{
    return dig_trajectory_time_s(trajectory, tooth_m, progress_of(k));
}

static void put_gravel(const struct dig_gravel *const gravel, FILE *const file)
{
    (void)fprintf(file, "%.9g,%.9g,%.9g", gravel->value[DIG_AXIS_FRICTION],
                  gravel->value[DIG_AXIS_ROLLING], gravel->value[DIG_AXIS_DENSITY_kgpm3]);
}

// A field behind others; empty when the number is not known.
static void put_number(const double value, FILE *const file)
{
    if (isnan(value)) {
        (void)fputc(',', file);
    } else {
        (void)fprintf(file, ",%.9g", value);
    }
}

static void put_point(const struct dig_trajectory *const trajectory, const double tooth_m,
                      const struct dig_curve *const curve, const size_t k, FILE *const file)
{
    (void)fprintf(file, "%.9g,%.9g", progress_of(k), time_of(trajectory, tooth_m, k));
    for (size_t c = 0; c < DIG_CHANNELS; c++) {
        put_number((double)curve->mean[c][k], file);
        put_number((double)curve->sd[c][k], file);
    }
}

static double degrees(const double rad)
{
    return rad / DIG_RAD_PER_DEG;
}

#define POINT_COLUMNS                                                                              \
    "progress,t_s,My_Nm,My_sd_Nm,Fx_N,Fx_sd_N,Fz_N,Fz_sd_N,carried_kg,carried_sd_kg"

void dig_export_curves(const struct dig_curve_set *const set, FILE *const file)
{
    (void)fprintf(file, "friction,rolling,density_kgpm3,trajectory,packings," POINT_COLUMNS
                        ",depth,attack_deg\n");
    for (size_t e = 0; e < dig_listed_count(set); e++) {
        for (size_t t = 0; t < set->trajectories; t++) {
            const struct dig_listed one = dig_listed_at(set, e, t);
            for (size_t k = 0; one.packings > 0 && k < DIG_CURVE_POINTS; k++) {
                put_gravel(&one.gravel, file);
                (void)fprintf(file, ",%s,%d,", one.trajectory.name, one.packings);
                put_point(&one.trajectory, set->tooth_m, one.curve, k, file);
                (void)fprintf(file, ",%.9g,%.9g\n", one.approach.depth,
                              degrees(one.approach.attack_rad));
            }
        }
    }
}

void dig_export_effects(const struct dig_curve_set *const set,
                        const struct dig_entry_set *const effects, FILE *const file)
{
    (void)fprintf(
        file,
        "effect,magnitude,friction,rolling,density_kgpm3,trajectory,packings," POINT_COLUMNS "\n");
    for (size_t e = 0; e < effects->entries; e++) {
        const struct dig_entry *const entry = &effects->entry[e];
        for (size_t t = 0; t < effects->trajectories; t++) {
            const size_t at = e * effects->trajectories + t;
            for (size_t k = 0; effects->packings[at] > 0 && k < DIG_CURVE_POINTS; k++) {
                (void)fprintf(file, "%s,%.9g,", dig_effect_name(entry->effect), entry->magnitude);
                put_gravel(&entry->gravel, file);
                (void)fprintf(file, ",%s,%d,", set->trajectory[t].name, effects->packings[at]);
                put_point(&set->trajectory[t], set->tooth_m, &effects->curve[at], k, file);
                (void)fputc('\n', file);
            }
        }
    }
}

struct export_context {
    const struct dig_trajectory *trajectory;
    FILE                        *file;
};

static enum dig_status put_run(void *const context, const struct dig_run *const run,
                               struct dig_error *const error)
{
    const struct export_context *const x = context;
    const struct dig_run_origin *const o = &run->origin;
    (void)error;
    for (size_t i = 0; i < run->windows; i++) {
        put_gravel(&o->gravel, x->file);
        (void)fprintf(x->file, ",%s,%zu,%llu,%s,%s,%zu,%.9g", x->trajectory[o->trajectory].name,
                      o->packing, (unsigned long long)o->seed, o->engine, o->version, o->grains,
                      run->first_s + (double)i * run->step_s);
        for (size_t c = 0; c < DIG_CHANNELS; c++) {
            put_number((double)run->value[c * run->windows + i], x->file);
        }
        (void)fprintf(x->file, ",%s,%.9g,%.9g,%.9g\n", o->effect, o->magnitude, o->approach.depth,
                      degrees(o->approach.attack_rad));
    }
    return DIG_OK;
}

enum dig_status dig_export_runs(struct dig_store *const store, FILE *const file,
                                struct dig_error *const error)
{
    size_t                       count   = 0;
    struct export_context        context = { dig_store_trajectories(store, &count), file };
    const struct dig_run_visitor visitor = { put_run, &context };
    (void)fprintf(file,
                  "friction,rolling,density_kgpm3,trajectory,packing,seed,engine,version,"
                  "grains,t_s,My_Nm,Fx_N,Fz_N,carried_kg,effect,magnitude,depth,attack_deg\n");
    return dig_store_walk(store, &visitor, error);
}

static void put_packings(const size_t trajectories, const int packings[], FILE *const file)
{
    for (size_t t = 0; t < trajectories; t++) {
        (void)fprintf(file, "  %10d", packings[t]);
    }
}

// Of each trajectory.
static const int *packings_of(const struct dig_curve_set *const set, const size_t entry)
{
    return entry < set->entries
               ? set->packings + entry * set->trajectories
               : set->approaches->packings + (entry - set->entries) * set->trajectories;
}

void dig_export_list(const struct dig_curve_set *const set,
                     const struct dig_entry_set *const effects, FILE *const file)
{
    (void)fprintf(file, "scene %s %.12s  bucket %g m wide, tooth at %g m  E %g Pa\n",
                  set->scene_name, set->scene_hash, set->bucket_width_m, set->tooth_m,
                  set->young_Pa);
    (void)fprintf(file, "%5s  %8s  %8s  %8s ", "entry", "friction", "rolling", "kg/m3");
    for (size_t t = 0; t < set->trajectories; t++) {
        (void)fprintf(file, "  %10s", set->trajectory[t].name);
    }
    (void)fputs("   (packings)\n", file);
    for (size_t e = 0; e < dig_listed_count(set); e++) {
        const struct dig_listed one = dig_listed_at(set, e, 0);
        const double *const     v   = one.gravel.value;
        (void)fprintf(file, "%5zu  %8g  %8g  %8g ", e, v[DIG_AXIS_FRICTION], v[DIG_AXIS_ROLLING],
                      v[DIG_AXIS_DENSITY_kgpm3]);
        put_packings(set->trajectories, packings_of(set, e), file);
        char how[DIG_APPROACH_TEXT_SIZE];
        dig_approach_text(&one.approach, how);
        (void)fprintf(file, "%s%s\n", how[0] != '\0' ? "  " : "", how[0] != '\0' ? how + 2 : "");
    }
    for (size_t e = 0; e < effects->entries; e++) {
        const struct dig_entry *const x = &effects->entry[e];
        const double *const           v = x->gravel.value;
        (void)fprintf(file, "%5s  %8g  %8g  %8g ", "", v[DIG_AXIS_FRICTION], v[DIG_AXIS_ROLLING],
                      v[DIG_AXIS_DENSITY_kgpm3]);
        put_packings(set->trajectories, effects->packings + e * set->trajectories, file);
        (void)fprintf(file, "  %s %g\n", dig_effect_name(x->effect), x->magnitude);
    }
}

static void put_json_scene(const struct dig_curve_set *const set, FILE *const file)
{
    dig_json_put(file,
                 "{\"scene\": {\"name\": %s, \"hash\": %s, \"tooth_m\": %.9g, "
                 "\"bucket_width_m\": %.9g, \"young_Pa\": %.9g, \"smooth_half_s\": %.9g}",
                 set->scene_name, set->scene_hash, set->tooth_m, set->bucket_width_m, set->young_Pa,
                 set->smooth_half_s);
}

static void put_json_entry(const size_t entry, const struct dig_listed *const one, FILE *const file)
{
    dig_json_put(file, "\"entry\": %zu, ", entry);
    dig_json_gravel(file, &one->gravel);
    dig_json_put(file, ", \"depth\": %.9g, \"attack_deg\": %.9g", one->approach.depth,
                 degrees(one->approach.attack_rad));
}

static void put_json_packings(const struct dig_curve_set *const set, const int packings[],
                              FILE *const file)
{
    (void)fputs(", \"packings\": {", file);
    for (size_t t = 0; t < set->trajectories; t++) {
        dig_json_put(file, t == 0 ? "%s: %d" : ", %s: %d", set->trajectory[t].name, packings[t]);
    }
    (void)fputs("}}", file);
}

void dig_export_list_json(const struct dig_curve_set *const set,
                          const struct dig_entry_set *const effects, FILE *const file)
{
    put_json_scene(set, file);
    (void)fputs(",\n \"trajectories\": [", file);
    for (size_t t = 0; t < set->trajectories; t++) {
        dig_json_put(file, t == 0 ? "%s" : ", %s", set->trajectory[t].name);
    }
    (void)fputs("],\n \"entries\": [", file);
    for (size_t e = 0; e < dig_listed_count(set); e++) {
        const struct dig_listed one = dig_listed_at(set, e, 0);
        (void)fputs(e == 0 ? "\n  {" : ",\n  {", file);
        put_json_entry(e, &one, file);
        put_json_packings(set, packings_of(set, e), file);
    }
    (void)fputs("\n ],\n \"effects\": [", file);
    for (size_t e = 0; e < effects->entries; e++) {
        const struct dig_entry *const x = &effects->entry[e];
        (void)fputs(e == 0 ? "\n  {" : ",\n  {", file);
        dig_json_put(file, "\"effect\": %s, \"magnitude\": %.9g, ", dig_effect_name(x->effect),
                     x->magnitude);
        dig_json_gravel(file, &x->gravel);
        put_json_packings(set, effects->packings + e * set->trajectories, file);
    }
    (void)fputs(effects->entries > 0 ? "\n ]}\n" : "]}\n", file);
}

void dig_export_curve_csv(const struct dig_curve_set *const set, const size_t entry,
                          const size_t trajectory, FILE *const file)
{
    const struct dig_listed one = dig_listed_at(set, entry, trajectory);
    (void)fputs(POINT_COLUMNS "\n", file);
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        put_point(&one.trajectory, set->tooth_m, one.curve, k, file);
        (void)fputc('\n', file);
    }
}

static void put_json_numbers(const char *const name, const double value[const DIG_CURVE_POINTS],
                             FILE *const file)
{
    dig_json_put(file, ",\n %s: [", name);
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        dig_json_put(file, k == 0 ? "%.9g" : ", %.9g", value[k]);
    }
    (void)fputc(']', file);
}

void dig_export_curve_json(const struct dig_curve_set *const set, const size_t entry,
                           const size_t trajectory, FILE *const file)
{
    static const char *const sd_name[DIG_CHANNELS] = { "My_sd_Nm", "Fx_sd_N", "Fz_sd_N",
                                                       "carried_sd_kg" };
    const struct dig_listed  one                   = dig_listed_at(set, entry, trajectory);
    double                   value[2][DIG_CURVE_POINTS];
    put_json_scene(set, file);
    (void)fputs(",\n ", file);
    put_json_entry(entry, &one, file);
    dig_json_put(file, ", \"trajectory\": %s, \"packings\": %d", one.trajectory.name, one.packings);
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        value[0][k] = progress_of(k);
        value[1][k] = time_of(&one.trajectory, set->tooth_m, k);
    }
    put_json_numbers("progress", value[0], file);
    put_json_numbers("t_s", value[1], file);
    for (size_t c = 0; c < DIG_CHANNELS; c++) {
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            value[0][k] = (double)one.curve->mean[c][k];
            value[1][k] = (double)one.curve->sd[c][k];
        }
        put_json_numbers(dig_channel_name((enum dig_channel)c), value[0], file);
        put_json_numbers(sd_name[c], value[1], file);
    }
    (void)fputs("}\n", file);
}

#define PLOT_ROWS 17

// Marks the band of one standard deviation with ':' and the mean with '*'.
void dig_export_curve_plot(const struct dig_curve_set *const set, const size_t entry,
                           const size_t trajectory, const enum dig_channel channel,
                           const size_t width, FILE *const file)
{
    const struct dig_listed       one   = dig_listed_at(set, entry, trajectory);
    const struct dig_curve *const curve = one.curve;
    const double *const           v     = one.gravel.value;
    double                        low   = 0.0;
    double                        high  = 0.0;
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        const double mean = (double)curve->mean[channel][k];
        const double sd   = (double)curve->sd[channel][k];
        low               = fmin(low, mean - sd);
        high              = fmax(high, mean + sd);
    }
    const double step = high > low ? (high - low) / (PLOT_ROWS - 1) : 1.0;

    char how[DIG_APPROACH_TEXT_SIZE];
    dig_approach_text(&one.approach, how);
    (void)fprintf(file, "entry %zu: friction %g, rolling %g, %g kg/m3; %s%s, %d packings\n%s\n",
                  entry, v[DIG_AXIS_FRICTION], v[DIG_AXIS_ROLLING], v[DIG_AXIS_DENSITY_kgpm3],
                  one.trajectory.name, how, one.packings, dig_channel_name(channel));
    for (int row = PLOT_ROWS - 1; row >= 0; row--) {
        const double level = low + step * row;
        (void)fprintf(file, "%9.3g |", level);
        for (size_t x = 0; x < width; x++) {
            const size_t k    = x * (DIG_CURVE_POINTS - 1) / (width > 1 ? width - 1 : 1);
            const double mean = (double)curve->mean[channel][k];
            const double sd   = (double)curve->sd[channel][k];
            const bool   on   = fabs(mean - level) <= 0.5 * step;
            (void)fputc(on ? '*' : fabs(mean - level) <= sd ? ':' : ' ', file);
        }
        (void)fputc('\n', file);
    }
    (void)fprintf(file, "%9s +", "");
    for (size_t x = 0; x < width; x++) {
        (void)fputc('-', file);
    }
    (void)fprintf(file,
                  "\n%9s  0%*s\n%9s  progress along the path; * mean, : one standard deviation\n",
                  "", (int)(width > 2 ? width - 1 : 1), "1", "");
}

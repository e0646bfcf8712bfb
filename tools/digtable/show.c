// digtable list, check, show and export.

#include "core/table_step.h"
#include "core/text.h"
#include "files/text/whole.h"
#include "tables/export.h"
#include "tables/listed.h"
#include "tables/load.h"
#include "tables/scene.h"
#include "tables/store.h"
#include "tools/digtable/commands.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

int dig_cli_list(const struct dig_arguments *const a)
{
    struct dig_error      error   = { "" };
    struct dig_curve_set *set     = NULL;
    struct dig_entry_set *effects = NULL;
    const enum dig_status status  = dig_table_list(a->positional[0], &set, &effects, &error);
    if (status != DIG_OK) {
        return dig_cli_bad_input(status, &error);
    }
    if (a->json) {
        dig_export_list_json(set, effects, stdout);
    } else {
        dig_export_list(set, effects, stdout);
    }
    dig_entry_set_destroy(effects);
    dig_curve_set_destroy(set);
    return EXIT_DONE;
}

static double grains_across(const struct dig_scene *const scene)
{
    return scene->bucket.width_m / scene->material.diameter_m;
}

// What holds for every dig of the table.
static void print_scene(const struct dig_scene *const scene)
{
    const struct dig_material_pair *const bucket = dig_scene_bucket_pair(scene);
    (void)printf("  scene %s: %.3g grains across the bucket, which is ", scene->name,
                 grains_across(scene));
    if (bucket != NULL) {
        (void)printf("of friction %.3g and rolling friction %.3g", bucket->friction,
                     bucket->rolling);
    } else {
        (void)printf("as rough as the gravel");
    }
    (void)puts(scene->material.young_at_kgpm3 > 0.0 ? "; resistance goes with the density" : "");
}

static void print_scene_json(const struct dig_scene *const scene)
{
    const struct dig_material_pair *const bucket = dig_scene_bucket_pair(scene);
    (void)printf("\"grains_across\": %.6g, \"density_scales\": %s, \"bucket\": ",
                 grains_across(scene), scene->material.young_at_kgpm3 > 0.0 ? "true" : "false");
    if (bucket != NULL) {
        (void)printf("{\"friction\": %.9g, \"rolling\": %.9g}", bucket->friction, bucket->rolling);
    } else {
        (void)printf("null");
    }
}

int dig_cli_check(const struct dig_arguments *const a)
{
    struct dig_error        error  = { "" };
    struct dig_store       *store  = NULL;
    struct dig_store_report report = { .entries = 0 };
    enum dig_status         status = dig_store_open(a->positional[0], &store, &error);
    if (status == DIG_OK) {
        status = dig_store_check(store, &report, &error);
    }
    dig_store_close(store);
    struct dig_scene scene;
    if (status == DIG_OK) {
        status = dig_table_scene(a->positional[0], &scene, &error);
    }
    if (status != DIG_OK) {
        return dig_cli_bad_input(status, &error);
    }
    char trembles[DIG_TABLE_STEP_TEXT_SIZE];
    dig_table_step_text(&report.step, trembles);
    if (a->json) {
        (void)printf("{\"points\": %zu, \"entries\": %zu, \"runs\": %zu, \"holes\": %zu, "
                     "\"incomplete\": %zu, \"effects\": %zu, \"builds\": %zu, \"approaches\": %zu, "
                     "\"trembles\": %s, ",
                     report.points, report.entries, report.runs, report.holes, report.incomplete,
                     report.effects, report.builds, report.approaches,
                     trembles[0] != '\0' ? "true" : "false");
        print_scene_json(&scene);
        (void)puts("}");
    } else {
        dig_text_print(stdout,
                       "%s: sound; %zu points, %zu entries, %zu runs; %zu holes in the grid, %zu "
                       "entries with fewer packings",
                       a->positional[0], report.points, report.entries, report.runs, report.holes,
                       report.incomplete);
        if (report.effects > 0) {
            (void)printf("; %zu points with an effect", report.effects);
        }
        if (report.approaches > 0) {
            (void)printf("; %zu points at another depth or attack", report.approaches);
        }
        (void)puts(report.builds > 1 ? "; made by builds that may compute differently" : "");
        print_scene(&scene);
        (void)puts("  finer gravel resists less: what is found of it is an equivalent "
                   "(docs/tables.md, \"Fine gravel\")");
        if (trembles[0] != '\0') {
            (void)printf("  %s\n", trembles);
        }
    }
    return a->complete && report.holes + report.incomplete > 0 ? EXIT_WORK_FAILED : EXIT_DONE;
}

// The entry asked for, by number or by gravel and approach; their number when there is none.
static size_t find_entry(const struct dig_arguments *const a, const struct dig_curve_set *const set)
{
    const size_t entries = dig_listed_count(set);
    if (a->positionals == 2) {
        uint64_t number = 0;
        return dig_count_read(a->positional[1], 0, entries - 1, &number) ? number : entries;
    }
    size_t e = 0;
    for (; e < entries; e++) {
        const struct dig_listed one  = dig_listed_at(set, e, 0);
        bool                    same = fabs(one.approach.depth - a->approach.depth) <= 1e-9 &&
                    fabs(one.approach.attack_rad - a->approach.attack_rad) <= 1e-9;
        for (int i = 0; i < DIG_AXES; i++) {
            same = same && fabs(one.gravel.value[i] - a->gravel[i]) <= 1e-9 * a->gravel[i];
        }
        if (same) {
            break;
        }
    }
    return e;
}

static int no_entry(const struct dig_arguments *const a, const struct dig_curve_set *const set)
{
    if (a->positionals == 2) {
        return dig_cli_bad_usage(a, "%s: no such entry in %s, expected 0 to %zu", a->positional[1],
                                 a->positional[0], dig_listed_count(set) - 1);
    }
    char known[512] = "";
    for (int i = 0; i < DIG_AXES; i++) {
        dig_text_add(sizeof known, known, "%s%s", i > 0 ? "; " : "",
                     dig_axis_name((enum dig_axis)i));
        for (size_t k = 0; k < set->axis_count[i]; k++) {
            dig_text_add(sizeof known, known, " %g", set->axis[i][k]);
        }
    }
    return dig_cli_bad_usage(a, "%s: no such entry, expected one that `digtable list` shows, of %s",
                             a->positional[0], known);
}

static int show(const struct dig_arguments *const a, const struct dig_curve_set *const set)
{
    const size_t entry = find_entry(a, set);
    if (entry >= dig_listed_count(set)) {
        return no_entry(a, set);
    }
    size_t trajectory = 0;
    while (trajectory < set->trajectories &&
           (a->trajectory != NULL ? strcmp(a->trajectory, set->trajectory[trajectory].name) != 0
                                  : dig_listed_at(set, entry, trajectory).packings == 0)) {
        trajectory++;
    }
    if (trajectory >= set->trajectories || dig_listed_at(set, entry, trajectory).packings == 0) {
        char known[256] = "";
        for (size_t t = 0; t < set->trajectories; t++) {
            if (dig_listed_at(set, entry, t).packings > 0) {
                dig_text_add(sizeof known, known, " %s", set->trajectory[t].name);
            }
        }
        return dig_cli_bad_usage(a, "%s: no such trajectory in this entry, expected one of:%s",
                                 a->trajectory != NULL ? a->trajectory : a->positional[0], known);
    }
    if (a->csv) {
        dig_export_curve_csv(set, entry, trajectory, stdout);
    } else if (a->json) {
        dig_export_curve_json(set, entry, trajectory, stdout);
    } else {
        dig_export_curve_plot(set, entry, trajectory, a->channel, 72, stdout);
    }
    return EXIT_DONE;
}

int dig_cli_show(const struct dig_arguments *const a)
{
    for (int i = 0; i < DIG_AXES; i++) {
        if (a->positionals < 2 && isnan(a->gravel[i])) {
            return dig_cli_bad_usage(a, "show: %s",
                                     "name an ENTRY, or --friction, --rolling and --density");
        }
    }
    struct dig_error      error  = { "" };
    struct dig_curve_set *set    = NULL;
    const enum dig_status status = dig_table_list(a->positional[0], &set, NULL, &error);
    if (status != DIG_OK) {
        return dig_cli_bad_input(status, &error);
    }
    int code = EXIT_BAD_INPUT;
    if (dig_listed_count(set) > 0) {
        code = show(a, set);
    } else {
        dig_text_print(stderr, "digtable: %s: ground: no rows without an effect, expected some\n",
                       a->positional[0]);
    }
    dig_curve_set_destroy(set);
    return code;
}

// Goes to stdout, or whole or not at all to -o.
int dig_cli_export(const struct dig_arguments *const a)
{
    struct dig_error      error   = { "" };
    struct dig_store     *store   = NULL;
    struct dig_curve_set *set     = NULL;
    struct dig_entry_set *effects = NULL;
    struct dig_out        out;
    enum dig_status       status = a->runs ? dig_store_open(a->positional[0], &store, &error)
                                           : dig_table_list(a->positional[0], &set, &effects, &error);
    if (status != DIG_OK) {
        return dig_cli_bad_input(status, &error);
    }
    status = dig_out_open(&out, a->output != NULL ? a->output : "-", &error);
    if (status == DIG_OK) {
        if (a->runs) {
            status = dig_export_runs(store, out.file, &error);
        } else if (a->effects) {
            dig_export_effects(set, effects, out.file);
        } else {
            dig_export_curves(set, out.file);
        }
        status = dig_out_end(&out, status, &error);
    }
    dig_store_close(store);
    dig_entry_set_destroy(effects);
    dig_curve_set_destroy(set);
    return status == DIG_OK ? EXIT_DONE : dig_cli_work_failed(status, &error);
}

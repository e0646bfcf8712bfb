// Every reader of a file against damaged files: mutates good examples at random and reads them,
// under AddressSanitizer and UBSan. A reader must end with a status; a refusal must say why.
//
//   fuzz_files SECONDS [SEED [READER]]      of all readers in turn, or of one: fuzz_files 600 1
//   table
//
// Prints, per reader, how many files it took and refused. A crash leaves the file, whatever
// it is, as campaign.yaml in a folder of its seed.

#include "files/bed_csv.h"
#include "files/campaign_yaml.h"
#include "files/curve_map_yaml.h"
#include "files/curves_csv.h"
#include "files/grid_yaml.h"
#include "files/identity_json.h"
#include "files/job_plan.h"
#include "files/lcm/lcm_log.h"
#include "files/machine_yaml.h"
#include "files/model_json.h"
#include "files/recording_csv.h"
#include "files/scene_yaml.h"
#include "firmware_host/bus/dbc.h"
#include "firmware_host/bus/signal_map.h"
#include "firmware_host/config/config.h"
#include "tables/load.h"
#include "tests/fuzz/random.h"

#include <dirent.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#define SIZE_MAX_B (1 << 20)

static enum dig_status read_scene(const char *const path, struct dig_error *const e)
{
    struct dig_scene scene;
    return dig_scene_read(path, &scene, e);
}

static enum dig_status read_grid(const char *const path, struct dig_error *const e)
{
    struct dig_grid grid;
    return dig_grid_read(path, &grid, e);
}

static enum dig_status read_job_plan(const char *const path, struct dig_error *const e)
{
    struct dig_job_plan plan;
    return dig_job_plan_read(path, &plan, e);
}

static enum dig_status read_machine(const char *const path, struct dig_error *const e)
{
    struct dig_machine machine;
    return dig_machine_read(path, &machine, e);
}

static enum dig_status read_force(const char *const path, struct dig_error *const e)
{
    struct dig_recording  r      = { 0 };
    const enum dig_status status = dig_recording_read(path, &r, e);
    dig_recording_finish(&r);
    return status;
}

static enum dig_status read_machine_recording(const char *const path, struct dig_error *const e)
{
    struct dig_machine_recording r      = { 0 };
    const enum dig_status        status = dig_machine_recording_read(path, &r, e);
    dig_machine_recording_finish(&r);
    return status;
}

static enum dig_status read_bed(const char *const path, struct dig_error *const e)
{
    struct dig_bed        bed    = { 0 };
    const enum dig_status status = dig_bed_read(path, &bed, e);
    dig_bed_finish(&bed);
    return status;
}

static enum dig_status read_identity(const char *const path, struct dig_error *const e)
{
    struct dig_identity id;
    return dig_identity_read(path, &id, e);
}

static enum dig_status read_dbc(const char *const path, struct dig_error *const e)
{
    struct dig_dbc        dbc    = { 0 };
    const enum dig_status status = dig_dbc_read(path, &dbc, e);
    dig_dbc_finish(&dbc);
    return status;
}

static enum dig_status read_map(const char *const path, struct dig_error *const e)
{
    struct dig_signal_map map;
    return dig_signal_map_read(path, NULL, &map, e);
}

static enum dig_status read_config(const char *const path, struct dig_error *const e)
{
    struct dig_config config;
    return dig_config_read(path, &config, e);
}

#define IGNORE(type)                                                                               \
    static void ignore_##type(void *context, int64_t time_us, const digsight_##type##_t *message)  \
    {                                                                                              \
        (void)context, (void)time_us, (void)message;                                               \
    }
IGNORE(estimate)
IGNORE(match)
IGNORE(prediction)
IGNORE(health)

static enum dig_status read_log(const char *const path, struct dig_error *const e)
{
    const struct dig_lcm_reader  all    = { .estimate   = ignore_estimate,
                                            .match      = ignore_match,
                                            .prediction = ignore_prediction,
                                            .health     = ignore_health };
    struct dig_machine_recording r      = { 0 };
    const enum dig_status        status = dig_lcm_log_read(path, &r, e);
    dig_machine_recording_finish(&r);
    return status == DIG_OK ? dig_lcm_log_each(path, &all, e) : status;
}

static enum dig_status read_table(const char *const path, struct dig_error *const e)
{
    struct dig_curve_set *set    = NULL;
    const enum dig_status status = dig_table_load(path, &set, e);
    dig_curve_set_destroy(set);
    return status;
}

// A campaign is a folder: the file must have the name it has there.
static enum dig_status read_campaign(const char *const path, struct dig_error *const e)
{
    struct dig_campaign campaign;
    char                folder[256];
    (void)snprintf(folder, sizeof folder, "%s", path);
    *strrchr(folder, '/') = '\0';
    return dig_campaign_read(folder, &campaign, e);
}

static enum dig_status read_model(const char *const path, struct dig_error *const e)
{
    struct dig_model      model  = { 0 };
    const enum dig_status status = dig_model_read(path, &model, e);
    dig_model_finish(&model);
    return status;
}

static enum dig_status read_curve_map(const char *const path, struct dig_error *const e)
{
    struct dig_curve_map map;
    return dig_curve_map_read(path, &map, e);
}

static enum dig_status visit(void *const context, const struct dig_foreign_dig *const dig,
                             struct dig_error *const error)
{
    (void)context, (void)dig, (void)error;
    return DIG_OK;
}

static enum dig_status read_curves(const char *const path, struct dig_error *const e)
{
    const struct dig_foreign_visitor visitor = { .visit = visit };
    struct dig_curve_map             map;
    const enum dig_status status = dig_curve_map_read("tests/data/formats/curve_map.yaml", &map, e);
    return status == DIG_OK ? dig_curves_read(path, &map, &visitor, e) : status;
}

static struct {
    const char *name, *example;
    enum dig_status (*read)(const char *path, struct dig_error *error);
    char  *good;
    size_t size;
    long   taken, refused;
} target[] = {
    { "scene", "config/scenes/rig.yaml", read_scene, NULL, 0, 0, 0 },
    { "grid", "config/grids/reference_rig.yaml", read_grid, NULL, 0, 0, 0 },
    { "job plan", "tests/data/formats/plan.yaml", read_job_plan, NULL, 0, 0, 0 },
    { "machine", "config/machines/zx200.yaml", read_machine, NULL, 0, 0, 0 },
    { "rig machine", "config/machines/rig_sensor.yaml", read_machine, NULL, 0, 0, 0 },
    { "force recording", "tests/data/formats/force_recording.csv", read_force, NULL, 0, 0, 0 },
    { "machine recording", "tests/data/formats/machine_recording.csv", read_machine_recording, NULL,
      0, 0, 0 },
    { "rig recording", "tests/data/formats/machine_recording_sensor.csv", read_machine_recording,
      NULL, 0, 0, 0 },
    { "bed", "tests/data/formats/bed.csv", read_bed, NULL, 0, 0, 0 },
    { "identity", "tests/data/formats/identity.json", read_identity, NULL, 0, 0, 0 },
    { "dbc", "config/can/zx200.dbc", read_dbc, NULL, 0, 0, 0 },
    { "signal map", "config/signals/modbus_default.yaml", read_map, NULL, 0, 0, 0 },
    { "daemon config", "tests/data/formats/digsightd.yaml", read_config, NULL, 0, 0, 0 },
    { "LCM log", "tests/data/formats/daemon.lcm", read_log, NULL, 0, 0, 0 },
    { "table", "tests/data/formats/table.sqlite", read_table, NULL, 0, 0, 0 },
    { "campaign", "tests/data/formats/campaign/campaign.yaml", read_campaign, NULL, 0, 0, 0 },
    { "model", "tests/data/formats/model.json", read_model, NULL, 0, 0, 0 },
    { "curve map", "tests/data/formats/curve_map.yaml", read_curve_map, NULL, 0, 0, 0 },
    { "curves", "tests/data/formats/curves.csv", read_curves, NULL, 0, 0, 0 },
};
enum { TARGETS = sizeof target / sizeof target[0] };

static const char *const tokens[] = { "nan",  "-inf", "1e999", "-1", "0", "[",  "]",  "{",    "}",
                                      ":",    ",",    "\n",    "\"", "#", "~",  "|",  "9e99", "%s",
                                      "\xff", "&a",   "*a",    "-",  ";", "\t", "''", "- - -" };

// One to eight edits: a byte, a token, a cut, a repeat, an end.
static size_t mutate(char *const text, size_t size)
{
    for (size_t edits = 1 + below(8); edits > 0; edits--) {
        const size_t at = below(size + 1);
        switch (below(5)) {
        case 0:
            if (at < size) {
                text[at] = (char)next();
            }
            break;
        case 1: {
            const char *const token  = tokens[below(sizeof tokens / sizeof tokens[0])];
            const size_t      length = strlen(token);
            if (size + length < SIZE_MAX_B) {
                memmove(text + at + length, text + at, size - at);
                memcpy(text + at, token, length);
                size += length;
            }
            break;
        }
        case 2: {
            const size_t length = below(size - at < 40 ? size - at + 1 : 40);
            memmove(text + at, text + at + length, size - at - length);
            size -= length;
            break;
        }
        case 3: {
            const size_t length = below(size - at < 200 ? size - at + 1 : 200);
            if (size + length < SIZE_MAX_B) {
                memmove(text + at + length, text + at, size - at);
                size += length;
            }
            break;
        }
        default:
            if (below(8) == 0) {
                size = at;
            }
            break;
        }
    }
    return size;
}

static int load_examples(void)
{
    for (int i = 0; i < TARGETS; i++) {
        FILE *const file = fopen(target[i].example, "rb");
        if (file == NULL) {
            (void)fprintf(stderr, "%s: missing\n", target[i].example);
            return -1;
        }
        target[i].good = malloc(SIZE_MAX_B);
        target[i].size = fread(target[i].good, 1, SIZE_MAX_B / 2, file);
        (void)fclose(file);
        struct dig_error error = { "" };
        if (target[i].read(target[i].example, &error) != DIG_OK) {
            (void)fprintf(stderr, "%s: refused: %s\n", target[i].example, error.text);
            return -1;
        }
    }
    return 0;
}

static int target_named(const char *const name)
{
    int found = -1;
    for (int i = 0; i < TARGETS; i++) {
        found = strcmp(target[i].name, name) == 0 ? i : found;
    }
    return found;
}

int main(const int argc, char *argv[])
{
    const double seconds = argc > 1 ? atof(argv[1]) : 10.0;
    state                = argc > 2 ? strtoull(argv[2], NULL, 0) : 1;
    static char text[SIZE_MAX_B];
    char        folder[200];
    char        path[256];
    (void)snprintf(folder, sizeof folder, "%s/fuzz.%llu",
                   getenv("FUZZ_DIR") ? getenv("FUZZ_DIR") : ".", (unsigned long long)state);
    (void)snprintf(path, sizeof path, "%s/campaign.yaml", folder);
    (void)mkdir(folder, 0777);
    if (load_examples() != 0) {
        return 1;
    }
    const int only = argc > 3 ? target_named(argv[3]) : -1;
    if (argc > 3 && only < 0) {
        (void)fprintf(stderr, "fuzz_files: \"%s\" is none of the readers\n", argv[3]);
        return 2;
    }
    const time_t end = time(NULL) + (time_t)seconds;
    for (long n = 0; time(NULL) < end; n++) {
        const int i = only >= 0 ? only : (int)(n % TARGETS);
        memcpy(text, target[i].good, target[i].size);
        const size_t size = mutate(text, target[i].size);
        FILE *const  file = fopen(path, "wb");
        if (file == NULL || fwrite(text, 1, size, file) != size || fclose(file) != 0) {
            perror(path);
            return 1;
        }
        struct dig_error      error  = { "" };
        const enum dig_status status = target[i].read(path, &error);
        if (status != DIG_OK && error.text[0] == '\0') {
            (void)fprintf(stderr, "%s: %s refused without a word (%s)\n", path, target[i].name,
                          dig_status_str(status));
            return 1;
        }
        target[i].taken += status == DIG_OK ? 1 : 0;
        target[i].refused += status == DIG_OK ? 0 : 1;
    }
    (void)remove(path);
    (void)rmdir(folder);
    for (int i = 0; i < TARGETS; i++) {
        (void)printf("%-18s %7ld taken %7ld refused\n", target[i].name, target[i].taken,
                     target[i].refused);
        free(target[i].good);
    }
    (void)printf("%d passed, 0 failed\n", TARGETS);
    return 0;
}

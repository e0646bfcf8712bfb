#include "firmware_host/config/load.h"

#include "core/similar.h"
#include "files/machine_yaml.h"
#include "files/recording_csv.h"
#include "files/yaml/yaml.h"
#include "firmware_host/config/load_model.h"
#include "tables/load.h"

#include <assert.h>
#include <stdio.h>
#include <string.h>

// The table must be of the scene asked for, and of a bucket of the machine's shape: otherwise its
// curves do not apply.
static enum dig_status check_scene(const char *const path, const struct dig_config *const config,
                                   const struct dig_machine *const   machine,
                                   const struct dig_curve_set *const set,
                                   struct dig_error *const           error)
{
    const char *const want = config->scene;
    if (want[0] != '\0' && strcmp(want, set->scene_name) != 0 &&
        strcmp(want, set->scene_hash) != 0) {
        return dig_yaml_refuse(path, error,
                               "scene: \"%s\", but %s is of scene \"%s\" (%s); expected the same",
                               want, config->table.text, set->scene_name, set->scene_hash);
    }
    struct dig_error why = { "" };
    if (dig_bucket_similar(machine, set, &why) != DIG_OK) {
        return dig_yaml_refuse(path, error, "table: %s", why.text);
    }
    for (size_t i = 0; i < config->identify_trajectories; i++) {
        if (dig_curve_set_find(set, config->identify_trajectory[i]) < 0) {
            return dig_yaml_refuse(
                path, error, "identify.trajectories: \"%s\", expected a trajectory of the table",
                config->identify_trajectory[i]);
        }
    }
    return DIG_OK;
}

static enum dig_status load_map(const char *const path, struct dig_loaded *const l,
                                struct dig_error *const error)
{
    struct dig_dbc  dbc    = { 0 };
    const bool      can    = l->config.kind == DIG_INPUT_CAN;
    enum dig_status status = can ? dig_dbc_read(l->config.dbc.text, &dbc, error) : DIG_OK;
    status                 = dig_yaml_tell_namer(path, "input.can.dbc", status, error);
    if (status == DIG_OK) {
        status = dig_signal_map_read(l->config.map.text, can ? &dbc : NULL, &l->map, error);
        status =
            dig_yaml_tell_namer(path, can ? "input.can.map" : "input.modbus.map", status, error);
    }
    if (status == DIG_OK && can != (l->map.kind == DIG_MAP_CAN)) {
        status = dig_yaml_refuse(l->config.map.text, error, "kind: %s, expected %s for this input",
                                 can ? "modbus" : "can", can ? "can" : "modbus");
    }
    dig_dbc_finish(&dbc);
    return status;
}

static enum dig_status load_recording(const char *const path, struct dig_loaded *const l,
                                      struct dig_error *const error)
{
    const enum dig_status status =
        dig_machine_recording_read(l->config.replay.text, &l->recording, error);
    return dig_yaml_tell_namer(path, "input.replay.file", status, error);
}

// A signal is measured when it has an entry in the map, or a value anywhere in the recording.
static void find_measured(struct dig_loaded *const l)
{
    for (size_t s = 0; s < DIG_SIGNALS; s++) {
        l->measured[s] = l->config.kind != DIG_INPUT_REPLAY && l->map.entry[s].used;
        for (size_t i = 0; i < l->recording.rows && !l->measured[s]; i++) {
            l->measured[s] = l->recording.row[i].valid[s];
        }
    }
}

// Cylinders or force sensor: input and machine file must agree.
static enum dig_status check_sensing(const char *const path, const struct dig_loaded *const l,
                                     struct dig_error *const error)
{
    const bool senses = dig_signals_sensing(l->measured) == DIG_SENSING_SENSOR;
    if (senses == l->machine.sensor.fitted) {
        return DIG_OK;
    }
    return dig_yaml_refuse(
        path, error, "machine: %s has %s, but the input brings %s; expected the same",
        l->machine.name, senses ? "cylinders" : "a force sensor that carries its bucket",
        senses ? "signals of a force sensor" : "none of its signals");
}

// The table, with the model in it, where there is one.
static enum dig_status load_set(const char *const path, const struct dig_config *const config,
                                const struct dig_machine *const     machine,
                                struct dig_curve_set **const        set,
                                struct dig_corrected_machine *const corrected,
                                struct dig_error *const             error)
{
    struct dig_curve_set        *loaded = NULL;
    struct dig_corrected_machine made   = { .corrects = false };
    enum dig_status              status = dig_table_load(config->table.text, &loaded, error);
    status                              = dig_yaml_tell_namer(path, "table", status, error);
    status = status == DIG_OK ? check_scene(path, config, machine, loaded, error) : status;
    if (status == DIG_OK && config->model.text[0] != '\0') {
        status =
            dig_load_model(config->model.text, config->table.text, machine, loaded, &made, error);
        status = dig_yaml_tell_namer(path, "model", status, error);
    }
    if (status != DIG_OK) {
        dig_curve_set_destroy(loaded);
        return status;
    }
    *set       = loaded;
    *corrected = made;
    return DIG_OK;
}

enum dig_status dig_load(const char *const path, struct dig_loaded *const loaded,
                         struct dig_error *const error)
{
    assert(path != NULL && loaded != NULL);
    struct dig_loaded l      = { 0 };
    enum dig_status   status = dig_config_read(path, &l.config, error);
    if (status == DIG_OK) {
        status = dig_machine_read(l.config.machine.text, &l.machine, error);
        status = dig_yaml_tell_namer(path, "machine", status, error);
    }
    if (status == DIG_OK) {
        status = l.config.kind == DIG_INPUT_REPLAY ? load_recording(path, &l, error)
                                                   : load_map(path, &l, error);
    }
    if (status == DIG_OK) {
        find_measured(&l);
        status = check_sensing(path, &l, error);
    }
    if (status == DIG_OK) {
        status = load_set(path, &l.config, &l.machine, &l.set, &l.corrected, error);
    }
    if (status != DIG_OK) {
        dig_loaded_finish(&l);
        return status;
    }
    *loaded = l;
    return DIG_OK;
}

enum dig_status dig_load_table(const char *const path, const struct dig_machine *const machine,
                               struct dig_curve_set **const        set,
                               struct dig_corrected_machine *const corrected,
                               struct dig_error *const             error)
{
    assert(path != NULL && machine != NULL && set != NULL && corrected != NULL);
    struct dig_config     config;
    const enum dig_status status = dig_config_read(path, &config, error);
    return status == DIG_OK ? load_set(path, &config, machine, set, corrected, error) : status;
}

void dig_loaded_finish(struct dig_loaded *const loaded)
{
    if (loaded != NULL) {
        dig_curve_set_destroy(loaded->set);
        dig_machine_recording_finish(&loaded->recording);
        *loaded = (struct dig_loaded){ 0 };
    }
}

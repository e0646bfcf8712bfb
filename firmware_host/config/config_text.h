// The daemon's configuration as it stands in the file, and its schema. Internal to config.c.

#ifndef DIG_FIRMWARE_HOST_CONFIG_CONFIG_TEXT_H
#define DIG_FIRMWARE_HOST_CONFIG_CONFIG_TEXT_H

#include "firmware_host/config/config.h"

#include <cyaml/cyaml.h>

// Pointers: NULL where a key is absent.
struct dig_can_text {
    char *interface, *dbc, *map;
};

struct dig_modbus_text {
    char   *address, *device, *parity, *map;
    int    *baud, *unit;
    double *poll_Hz;
};

struct dig_replay_text {
    char   *file;
    double *speed;
};

struct dig_input_text {
    enum dig_input_kind     kind;
    struct dig_can_text    *can;
    struct dig_modbus_text *modbus;
    struct dig_replay_text *replay;
};

struct dig_realtime_text {
    int  *priority, *cpu;
    bool *lock_memory;
};

struct dig_lcm_text {
    char *url;
};

struct dig_estimator_text {
    double *sample_s, *contact_sigmas, *contact_hold_s, *exit_hold_s, *air_bias_s, *path_limit_m,
        *outside_floors;
};

struct dig_match_text {
    int    *max_evaluations;
    double *least_path;
    double *early_path;
    char   *state;
    double *expires_h, *drift_floors;
};

struct dig_identify_text {
    char   **trajectories;
    unsigned trajectories_count;
};

struct dig_publish_text {
    int    *estimate_every;
    double *prediction_Hz;
};

struct dig_config_text {
    char                 *table, *machine, *scene, *model;
    struct dig_input_text input;
    double               *tick_Hz, *stale_ms, *time_scale;
    // Where a part is absent, nothing of it is given.
    struct dig_realtime_text  realtime;
    struct dig_lcm_text       lcm;
    struct dig_estimator_text estimator;
    struct dig_match_text     match;
    struct dig_identify_text  identify;
    struct dig_publish_text   publish;
};

/// Of a struct dig_config_text.
extern const cyaml_schema_value_t dig_config_schema;

/// The word a kind of input goes by.
const char *dig_input_kind_name(enum dig_input_kind kind);

#endif // DIG_FIRMWARE_HOST_CONFIG_CONFIG_TEXT_H

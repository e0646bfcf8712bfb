// The daemon's configuration: a YAML file (docs/formats.md) as plain settings. All but table and
// model are fixed at start; a reload reads these again. File names are relative to the
// configuration's folder.

#ifndef DIG_FIRMWARE_HOST_CONFIG_CONFIG_H
#define DIG_FIRMWARE_HOST_CONFIG_CONFIG_H

#include "core/curve.h"
#include "core/error.h"
#include "estimator/track/settings.h"
#include "firmware_host/bus/input.h"
#include "firmware_host/threads/rt.h"

#include <limits.h>
#include <stdbool.h>
#include <stddef.h>

enum dig_input_kind {
    DIG_INPUT_CAN,
    DIG_INPUT_MODBUS_TCP,
    DIG_INPUT_MODBUS_RTU,
    DIG_INPUT_REPLAY,
};

struct dig_file_name {
    char text[PATH_MAX];
};

struct dig_config {
    struct dig_file_name table, machine;
    struct dig_file_name model;     // of the closed loop; "": none
    char                 scene[65]; // the table's, by name or hash; "": any

    enum dig_input_kind       kind;
    char                      can_interface[16];
    struct dig_file_name      dbc, map;
    struct dig_modbus_address modbus;
    struct dig_file_name      replay;
    double                    replay_speed;

    double                        tick_s;
    double                        stale_s;    // samples older than this are not fresh
    double                        time_scale; // machine seconds per second; 1 on a machine
    struct dig_rt_settings        realtime;
    char                          lcm_url[256];
    struct dig_estimator_settings estimator;
    int                           match_evaluations;
    double                        match_least_path; // share of the path a match needs
    double match_early_path;          // share after which a dig in progress is matched; 1: never
    struct dig_file_name match_state; // file that keeps the gravel; "": none
    double               match_expires_s;
    double               drift_floors;
    size_t               identify_trajectories; // 0: all whose name begins with "simple"
    char                 identify_trajectory[DIG_TRAJECTORY_MAX][DIG_NAME_SIZE];
    int                  estimate_every; // one sample and estimate in so many is published
    double               prediction_s;   // between predictions
};

/// Reads and checks a file. DIG_EINVAL names file, line, key and what was expected. Writes on
/// success only. The files it names are not opened.
DIG_MUST_CHECK enum dig_status dig_config_read(const char *path, struct dig_config *config,
                                               struct dig_error *error);

/// True when digs of this trajectory identify the gravel.
bool dig_config_identifies(const struct dig_config *config, const char *trajectory);

#endif // DIG_FIRMWARE_HOST_CONFIG_CONFIG_H

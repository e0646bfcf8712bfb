// Loads everything the configuration names, and checks that it fits together.

#ifndef DIG_FIRMWARE_HOST_CONFIG_LOAD_H
#define DIG_FIRMWARE_HOST_CONFIG_LOAD_H

#include "core/machine.h"
#include "core/recording.h"
#include "estimator/wrench/correction.h"
#include "firmware_host/bus/signal_map.h"
#include "firmware_host/config/config.h"

struct dig_loaded {
    struct dig_config            config;
    struct dig_machine           machine;
    struct dig_corrected_machine corrected; // by the model's effects of the machine
    struct dig_curve_set        *set;       // with the model's effects of the soil in it
    struct dig_signal_map        map;       // of a bus
    struct dig_machine_recording recording; // of a replay
    bool                         measured[DIG_SIGNALS]; // in map or recording
};

/// Errors as dig_daemon_create(). Writes on success only; free with dig_loaded_finish().
DIG_MUST_CHECK enum dig_status dig_load(const char *path, struct dig_loaded *loaded,
                                        struct dig_error *error);

/// Loads again the table and the model the configuration now names, for the machine read at start.
/// corrected: the machine with the model's correction. Errors as above.
DIG_MUST_CHECK enum dig_status dig_load_table(const char *path, const struct dig_machine *machine,
                                              struct dig_curve_set        **set,
                                              struct dig_corrected_machine *corrected,
                                              struct dig_error             *error);

/// NULL and a zeroed struct are allowed.
void dig_loaded_finish(struct dig_loaded *loaded);

#endif // DIG_FIRMWARE_HOST_CONFIG_LOAD_H

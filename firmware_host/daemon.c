#include "firmware_host/daemon.h"

#include "firmware_host/daemon_private.h"

#include <assert.h>
#include <stdio.h>
#include <stdlib.h>

static enum dig_status create_input(struct dig_daemon *const d, const char *const path,
                                    struct dig_error *const error)
{
    const struct dig_config *const config = &d->loaded.config;
    enum dig_status                status = DIG_EINVAL;
    switch (config->kind) {
    case DIG_INPUT_CAN:
        status = dig_input_can_create(&d->input, config->can_interface, &d->loaded.map);
        break;
    case DIG_INPUT_MODBUS_TCP:
    case DIG_INPUT_MODBUS_RTU:
        status = dig_input_modbus_create(&d->input, &config->modbus, &d->loaded.map);
        break;
    case DIG_INPUT_REPLAY:
        status = dig_input_replay_create(&d->input, &d->loaded.recording, config->replay.text,
                                         config->replay_speed);
        break;
    }
    return status == DIG_OK
               ? DIG_OK
               : dig_error_set(error, status, "%s: input: %s", path, dig_status_str(status));
}

// The machine's and the map's limits in the assembler's words.
static struct dig_assembler_settings assembler_settings(const struct dig_loaded *const l)
{
    struct dig_assembler_settings settings = {
        .time_scale = l->config.time_scale,
        .coherent_s = 1.0,
        .optional_s = 1.0,
        .groups     = 1,
        .needed     = { [0] = true },
    };
    if (l->config.kind == DIG_INPUT_REPLAY) {
        return settings;
    }
    settings.has_alive = l->map.has_alive;
    settings.frozen_s  = l->map.frozen_s;
    settings.repeats   = l->map.kind == DIG_MAP_MODBUS;
    settings.stuck_s   = l->map.stuck_s;
    for (size_t i = 0; i < DIG_SIGNALS; i++) {
        settings.max_rate[i] = l->map.entry[i].max_rate;
    }
    settings.coherent_s = l->map.coherent_s;
    settings.groups     = (unsigned)l->map.groups;
    for (size_t g = 0; g < l->map.groups; g++) {
        settings.needed[g]      = l->map.group[g].needed;
        settings.dispensable[g] = l->map.group[g].dispensable;
        settings.frame[g]       = l->map.group[g].frame;
    }
    return settings;
}

static void connect_threads(struct dig_daemon *const d)
{
    struct dig_handoffs *const h = &d->handoffs;
    dig_handoffs_init(h, &d->memory);

    d->input.readings = &h->readings;
    d->input.log      = &h->input_log;
    d->input.stop     = &d->stop;

    const struct dig_config *const config   = &d->loaded.config;
    const struct dig_loop_settings settings = {
        .assembler    = assembler_settings(&d->loaded),
        .tick_s       = config->tick_s,
        .stale_s      = config->stale_s,
        .prediction_s = config->prediction_s,
        .next_dig_s   = 0.5,
        .set          = d->loaded.set,
    };
    dig_loop_init(&d->loop, &settings, h, d->estimator);
    for (size_t i = 0; i < DIGS_MORE; i++) {
        (void)dig_ring_push(&h->spares, &d->dig_memory[i]);
    }

    d->early.estimates = &h->estimates;
    dig_early_match_clear(&d->early, d->loaded.set);
    atomic_store(&d->publisher_generation, 1);
    d->fit = (struct dig_fit){
        .config_path    = d->path,
        .config         = config,
        .machine        = &d->loaded.machine,
        .track_settings = { .expires_s    = config->match_expires_s,
                            .drift_floors = config->drift_floors },
        .handoffs       = h,
        .stop           = &d->stop,
        .matcher        = { .tick_generation      = &d->loop.generation,
                            .publisher_generation = &d->publisher_generation },
        .early          = &d->early,
    };
    d->publisher = (struct dig_publisher){
        .config     = config,
        .set        = d->loaded.set,
        .handoffs   = h,
        .generation = &d->publisher_generation,
        .stop       = &d->stop_publish,
        .health     = { .tick_s = config->tick_s, .input = &d->input, .fit = &d->fit.count }
    };
}

static bool allocate(struct dig_daemon *const d)
{
    bool all     = true;
    d->estimator = calloc(1, dig_estimator_size());
    for (size_t i = 0; i < DIGS_MORE; i++) {
        d->dig_memory[i] = calloc(1, dig_recorded_dig_size());
        all              = all && d->dig_memory[i] != NULL;
    }
    return all && d->estimator != NULL;
}

enum dig_status dig_daemon_create(const char *const path, struct dig_daemon **const daemon,
                                  struct dig_error *const error)
{
    assert(path != NULL && daemon != NULL);
    struct dig_daemon *const d = calloc(1, sizeof *d);
    if (d == NULL) {
        return dig_error_set(error, DIG_ENOMEM, "no memory");
    }
    (void)snprintf(d->path, sizeof d->path, "%s", path);
    enum dig_status status = dig_load(path, &d->loaded, error);
    if (status == DIG_OK) {
        status = allocate(d) ? DIG_OK : dig_error_set(error, DIG_ENOMEM, "no memory");
    }
    if (status == DIG_OK) {
        status = dig_estimator_init(d->estimator, &d->loaded.machine, d->loaded.set,
                                    &d->loaded.config.estimator);
        if (status != DIG_OK) {
            (void)dig_error_set(error, status, "%s: machine %s with table %s: %s", path,
                                d->loaded.config.machine.text, d->loaded.config.table.text,
                                dig_status_str(status));
        }
    }
    if (status == DIG_OK) {
        dig_estimator_set_machine(d->estimator, &d->loaded.corrected);
        status = create_input(d, path, error);
    }
    if (status != DIG_OK) {
        dig_daemon_destroy(d);
        return status;
    }
    connect_threads(d);
    dig_matcher_exchange(&d->fit.matcher, d->loaded.set,
                         d->loaded.machine.link[DIG_JOINT_BUCKET].length_m /
                             d->loaded.set->tooth_m);
    d->loaded.set = NULL; // the matcher's from now on, as it may exchange it
    dig_fit_restore(&d->fit);
    *daemon = d;
    return DIG_OK;
}

void dig_daemon_destroy(struct dig_daemon *const daemon)
{
    if (daemon != NULL) {
        dig_input_destroy(&daemon->input);
        dig_matcher_finish(&daemon->fit.matcher);
        free(daemon->estimator);
        for (size_t i = 0; i < DIGS_MORE; i++) {
            free(daemon->dig_memory[i]);
        }
        dig_loaded_finish(&daemon->loaded);
        free(daemon);
    }
}

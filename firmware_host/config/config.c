#include "firmware_host/config/config.h"

#include "files/yaml/yaml.h"
#include "firmware_host/config/config_parts.h"

#include <assert.h>
#include <stddef.h>
#include <string.h>

#define DEFAULT_LCM_URL "udpm://239.255.76.67:7667?ttl=0"

static enum dig_status take_estimator(const struct dig_config_work *const    work,
                                      const struct dig_estimator_text *const text)
{
    struct dig_estimator_settings *const to       = &work->config->estimator;
    const struct dig_config_number       number[] = {
              { "estimator.sample_s", text->sample_s, 0.001, 0.1, &to->tick_s },
              { "estimator.contact_sigmas", text->contact_sigmas, 1.0, 1000.0, &to->contact_sigmas },
              { "estimator.contact_hold_s", text->contact_hold_s, 0.0, 10.0, &to->contact_hold_s },
              { "estimator.exit_hold_s", text->exit_hold_s, 0.0, 10.0, &to->exit_hold_s },
              { "estimator.air_bias_s", text->air_bias_s, 0.0, 1000.0, &to->air_bias_s },
              { "estimator.path_limit_m", text->path_limit_m, 1e-4, 10.0, &to->path_limit_m },
              { "estimator.outside_floors", text->outside_floors, 0.1, 1000.0, &to->outside_floors },
    };
    const char           *reason = NULL;
    const enum dig_status status = dig_config_take_numbers(work, CYAML_ARRAY_LEN(number), number);
    if (status == DIG_OK && dig_estimator_settings_check(to, &reason) != DIG_OK) {
        return dig_yaml_refuse(work->path, work->error, "estimator: %s", reason);
    }
    return status;
}

static enum dig_status take_realtime(const struct dig_config_work *const   work,
                                     const struct dig_realtime_text *const text)
{
    struct dig_rt_settings *const to      = &work->config->realtime;
    const struct dig_config_whole whole[] = {
        { "realtime.priority", text->priority, 0, 99, &to->priority },
        { "realtime.cpu", text->cpu, -1, 1023, &to->cpu },
    };
    if (text->lock_memory != NULL) {
        to->lock_memory = *text->lock_memory;
    }
    return dig_config_take_wholes(work, CYAML_ARRAY_LEN(whole), whole);
}

static enum dig_status take_identify(const struct dig_config_work *const   work,
                                     const struct dig_identify_text *const text)
{
    struct dig_config *const config = work->config;
    enum dig_status          status = DIG_OK;
    for (unsigned i = 0; status == DIG_OK && i < text->trajectories_count; i++) {
        status = dig_config_take_text(work, "identify.trajectories", text->trajectories[i],
                                      DIG_NAME_SIZE, config->identify_trajectory[i]);
        config->identify_trajectories = i + 1;
    }
    return status;
}

static enum dig_status take_publish(const struct dig_config_work *const  work,
                                    const struct dig_publish_text *const text)
{
    struct dig_config *const       config        = work->config;
    double                         prediction_Hz = 1.0 / config->prediction_s;
    const struct dig_config_number number[]      = {
             { "publish.prediction_Hz", text->prediction_Hz, 0.1, 100.0, &prediction_Hz },
    };
    const struct dig_config_whole whole[] = {
        { "publish.estimate_every", text->estimate_every, 1, 1000, &config->estimate_every },
    };
    const enum dig_status status = dig_config_take_numbers(work, CYAML_ARRAY_LEN(number), number);
    config->prediction_s         = 1.0 / prediction_Hz;
    return status == DIG_OK ? dig_config_take_wholes(work, CYAML_ARRAY_LEN(whole), whole) : status;
}

static enum dig_status take_match(const struct dig_config_work *const work,
                                  const struct dig_match_text *const  text)
{
    struct dig_config *const      config    = work->config;
    double                        expires_h = config->match_expires_s / 3600.0;
    const struct dig_config_whole whole[]   = {
          { "match.max_evaluations", text->max_evaluations, 1, 1000000, &config->match_evaluations },
    };
    const struct dig_config_number number[] = {
        { "match.least_path", text->least_path, 0.01, 1.0, &config->match_least_path },
        { "match.early_path", text->early_path, 0.1, 1.0, &config->match_early_path },
        { "match.expires_h", text->expires_h, 0.01, 1000.0, &expires_h },
        { "match.drift_floors", text->drift_floors, 1.0, 1000.0, &config->drift_floors },
    };
    enum dig_status status = dig_config_take_wholes(work, CYAML_ARRAY_LEN(whole), whole);
    status =
        status == DIG_OK ? dig_config_take_numbers(work, CYAML_ARRAY_LEN(number), number) : status;
    if (status == DIG_OK && text->state != NULL) {
        status = dig_config_take_path(work, "match.state", text->state, &config->match_state);
    }
    config->match_expires_s = expires_h * 3600.0;
    return status;
}

static enum dig_status take_parts(const struct dig_config_work *const work,
                                  const struct dig_config_text *const text)
{
    struct dig_config *const config = work->config;
    enum dig_status          status = take_estimator(work, &text->estimator);
    status = status == DIG_OK ? take_realtime(work, &text->realtime) : status;
    status = status == DIG_OK ? take_identify(work, &text->identify) : status;
    status = status == DIG_OK ? take_publish(work, &text->publish) : status;
    status = status == DIG_OK ? take_match(work, &text->match) : status;
    return status == DIG_OK && text->lcm.url != NULL
               ? dig_config_take_text(work, "lcm.url", text->lcm.url, sizeof config->lcm_url,
                                      config->lcm_url)
               : status;
}

static enum dig_status take_top(const struct dig_config_work *const work,
                                const struct dig_config_text *const text)
{
    struct dig_config *const       config   = work->config;
    double                         tick_Hz  = 1.0 / config->tick_s;
    double                         stale_ms = config->stale_s * 1e3;
    const struct dig_config_number number[] = {
        { "tick_Hz", text->tick_Hz, 100.0, 2000.0, &tick_Hz },
        { "stale_ms", text->stale_ms, 1.0, 60e3, &stale_ms },
        { "time_scale", text->time_scale, 0.01, 100.0, &config->time_scale },
    };
    enum dig_status status = dig_config_take_numbers(work, CYAML_ARRAY_LEN(number), number);
    if (status == DIG_OK && text->time_scale != NULL && text->input.kind == DIG_INPUT_REPLAY) {
        status =
            dig_yaml_refuse(work->path, work->error,
                            "time_scale: given with a replay, expected input.replay.speed alone");
    }
    if (status == DIG_OK && text->scene != NULL) {
        status =
            dig_config_take_text(work, "scene", text->scene, sizeof config->scene, config->scene);
    }
    status = status == DIG_OK ? dig_config_take_path(work, "table", text->table, &config->table)
                              : status;
    status = status == DIG_OK
                 ? dig_config_take_path(work, "machine", text->machine, &config->machine)
                 : status;
    if (status == DIG_OK && text->model != NULL) {
        status = dig_config_take_path(work, "model", text->model, &config->model);
    }

    config->tick_s           = 1.0 / tick_Hz;
    config->estimator.tick_s = config->tick_s;
    config->stale_s          = stale_ms * 1e-3;
    return status;
}

static struct dig_config defaults(void)
{
    struct dig_config config = {
        .modbus            = { .baud = 115200, .parity = 'E', .unit = 1 },
        .replay_speed      = 1.0,
        .tick_s            = 1.0 / 1000.0,
        .stale_s           = 0.1,
        .time_scale        = 1.0,
        .realtime          = { .priority = 80, .lock_memory = true, .cpu = -1 },
        .lcm_url           = DEFAULT_LCM_URL,
        .estimator         = dig_estimator_settings_default(),
        .match_evaluations = 2000,
        .match_least_path  = 0.6,
        .match_early_path  = 0.3,
        .match_expires_s   = 12.0 * 3600.0,
        .drift_floors      = 3.0,
        .estimate_every    = 1,
        .prediction_s      = 1.0 / 15.0,
    };
    config.estimator.tick_s = config.tick_s;
    return config;
}

enum dig_status dig_config_read(const char *const path, struct dig_config *const config,
                                struct dig_error *const error)
{
    assert(path != NULL && config != NULL);
    cyaml_data_t   *data   = NULL;
    enum dig_status status = dig_yaml_load(path, &dig_config_schema, &data, error);
    if (status != DIG_OK) {
        return status;
    }
    struct dig_config                   loaded = defaults();
    const struct dig_config_work        work = { .path = path, .config = &loaded, .error = error };
    const struct dig_config_text *const text = (const struct dig_config_text *)data;
    status                                   = take_top(&work, text);
    status = status == DIG_OK ? dig_config_take_input(&work, &text->input) : status;
    status = status == DIG_OK ? take_parts(&work, text) : status;
    dig_yaml_free(&dig_config_schema, data);
    if (status == DIG_OK) {
        *config = loaded;
    }
    return status;
}

bool dig_config_identifies(const struct dig_config *const config, const char *const trajectory)
{
    assert(config != NULL && trajectory != NULL);
    for (size_t i = 0; i < config->identify_trajectories; i++) {
        if (strcmp(config->identify_trajectory[i], trajectory) == 0) {
            return true;
        }
    }
    return config->identify_trajectories == 0 && strncmp(trajectory, "simple", 6) == 0;
}

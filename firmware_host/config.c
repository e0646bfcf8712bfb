#include "firmware_host/config.h"

#include "files/yaml.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define DEFAULT_LCM_URL "udpm://239.255.76.67:7667?ttl=0"

// The file as it is written. Pointers: NULL where a key is absent.
struct can_text {
    char *interface, *dbc, *map;
};

struct modbus_text {
    char   *address, *device, *parity, *map;
    int    *baud, *unit;
    double *poll_Hz;
};

struct replay_text {
    char   *file;
    double *speed;
};

struct input_text {
    enum dig_input_kind kind;
    struct can_text    *can;
    struct modbus_text *modbus;
    struct replay_text *replay;
};

struct realtime_text {
    int  *priority, *cpu;
    bool *lock_memory;
};

struct lcm_text {
    char *url;
};

struct estimator_text {
    double *sample_s, *contact_sigmas, *contact_hold_s, *exit_hold_s, *air_bias_s, *path_limit_m,
        *outside_floors;
};

struct match_text {
    int *max_evaluations;
};

struct identify_text {
    char   **trajectories;
    unsigned trajectories_count;
};

struct publish_text {
    int    *estimate_every;
    double *prediction_Hz;
};

struct config_text {
    char                  *table, *machine, *scene;
    struct input_text      input;
    double                *tick_Hz, *stale_ms, *time_scale;
    struct realtime_text  *realtime;
    struct lcm_text       *lcm;
    struct estimator_text *estimator;
    struct match_text     *match;
    struct identify_text  *identify;
    struct publish_text   *publish;
};

#define REQUIRED CYAML_FLAG_DEFAULT
#define POINTER  CYAML_FLAG_POINTER
#define OPTIONAL (CYAML_FLAG_OPTIONAL | CYAML_FLAG_POINTER)

#define TEXT(type, name, flags) CYAML_FIELD_STRING_PTR(#name, flags, struct type, name, 1, 1000)
#define NUMBER(type, name)      CYAML_FIELD_FLOAT_PTR(#name, OPTIONAL, struct type, name)
#define WHOLE(type, name)       CYAML_FIELD_INT_PTR(#name, OPTIONAL, struct type, name)
#define PART(type, name)        CYAML_FIELD_MAPPING_PTR(#name, OPTIONAL, struct type, name, name##_fields)

static const cyaml_strval_t kinds[] = {
    { "can", DIG_INPUT_CAN },
    { "modbus-tcp", DIG_INPUT_MODBUS_TCP },
    { "modbus-rtu", DIG_INPUT_MODBUS_RTU },
    { "replay", DIG_INPUT_REPLAY },
};

static const cyaml_schema_field_t can_fields[] = {
    TEXT(can_text, interface, POINTER),
    TEXT(can_text, dbc, POINTER),
    TEXT(can_text, map, POINTER),
    CYAML_FIELD_END,
};

static const cyaml_schema_field_t modbus_fields[] = {
    TEXT(modbus_text, address, OPTIONAL),
    TEXT(modbus_text, device, OPTIONAL),
    WHOLE(modbus_text, baud),
    TEXT(modbus_text, parity, OPTIONAL),
    WHOLE(modbus_text, unit),
    TEXT(modbus_text, map, POINTER),
    NUMBER(modbus_text, poll_Hz),
    CYAML_FIELD_END,
};

static const cyaml_schema_field_t replay_fields[] = {
    TEXT(replay_text, file, POINTER),
    NUMBER(replay_text, speed),
    CYAML_FIELD_END,
};

static const cyaml_schema_field_t input_fields[] = {
    CYAML_FIELD_ENUM("kind", REQUIRED, struct input_text, kind, kinds, CYAML_ARRAY_LEN(kinds)),
    PART(input_text, can),
    PART(input_text, modbus),
    PART(input_text, replay),
    CYAML_FIELD_END,
};

static const cyaml_schema_field_t realtime_fields[] = {
    WHOLE(realtime_text, priority),
    WHOLE(realtime_text, cpu),
    CYAML_FIELD_BOOL_PTR("lock_memory", OPTIONAL, struct realtime_text, lock_memory),
    CYAML_FIELD_END,
};

static const cyaml_schema_field_t lcm_fields[] = {
    TEXT(lcm_text, url, OPTIONAL),
    CYAML_FIELD_END,
};

static const cyaml_schema_field_t estimator_fields[] = {
    NUMBER(estimator_text, sample_s),       NUMBER(estimator_text, contact_sigmas),
    NUMBER(estimator_text, contact_hold_s), NUMBER(estimator_text, exit_hold_s),
    NUMBER(estimator_text, air_bias_s),     NUMBER(estimator_text, path_limit_m),
    NUMBER(estimator_text, outside_floors), CYAML_FIELD_END,
};

static const cyaml_schema_field_t match_fields[] = {
    WHOLE(match_text, max_evaluations),
    CYAML_FIELD_END,
};

static const cyaml_schema_value_t name_value = { CYAML_VALUE_STRING(POINTER, char *, 1,
                                                                    DIG_NAME_SIZE - 1) };

static const cyaml_schema_field_t identify_fields[] = {
    CYAML_FIELD_SEQUENCE("trajectories", POINTER, struct identify_text, trajectories, &name_value,
                         1, DIG_TRAJECTORY_MAX),
    CYAML_FIELD_END,
};

static const cyaml_schema_field_t publish_fields[] = {
    WHOLE(publish_text, estimate_every),
    NUMBER(publish_text, prediction_Hz),
    CYAML_FIELD_END,
};

static const cyaml_schema_field_t config_fields[] = {
    TEXT(config_text, table, POINTER),
    TEXT(config_text, machine, POINTER),
    TEXT(config_text, scene, OPTIONAL),
    CYAML_FIELD_MAPPING("input", REQUIRED, struct config_text, input, input_fields),
    NUMBER(config_text, tick_Hz),
    NUMBER(config_text, stale_ms),
    NUMBER(config_text, time_scale),
    PART(config_text, realtime),
    PART(config_text, lcm),
    PART(config_text, estimator),
    PART(config_text, match),
    PART(config_text, identify),
    PART(config_text, publish),
    CYAML_FIELD_END,
};

static const cyaml_schema_value_t schema = { CYAML_VALUE_MAPPING(POINTER, struct config_text,
                                                                 config_fields) };

// What is being read, for messages.
struct work {
    const char        *path;
    struct dig_config *config;
    struct dig_error  *error;
};

// A number where given, within a range; *to holds the default.
static enum dig_status take(const struct work *const work, const char *const key,
                            const double *const from, const double least, const double most,
                            double *const to)
{
    if (from == NULL) {
        return DIG_OK;
    }
    if (!(*from >= least && *from <= most)) {
        return dig_yaml_refuse(work->path, key, work->error, "%g, expected %g … %g", *from, least,
                               most);
    }
    *to = *from;
    return DIG_OK;
}

static enum dig_status take_whole(const struct work *const work, const char *const key,
                                  const int *const from, const int least, const int most,
                                  int *const to)
{
    if (from == NULL) {
        return DIG_OK;
    }
    if (*from < least || *from > most) {
        return dig_yaml_refuse(work->path, key, work->error, "%d, expected %d … %d", *from, least,
                               most);
    }
    *to = *from;
    return DIG_OK;
}

static enum dig_status take_text(const struct work *const work, const char *const key,
                                 const char *const from, const size_t size, char to[])
{
    const int length = snprintf(to, size, "%s", from);
    if (length < 0 || (size_t)length >= size) {
        return dig_yaml_refuse(work->path, key, work->error, "%d characters, expected at most %zu",
                               length, size - 1);
    }
    return DIG_OK;
}

// A file's name as seen from the configuration's folder.
static enum dig_status take_path(const struct work *const work, const char *const key,
                                 const char *const from, struct dig_path *const to)
{
    const char *const slash  = strrchr(work->path, '/');
    const int         folder = from[0] == '/' || slash == NULL ? 0 : (int)(slash + 1 - work->path);
    const int length = snprintf(to->text, sizeof to->text, "%.*s%s", folder, work->path, from);
    if (length < 0 || (size_t)length >= sizeof to->text) {
        return dig_yaml_refuse(work->path, key, work->error, "too long a path");
    }
    return DIG_OK;
}

#define TRY(call)                                                                                  \
    do {                                                                                           \
        const enum dig_status tried = (call);                                                      \
        if (tried != DIG_OK) {                                                                     \
            return tried;                                                                          \
        }                                                                                          \
    } while (0)

// "127.0.0.1:1502" or "[::1]:1502"
static enum dig_status take_address(const struct work *const work, const char *const text,
                                    struct dig_modbus_address *const address)
{
    const char *const colon  = strrchr(text, ':');
    const size_t      length = colon != NULL ? (size_t)(colon - text) : 0;
    char             *end    = NULL;
    const long        port   = colon != NULL ? strtol(colon + 1, &end, 10) : 0;
    if (length == 0 || length >= sizeof address->host || end == colon + 1 || *end != '\0' ||
        port < 1 || port > 65535) {
        return dig_yaml_refuse(work->path, "input.modbus.address", work->error,
                               "\"%.60s\", expected HOST:PORT", text);
    }
    const bool brackets = text[0] == '[' && length > 2 && text[length - 1] == ']';
    memcpy(address->host, text + brackets, length - 2 * (size_t)brackets);
    address->host[length - 2 * (size_t)brackets] = '\0';
    address->port                                = (int)port;
    return DIG_OK;
}

static enum dig_status take_parity(const struct work *const work, const char *const text,
                                   struct dig_modbus_address *const address)
{
    if (text == NULL) {
        return DIG_OK;
    }
    if (strcmp(text, "none") != 0 && strcmp(text, "even") != 0 && strcmp(text, "odd") != 0) {
        return dig_yaml_refuse(work->path, "input.modbus.parity", work->error,
                               "\"%.20s\", expected none, even or odd", text);
    }
    address->parity = text[0] == 'n' ? 'N' : text[0] == 'e' ? 'E' : 'O';
    return DIG_OK;
}

static enum dig_status take_modbus(const struct work *const        work,
                                   const struct modbus_text *const text)
{
    struct dig_config *const         config  = work->config;
    struct dig_modbus_address *const address = &config->modbus;
    const bool                       tcp     = config->kind == DIG_INPUT_MODBUS_TCP;
    if ((tcp ? text->address : text->device) == NULL) {
        return dig_yaml_refuse(work->path, tcp ? "input.modbus.address" : "input.modbus.device",
                               work->error, "missing, expected %s",
                               tcp ? "HOST:PORT" : "a serial device");
    }
    if (tcp) {
        TRY(take_address(work, text->address, address));
    } else {
        TRY(take_text(work, "input.modbus.device", text->device, sizeof address->device,
                      address->device));
    }
    double poll_Hz = 1.0 / config->tick_s;
    TRY(take(work, "input.modbus.poll_Hz", text->poll_Hz, 1.0, 1000.0, &poll_Hz));
    address->poll_s          = 1.0 / poll_Hz;
    config->estimator.tick_s = 1.0 / poll_Hz;
    TRY(take_whole(work, "input.modbus.baud", text->baud, 1200, 4000000, &address->baud));
    TRY(take_whole(work, "input.modbus.unit", text->unit, 0, 247, &address->unit));
    TRY(take_parity(work, text->parity, address));
    return take_path(work, "input.modbus.map", text->map, &config->map);
}

static enum dig_status take_input(const struct work *const       work,
                                  const struct input_text *const text)
{
    struct dig_config *const config = work->config;
    config->kind                    = text->kind;

    const char *const part  = text->kind == DIG_INPUT_CAN      ? "input.can"
                              : text->kind == DIG_INPUT_REPLAY ? "input.replay"
                                                               : "input.modbus";
    const void *const there = text->kind == DIG_INPUT_CAN      ? (const void *)text->can
                              : text->kind == DIG_INPUT_REPLAY ? (const void *)text->replay
                                                               : (const void *)text->modbus;
    if (there == NULL) {
        return dig_yaml_refuse(work->path, part, work->error,
                               "missing, expected the settings of %s", kinds[text->kind].str);
    }
    if (text->kind == DIG_INPUT_CAN) {
        config->estimator.tick_s = 0.01;
        TRY(take_text(work, "input.can.interface", text->can->interface,
                      sizeof config->can_interface, config->can_interface));
        TRY(take_path(work, "input.can.dbc", text->can->dbc, &config->dbc));
        return take_path(work, "input.can.map", text->can->map, &config->map);
    }
    if (text->kind == DIG_INPUT_REPLAY) {
        TRY(take(work, "input.replay.speed", text->replay->speed, 0.01, 100.0,
                 &config->replay_speed));
        return take_path(work, "input.replay.file", text->replay->file, &config->replay);
    }
    return take_modbus(work, text->modbus);
}

static enum dig_status take_estimator(const struct work *const           work,
                                      const struct estimator_text *const text)
{
    struct dig_estimator_settings *const to = &work->config->estimator;
    if (text != NULL) {
        TRY(take(work, "estimator.sample_s", text->sample_s, 0.001, 0.1, &to->tick_s));
        TRY(take(work, "estimator.contact_sigmas", text->contact_sigmas, 1.0, 1000.0,
                 &to->contact_sigmas));
        TRY(take(work, "estimator.contact_hold_s", text->contact_hold_s, 0.0, 10.0,
                 &to->contact_hold_s));
        TRY(take(work, "estimator.exit_hold_s", text->exit_hold_s, 0.0, 10.0, &to->exit_hold_s));
        TRY(take(work, "estimator.air_bias_s", text->air_bias_s, 0.0, 1000.0, &to->air_bias_s));
        TRY(take(work, "estimator.path_limit_m", text->path_limit_m, 1e-4, 10.0,
                 &to->path_limit_m));
        TRY(take(work, "estimator.outside_floors", text->outside_floors, 0.1, 1000.0,
                 &to->outside_floors));
    }
    const char *reason = NULL;
    if (dig_estimator_settings_check(to, &reason) != DIG_OK) {
        return dig_yaml_refuse(work->path, "estimator", work->error, "%s", reason);
    }
    return DIG_OK;
}

static enum dig_status take_realtime(const struct work *const          work,
                                     const struct realtime_text *const text)
{
    if (text == NULL) {
        return DIG_OK;
    }
    struct dig_rt_settings *const to = &work->config->realtime;
    if (text->lock_memory != NULL) {
        to->lock_memory = *text->lock_memory;
    }
    TRY(take_whole(work, "realtime.priority", text->priority, 0, 99, &to->priority));
    return take_whole(work, "realtime.cpu", text->cpu, -1, 1023, &to->cpu);
}

static enum dig_status take_rest(const struct work *const        work,
                                 const struct config_text *const text)
{
    struct dig_config *const config = work->config;
    TRY(take_realtime(work, text->realtime));
    if (text->lcm != NULL && text->lcm->url != NULL) {
        TRY(take_text(work, "lcm.url", text->lcm->url, sizeof config->lcm_url, config->lcm_url));
    }
    if (text->match != NULL) {
        TRY(take_whole(work, "match.max_evaluations", text->match->max_evaluations, 1, 1000000,
                       &config->match_evaluations));
    }
    for (unsigned i = 0; text->identify != NULL && i < text->identify->trajectories_count; i++) {
        TRY(take_text(work, "identify.trajectories", text->identify->trajectories[i], DIG_NAME_SIZE,
                      config->identify_trajectory[i]));
        config->identify_trajectories = i + 1;
    }
    if (text->publish != NULL) {
        double prediction_Hz = 1.0 / config->prediction_s;
        TRY(take_whole(work, "publish.estimate_every", text->publish->estimate_every, 1, 1000,
                       &config->estimate_every));
        TRY(take(work, "publish.prediction_Hz", text->publish->prediction_Hz, 0.1, 100.0,
                 &prediction_Hz));
        config->prediction_s = 1.0 / prediction_Hz;
    }
    return DIG_OK;
}

static enum dig_status take_all(const struct work *const work, const struct config_text *const text)
{
    struct dig_config *const config   = work->config;
    double                   tick_Hz  = 1.0 / config->tick_s;
    double                   stale_ms = config->stale_s * 1e3;
    TRY(take_path(work, "table", text->table, &config->table));
    TRY(take_path(work, "machine", text->machine, &config->machine));
    if (text->scene != NULL) {
        TRY(take_text(work, "scene", text->scene, sizeof config->scene, config->scene));
    }
    TRY(take(work, "tick_Hz", text->tick_Hz, 100.0, 2000.0, &tick_Hz));
    config->tick_s = 1.0 / tick_Hz;
    TRY(take(work, "stale_ms", text->stale_ms, 1.0, 60e3, &stale_ms));
    config->stale_s = stale_ms * 1e-3;
    TRY(take_input(work, &text->input));
    TRY(take(work, "time_scale", text->time_scale, 0.01, 100.0, &config->time_scale));
    if (text->time_scale != NULL && config->kind == DIG_INPUT_REPLAY) {
        return dig_yaml_refuse(work->path, "time_scale", work->error,
                               "given with a replay, expected input.replay.speed alone");
    }
    if (config->kind == DIG_INPUT_REPLAY) {
        config->time_scale = config->replay_speed;
    }
    TRY(take_estimator(work, text->estimator));
    return take_rest(work, text);
}

static struct dig_config defaults(void)
{
    struct dig_config config = {
        .modbus            = { .baud = 115200, .parity = 'E', .unit = 1 },
        .replay_speed      = 1.0,
        .tick_s            = 1.0 / 200.0,
        .stale_s           = 0.1,
        .time_scale        = 1.0,
        .realtime          = { .priority = 80, .lock_memory = true, .cpu = -1 },
        .lcm_url           = DEFAULT_LCM_URL,
        .estimator         = dig_estimator_settings_default(),
        .match_evaluations = 2000,
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
    enum dig_status status = dig_yaml_load(path, &schema, &data, error);
    if (status != DIG_OK) {
        return status;
    }
    struct dig_config loaded = defaults();
    const struct work work   = { .path = path, .config = &loaded, .error = error };
    status                   = take_all(&work, (const struct config_text *)data);
    dig_yaml_free(&schema, data);
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

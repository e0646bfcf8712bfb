#include "firmware_host/config/config.h"

#include "core/name.h"
#include "files/yaml/yaml.h"
#include "firmware_host/config/config_text.h"

#include <arpa/inet.h>
#include <assert.h>
#include <netinet/in.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define DEFAULT_LCM_URL "udpm://239.255.76.67:7667?ttl=0"

// Where the settings of a kind stand; those of another are passed over.
static const char *const parts[] = {
    [DIG_INPUT_CAN]        = "input.can",
    [DIG_INPUT_MODBUS_TCP] = "input.modbus",
    [DIG_INPUT_MODBUS_RTU] = "input.modbus",
    [DIG_INPUT_REPLAY]     = "input.replay",
};

// A number: what the file may say, and what is kept of it.
struct number {
    const char *key;
    size_t      at; // in struct dig_config
    bool        whole;
    double      least, most; // in the file's unit
    double      factor;      // from there to what is kept; 0: the inverse is kept
};

#define AT(member) offsetof(struct dig_config, member)

static const struct number numbers[] = {
    { "tick_Hz", AT(tick_s), false, 100.0, 2000.0, 0.0 },
    { "stale_ms", AT(stale_s), false, 1.0, 60e3, 1e-3 },
    { "time_scale", AT(time_scale), false, 0.01, 100.0, 1.0 },
    { "input.modbus.poll_Hz", AT(modbus.poll_s), false, 1.0, 1000.0, 0.0 },
    { "input.modbus.baud", AT(modbus.baud), true, 1200, 4000000, 1.0 },
    { "input.modbus.unit", AT(modbus.unit), true, 0, 247, 1.0 },
    { "input.replay.speed", AT(replay_speed), false, 0.01, 100.0, 1.0 },
    { "estimator.sample_s", AT(estimator.tick_s), false, 0.001, 0.1, 1.0 },
    { "estimator.contact_sigmas", AT(estimator.contact_sigmas), false, 1.0, 100.0, 1.0 },
    { "estimator.contact_hold_s", AT(estimator.contact_hold_s), false, 0.0, 10.0, 1.0 },
    { "estimator.exit_hold_s", AT(estimator.exit_hold_s), false, 0.0, 10.0, 1.0 },
    { "estimator.air_bias_s", AT(estimator.air_bias_s), false, 0.0, 1000.0, 1.0 },
    { "estimator.path_limit_m", AT(estimator.path_limit_m), false, 1e-4, 1.0, 1.0 },
    { "estimator.outside_floors", AT(estimator.outside_floors), false, 1.0, 100.0, 1.0 },
    { "realtime.priority", AT(realtime.priority), true, 0, 99, 1.0 },
    { "realtime.cpu", AT(realtime.cpu), true, -1, 1023, 1.0 },
    { "publish.prediction_Hz", AT(prediction_s), false, 0.1, 100.0, 0.0 },
    { "publish.estimate_every", AT(estimate_every), true, 1, 1000, 1.0 },
    { "match.max_evaluations", AT(match_evaluations), true, 1, 1000000, 1.0 },
    { "match.least_path", AT(match_least_path), false, 0.01, 1.0, 1.0 },
    { "match.early_path", AT(match_early_path), false, 0.1, 1.0, 1.0 },
    { "match.expires_h", AT(match_expires_s), false, 0.01, 1000.0, 3600.0 },
    { "match.drift_floors", AT(drift_floors), false, 1.0, 1000.0, 1.0 },
};

static struct dig_config defaults(void)
{
    return (struct dig_config){
        .modbus            = { .baud = 115200, .parity = 'E', .unit = 1, .poll_s = 1.0 / 200.0 },
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
}

// What is being read, into which settings, and what is found wrong with it.
struct work {
    const char                   *path;
    const struct dig_config_text *text;
    struct dig_config            *config;
    struct dig_conditions        *c;
};

static bool is_given(const struct work *const work, const char *const key)
{
    return dig_yaml_line(work->path, key) > 0;
}

static bool is_passed_over(const struct work *const work, const char *const key)
{
    const char *const part = parts[work->config->kind];
    return strncmp(key, "input.", 6) == 0 && strncmp(key, part, strlen(part)) != 0;
}

static void take_numbers(const struct work *const work)
{
    for (size_t i = 0; i < CYAML_ARRAY_LEN(numbers); i++) {
        const struct number *const n     = &numbers[i];
        const void *const          from  = (const char *)&work->text->config + n->at;
        void *const                to    = (char *)work->config + n->at;
        const double               value = n->whole ? *(const int *)from : *(const double *)from;
        if (is_passed_over(work, n->key) || !is_given(work, n->key)) {
            continue;
        }
        dig_require(work->c, value >= n->least && value <= n->most,
                    n->whole ? "%s: %.0f, expected %.0f … %.0f" : "%s: %g, expected %g … %g",
                    n->key, value, n->least, n->most);
        if (n->whole) {
            *(int *)to = (int)value;
        } else {
            *(double *)to = n->factor > 0.0 ? value * n->factor : 1.0 / value;
        }
    }
}

// from: NULL where absent.
static void take_text(const struct work *const work, const char *const key, const char *const from,
                      const size_t size, char to[])
{
    const int length = from != NULL ? snprintf(to, size, "%s", from) : 0;
    dig_require(work->c, length >= 0 && (size_t)length < size,
                "%s: %d characters, expected at most %zu", key, length, size - 1);
}

// Of LCM's own kinds those that publish: a multicast group, or a log file. Of a network that is
// merely not there yet nothing is said: the daemon tries again.
static bool is_lcm_url(const char *const text)
{
    static const char network[] = "udpm://";
    static const char file[]    = "file://";
    char              address[INET_ADDRSTRLEN];
    struct in_addr    group;
    if (strncmp(text, network, strlen(network)) != 0) {
        return strncmp(text, file, strlen(file)) == 0;
    }
    const char *const from   = text + strlen(network);
    const size_t      length = strcspn(from, ":?");
    if (length >= sizeof address) {
        return false;
    }
    memcpy(address, from, length);
    address[length] = '\0';
    return length == 0 ||
           (inet_pton(AF_INET, address, &group) == 1 && IN_MULTICAST(ntohl(group.s_addr)));
}

static void take_texts(const struct work *const work)
{
    const struct dig_config_text *const text   = work->text;
    struct dig_config *const            config = work->config;
    const struct {
        const char           *key, *from;
        struct dig_file_name *to; // relative to the configuration's folder
    } path[] = {
        { "table", text->table, &config->table },
        { "machine", text->machine, &config->machine },
        { "model", text->model, &config->model },
        { "input.can.dbc", text->dbc, &config->dbc },
        { "input.can.map", text->can_map, &config->map },
        { "input.modbus.map", text->modbus_map, &config->map },
        { "input.replay.file", text->replay, &config->replay },
        { "match.state", text->match_state, &config->match_state },
    };
    for (size_t i = 0; i < CYAML_ARRAY_LEN(path); i++) {
        if (path[i].from != NULL && !is_passed_over(work, path[i].key)) {
            dig_require(work->c,
                        dig_path_beside(work->path, path[i].from, sizeof path[i].to->text,
                                        path[i].to->text),
                        "%s: too long a path", path[i].key);
        }
    }
    dig_require(work->c, text->lcm_url == NULL || is_lcm_url(text->lcm_url),
                "lcm.url: \"%.60s\", expected udpm://GROUP:PORT with a multicast group",
                text->lcm_url != NULL ? text->lcm_url : "");
    take_text(work, "scene", text->scene, sizeof config->scene, config->scene);
    take_text(work, "lcm.url", text->lcm_url, sizeof config->lcm_url, config->lcm_url);
}

// "127.0.0.1:1502" or "[::1]:1502"
static void take_address(const struct work *const work, const char *const text,
                         struct dig_modbus_address *const address)
{
    const char *const colon  = strrchr(text, ':');
    const size_t      length = colon != NULL ? (size_t)(colon - text) : 0;
    char             *end    = NULL;
    const long        port   = colon != NULL ? strtol(colon + 1, &end, 10) : 0;
    const bool        is     = length > 0 && length < sizeof address->host && end != NULL &&
                    end != colon + 1 && *end == '\0' && port >= 1 && port <= 65535;
    dig_require(work->c, is, "input.modbus.address: \"%.60s\", expected HOST:PORT", text);
    if (is) {
        const bool brackets = text[0] == '[' && length > 2 && text[length - 1] == ']';
        memcpy(address->host, text + brackets, length - 2 * (size_t)brackets);
        address->host[length - 2 * (size_t)brackets] = '\0';
        address->port                                = (int)port;
    }
}

static void take_parity(const struct work *const work, const char *const text,
                        struct dig_modbus_address *const address)
{
    static const char *const words[] = { "none", "even", "odd" };
    size_t                   i       = 0;
    while (i < CYAML_ARRAY_LEN(words) && strcmp(text, words[i]) != 0) {
        i++;
    }
    dig_require(work->c, i < CYAML_ARRAY_LEN(words),
                "input.modbus.parity: \"%.20s\", expected none, even or odd", text);
    address->parity = "NEO"[i];
}

static void take_server(const struct work *const work)
{
    const struct dig_config_text *const text    = work->text;
    struct dig_modbus_address *const    address = &work->config->modbus;
    const bool                          tcp     = work->config->kind == DIG_INPUT_MODBUS_TCP;
    const char *const                   key = tcp ? "input.modbus.address" : "input.modbus.device";
    const char *const                   at  = tcp ? text->address : text->device;
    dig_require(work->c, at != NULL, "%s: missing, expected %s", key,
                tcp ? "HOST:PORT" : "a serial device");
    if (at != NULL && tcp) {
        take_address(work, at, address);
    } else {
        take_text(work, key, at, sizeof address->device, address->device);
    }
    if (text->parity != NULL) {
        take_parity(work, text->parity, address);
    }
}

static void take_input(const struct work *const work)
{
    struct dig_config *const config   = work->config;
    double                   sample_s = config->modbus.poll_s;
    dig_require(work->c, is_given(work, parts[config->kind]),
                "%s: missing, expected the settings of %s", parts[config->kind],
                dig_config_kinds[config->kind].str);
    switch (config->kind) {
    case DIG_INPUT_CAN:
        sample_s = 0.01; // the cycle of pressures and angles
        take_text(work, "input.can.interface", work->text->interface, sizeof config->can_interface,
                  config->can_interface);
        break;
    case DIG_INPUT_MODBUS_TCP:
    case DIG_INPUT_MODBUS_RTU: take_server(work); break;
    case DIG_INPUT_REPLAY:
        sample_s = 0.005; // what digrig records at
        dig_require(work->c, !is_given(work, "time_scale"),
                    "time_scale: given with a replay, expected input.replay.speed alone");
        config->time_scale = config->replay_speed;
        break;
    }
    if (!is_given(work, "estimator.sample_s")) {
        config->estimator.tick_s = sample_s;
    }
    dig_require(work->c, config->estimator.tick_s <= DIG_TICK_MOST_s,
                "estimator.sample_s: missing, expected with input.modbus.poll_Hz below 10");
}

static void take(const char *const path, cyaml_data_t *const loaded, void *const into,
                 struct dig_conditions *const c)
{
    struct dig_config              config = defaults();
    const struct work              work   = { path, loaded, &config, c };
    const struct dig_config *const given  = &work.text->config;

    config.kind                  = given->kind;
    config.identify_trajectories = given->identify_trajectories;
    memcpy(config.identify_trajectory, given->identify_trajectory,
           sizeof config.identify_trajectory);
    if (is_given(&work, "realtime.lock_memory")) {
        config.realtime.lock_memory = given->realtime.lock_memory;
    }
    take_numbers(&work);
    take_texts(&work);
    take_input(&work);
    if (c->status == DIG_OK) {
        *(struct dig_config *)into = config;
    }
}

enum dig_status dig_config_read(const char *const path, struct dig_config *const config,
                                struct dig_error *const error)
{
    return dig_yaml_read(path, &dig_config_schema, take, config, error);
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

#include "firmware_host/config/config.h"

#include "core/name.h"
#include "files/yaml/yaml.h"

#include <arpa/inet.h>
#include <assert.h>
#include <netinet/in.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define DEFAULT_LCM_URL "udpm://239.255.76.67:7667?ttl=0"

// The settings, beside what they are made of. What is not known before the kind of input is 0.
struct config_text {
    struct dig_config    config;
    struct dig_file_name modbus_map;
    char                 address[256];
    bool                 has_can, has_modbus, has_replay;
};

static const struct dig_yaml_word kinds[] = {
    [DIG_INPUT_CAN]        = { "can", DIG_INPUT_CAN },
    [DIG_INPUT_MODBUS_TCP] = { "modbus-tcp", DIG_INPUT_MODBUS_TCP },
    [DIG_INPUT_MODBUS_RTU] = { "modbus-rtu", DIG_INPUT_MODBUS_RTU },
    [DIG_INPUT_REPLAY]     = { "replay", DIG_INPUT_REPLAY },
    { .word = NULL },
};
static const struct dig_yaml_word parities[] = {
    { "none", 'N' }, { "even", 'E' }, { "odd", 'O' }, { .word = NULL }
};

// A setting: its key, where it goes, the least and the most that the file may say. A time may be
// said as a frequency.
#define OF(kind, key, member, ...) FIELD(kind, key, config_text, config.member, __VA_ARGS__)
#define REAL(key, member, least, most)                                                             \
    OF(NUMBER, key, member, OPTIONAL, .low = (least), .high = (most))
#define IN_UNITS(key, member, least, most, unit)                                                   \
    OF(NUMBER, key, member, OPTIONAL, .low = (least), .high = (most), .factor = (unit))
#define IN_HZ(key, member, least, most) IN_UNITS(key, member, least, most, -1.0)
#define WHOLE(key, member, least, most)                                                            \
    OF(WHOLE, key, member, OPTIONAL, .low = (least), .high = (most))
#define WORDS(key, member, flag) OF(TEXT, key, member, flag, .least = 1)

static const struct dig_yaml_field can_fields[] = {
    WORDS("interface", can_interface, REQUIRED),
    WORDS("dbc", dbc, REQUIRED),
    WORDS("map", map, REQUIRED),
    END,
};

static const struct dig_yaml_field modbus_fields[] = {
    FIELD(TEXT, "address", config_text, address, OPTIONAL, .least = 1),
    WORDS("device", modbus.device, OPTIONAL),
    WHOLE("baud", modbus.baud, 1200, 4000000),
    OF(WORD, "parity", modbus.parity, OPTIONAL, .word = parities),
    WHOLE("unit", modbus.unit, 0, 247),
    FIELD(TEXT, "map", config_text, modbus_map, REQUIRED, .least = 1),
    IN_HZ("poll_Hz", modbus.poll_s, 1.0, 1000.0),
    END,
};

static const struct dig_yaml_field replay_fields[] = {
    WORDS("file", replay, REQUIRED),
    REAL("speed", replay_speed, 0.01, 100.0),
    END,
};

#define KIND(key_, fields_, has)                                                                   \
    {                                                                                              \
        .key = (key_), .kind = DIG_YAML_MAPPING, OPTIONAL, .of = (fields_),                        \
        GIVEN(config_text, has)                                                                    \
    }

static const struct dig_yaml_field input_fields[] = {
    OF(WORD, "kind", kind, REQUIRED, .word = kinds),
    KIND("can", can_fields, has_can),
    KIND("modbus", modbus_fields, has_modbus),
    KIND("replay", replay_fields, has_replay),
    END,
};

static const struct dig_yaml_field realtime_fields[] = {
    WHOLE("priority", realtime.priority, 0, 99),
    WHOLE("cpu", realtime.cpu, -1, 1023),
    OF(BOOL, "lock_memory", realtime.lock_memory, OPTIONAL),
    END,
};

static const struct dig_yaml_field lcm_fields[] = { WORDS("url", lcm_url, OPTIONAL), END };

static const struct dig_yaml_field estimator_fields[] = {
    REAL("sample_s", estimator.tick_s, 0.001, 0.1),
    REAL("contact_sigmas", estimator.contact_sigmas, 1.0, 100.0),
    REAL("contact_hold_s", estimator.contact_hold_s, 0.0, 10.0),
    REAL("exit_hold_s", estimator.exit_hold_s, 0.0, 10.0),
    REAL("air_bias_s", estimator.air_bias_s, 0.0, 1000.0),
    REAL("path_limit_m", estimator.path_limit_m, 1e-4, 1.0),
    REAL("outside_floors", estimator.outside_floors, 1.0, 100.0),
    END,
};

static const struct dig_yaml_field match_fields[] = {
    WHOLE("max_evaluations", match_evaluations, 1, 1000000),
    WORDS("state", match_state, OPTIONAL),
    REAL("least_path", match_least_path, 0.01, 1.0),
    REAL("early_path", match_early_path, 0.1, 1.0),
    IN_UNITS("expires_h", match_expires_s, 0.01, 1000.0, 3600.0),
    REAL("drift_floors", drift_floors, 1.0, 1000.0),
    END,
};

static const struct dig_yaml_field identify_fields[] = {
    LIST("trajectories", REQUIRED, config_text, config.identify_trajectory,
         config.identify_trajectories, &dig_yaml_name, 1),
    END,
};

static const struct dig_yaml_field publish_fields[] = {
    WHOLE("estimate_every", estimate_every, 1, 1000),
    IN_HZ("prediction_Hz", prediction_s, 0.1, 100.0),
    END,
};

static const struct dig_yaml_field fields[] = {
    WORDS("table", table, REQUIRED),
    WORDS("machine", machine, REQUIRED),
    WORDS("scene", scene, OPTIONAL),
    WORDS("model", model, OPTIONAL),
    ACROSS("input", REQUIRED, input_fields),
    IN_HZ("tick_Hz", tick_s, 100.0, 2000.0),
    IN_UNITS("stale_ms", stale_s, 1.0, 60e3, 1e-3),
    REAL("time_scale", time_scale, 0.01, 100.0),
    ACROSS("realtime", OPTIONAL, realtime_fields),
    ACROSS("lcm", OPTIONAL, lcm_fields),
    ACROSS("estimator", OPTIONAL, estimator_fields),
    ACROSS("match", OPTIONAL, match_fields),
    ACROSS("identify", OPTIONAL, identify_fields),
    ACROSS("publish", OPTIONAL, publish_fields),
    END,
};

static struct config_text defaults(void)
{
    struct config_text text = {
        .config = {
            .modbus            = { .baud = 115200, .parity = 'E', .unit = 1, .poll_s = 1.0 / 200.0 },
            .replay_speed      = 1.0,
            .tick_s            = 1.0 / 1000.0,
            .stale_s           = 0.1,
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
        },
    };
    text.config.estimator.tick_s = 0.0;
    return text;
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

// "127.0.0.1:1502" or "[::1]:1502"
static void take_address(const char *const text, struct dig_modbus_address *const address,
                         struct dig_conditions *const c)
{
    const char *const colon  = strrchr(text, ':');
    const size_t      length = colon != NULL ? (size_t)(colon - text) : 0;
    char             *end    = NULL;
    const long        port   = colon != NULL ? strtol(colon + 1, &end, 10) : 0;
    const bool        is     = length > 0 && length < sizeof address->host && end != NULL &&
                    end != colon + 1 && *end == '\0' && port >= 1 && port <= 65535;
    dig_require(c, is, "input.modbus.address: \"%.60s\", expected HOST:PORT", text);
    if (is) {
        const bool brackets = text[0] == '[' && length > 2 && text[length - 1] == ']';
        memcpy(address->host, text + brackets, length - 2 * (size_t)brackets);
        address->host[length - 2 * (size_t)brackets] = '\0';
        address->port                                = (int)port;
    }
}

// Takes the settings of the kind of input; those of another stay unused. Returns the time between
// two samples.
static double take_input(struct config_text *const text, struct dig_conditions *const c)
{
    struct dig_config *const config = &text->config;
    const char *const        kind   = kinds[config->kind].word;
    switch (config->kind) {
    case DIG_INPUT_CAN:
        dig_require(c, text->has_can, "input.can: missing, expected the settings of %s", kind);
        return 0.01; // the cycle of pressures and angles
    case DIG_INPUT_MODBUS_TCP:
    case DIG_INPUT_MODBUS_RTU:
        dig_require(c, text->has_modbus, "input.modbus: missing, expected the settings of %s",
                    kind);
        config->map = text->modbus_map;
        break;
    case DIG_INPUT_REPLAY:
        dig_require(c, text->has_replay, "input.replay: missing, expected the settings of %s",
                    kind);
        dig_require(c, !(config->time_scale > 0.0),
                    "time_scale: given with a replay, expected input.replay.speed alone");
        config->time_scale = config->replay_speed;
        return 0.005; // what digrig records at
    }
    if (config->kind == DIG_INPUT_MODBUS_RTU) {
        dig_require(c, config->modbus.device[0] != '\0',
                    "input.modbus.device: missing, expected a serial device");
    } else if (text->address[0] == '\0') {
        dig_require(c, false, "input.modbus.address: missing, expected HOST:PORT");
    } else {
        take_address(text->address, &config->modbus, c);
    }
    return config->modbus.poll_s;
}

static void take(const char *const path, void *const loaded, struct dig_conditions *const c)
{
    struct config_text *const text     = loaded;
    struct dig_config *const  config   = &text->config;
    const double              sample_s = take_input(text, c);
    const struct {
        const char           *key;
        struct dig_file_name *file;
    } files[] = {
        { "table", &config->table },
        { "machine", &config->machine },
        { "model", &config->model },
        { "input.can.dbc", &config->dbc },
        { config->kind == DIG_INPUT_CAN ? "input.can.map" : "input.modbus.map", &config->map },
        { "input.replay.file", &config->replay },
        { "match.state", &config->match_state },
    };
    for (size_t i = 0; i < sizeof files / sizeof files[0]; i++) {
        const struct dig_file_name name = *files[i].file;
        dig_require(c,
                    name.text[0] == '\0' ||
                        dig_path_beside(path, name.text, sizeof name.text, files[i].file->text),
                    "%s: too long a path", files[i].key);
    }
    dig_require(c, is_lcm_url(config->lcm_url),
                "lcm.url: \"%.60s\", expected udpm://GROUP:PORT with a multicast group",
                config->lcm_url);
    if (!(config->time_scale > 0.0)) {
        config->time_scale = 1.0;
    }
    if (!(config->estimator.tick_s > 0.0)) {
        config->estimator.tick_s = sample_s;
    }
    dig_require(c, config->estimator.tick_s <= DIG_TICK_MOST_s,
                "estimator.sample_s: missing, expected with input.modbus.poll_Hz below 10");
}

enum dig_status dig_config_read(const char *const path, struct dig_config *const config,
                                struct dig_error *const error)
{
    const struct config_text   start  = defaults();
    const struct dig_yaml_file schema = {
        .of = fields, .size = sizeof start, .kept = sizeof(struct dig_config), .defaults = &start
    };
    return dig_yaml_read(path, &schema, take, config, error);
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

// The configuration's part `input`, and the checks that all parts use.

#include "firmware_host/config/config_parts.h"

#include "core/name.h"
#include "files/yaml/yaml.h"

#include <assert.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum dig_status dig_config_take_numbers(const struct dig_config_work *const work,
                                        const size_t count, const struct dig_config_number number[])
{
    for (size_t i = 0; i < count; i++) {
        const struct dig_config_number *const n = &number[i];
        if (n->from == NULL) {
            continue;
        }
        if (!(*n->from >= n->least && *n->from <= n->most)) {
            return dig_yaml_refuse(work->path, work->error, "%s: %g, expected %g … %g", n->key,
                                   *n->from, n->least, n->most);
        }
        *n->to = *n->from;
    }
    return DIG_OK;
}

enum dig_status dig_config_take_wholes(const struct dig_config_work *const work, const size_t count,
                                       const struct dig_config_whole whole[])
{
    for (size_t i = 0; i < count; i++) {
        const struct dig_config_whole *const n = &whole[i];
        if (n->from == NULL) {
            continue;
        }
        if (*n->from < n->least || *n->from > n->most) {
            return dig_yaml_refuse(work->path, work->error, "%s: %d, expected %d … %d", n->key,
                                   *n->from, n->least, n->most);
        }
        *n->to = *n->from;
    }
    return DIG_OK;
}

enum dig_status dig_config_take_text(const struct dig_config_work *const work,
                                     const char *const key, const char *const from,
                                     const size_t size, char to[])
{
    const int length = snprintf(to, size, "%s", from);
    if (length < 0 || (size_t)length >= size) {
        return dig_yaml_refuse(work->path, work->error, "%s: %d characters, expected at most %zu",
                               key, length, size - 1);
    }
    return DIG_OK;
}

enum dig_status dig_config_take_path(const struct dig_config_work *const work,
                                     const char *const key, const char *const from,
                                     struct dig_file_name *const to)
{
    return dig_path_beside(work->path, from, sizeof to->text, to->text)
               ? DIG_OK
               : dig_yaml_refuse(work->path, work->error, "%s: too long a path", key);
}

// "127.0.0.1:1502" or "[::1]:1502"
static enum dig_status take_address(const struct dig_config_work *const work,
                                    const char *const                   text,
                                    struct dig_modbus_address *const    address)
{
    const char *const colon  = strrchr(text, ':');
    const size_t      length = colon != NULL ? (size_t)(colon - text) : 0;
    char             *end    = NULL;
    const long        port   = colon != NULL ? strtol(colon + 1, &end, 10) : 0;
    if (length == 0 || length >= sizeof address->host || end == colon + 1 || *end != '\0' ||
        port < 1 || port > 65535) {
        return dig_yaml_refuse(work->path, work->error,
                               "input.modbus.address: \"%.60s\", expected HOST:PORT", text);
    }
    const bool brackets = text[0] == '[' && length > 2 && text[length - 1] == ']';
    memcpy(address->host, text + brackets, length - 2 * (size_t)brackets);
    address->host[length - 2 * (size_t)brackets] = '\0';
    address->port                                = (int)port;
    return DIG_OK;
}

static enum dig_status take_parity(const struct dig_config_work *const work, const char *const text,
                                   struct dig_modbus_address *const address)
{
    static const char *const words[]   = { "none", "even", "odd" };
    static const char        letters[] = { 'N', 'E', 'O' };
    for (size_t i = 0; text != NULL && i < sizeof letters; i++) {
        if (strcmp(text, words[i]) == 0) {
            address->parity = letters[i];
            return DIG_OK;
        }
    }
    return text == NULL
               ? DIG_OK
               : dig_yaml_refuse(work->path, work->error,
                                 "input.modbus.parity: \"%.20s\", expected none, even or odd",
                                 text);
}

static enum dig_status take_server(const struct dig_config_work *const work,
                                   const struct dig_modbus_text *const text)
{
    struct dig_modbus_address *const address = &work->config->modbus;
    const bool                       tcp     = work->config->kind == DIG_INPUT_MODBUS_TCP;
    const char *const                key     = tcp ? "input.modbus.address" : "input.modbus.device";
    if ((tcp ? text->address : text->device) == NULL) {
        return dig_yaml_refuse(work->path, work->error, "%s: missing, expected %s", key,
                               tcp ? "HOST:PORT" : "a serial device");
    }
    return tcp ? take_address(work, text->address, address)
               : dig_config_take_text(work, key, text->device, sizeof address->device,
                                      address->device);
}

static enum dig_status take_modbus(const struct dig_config_work *const work,
                                   const struct dig_modbus_text *const text)
{
    struct dig_config *const         config   = work->config;
    struct dig_modbus_address *const address  = &config->modbus;
    double                           poll_Hz  = 200.0;
    const struct dig_config_number   number[] = {
          { "input.modbus.poll_Hz", text->poll_Hz, 1.0, 1000.0, &poll_Hz },
    };
    const struct dig_config_whole whole[] = {
        { "input.modbus.baud", text->baud, 1200, 4000000, &address->baud },
        { "input.modbus.unit", text->unit, 0, 247, &address->unit },
    };
    enum dig_status status = take_server(work, text);
    status =
        status == DIG_OK ? dig_config_take_numbers(work, CYAML_ARRAY_LEN(number), number) : status;
    status =
        status == DIG_OK ? dig_config_take_wholes(work, CYAML_ARRAY_LEN(whole), whole) : status;
    status = status == DIG_OK ? take_parity(work, text->parity, address) : status;
    status = status == DIG_OK
                 ? dig_config_take_path(work, "input.modbus.map", text->map, &config->map)
                 : status;

    address->poll_s          = 1.0 / poll_Hz;
    config->estimator.tick_s = 1.0 / poll_Hz;
    return status;
}

static enum dig_status take_can(const struct dig_config_work *const work,
                                const struct dig_can_text *const    text)
{
    struct dig_config *const config = work->config;
    config->estimator.tick_s        = 0.01; // the cycle of pressures and angles
    enum dig_status status =
        dig_config_take_text(work, "input.can.interface", text->interface,
                             sizeof config->can_interface, config->can_interface);
    status = status == DIG_OK ? dig_config_take_path(work, "input.can.dbc", text->dbc, &config->dbc)
                              : status;
    return status == DIG_OK ? dig_config_take_path(work, "input.can.map", text->map, &config->map)
                            : status;
}

static enum dig_status take_replay(const struct dig_config_work *const work,
                                   const struct dig_replay_text *const text)
{
    struct dig_config *const       config   = work->config;
    const struct dig_config_number number[] = {
        { "input.replay.speed", text->speed, 0.01, 100.0, &config->replay_speed },
    };
    const enum dig_status status = dig_config_take_numbers(work, CYAML_ARRAY_LEN(number), number);
    config->time_scale           = config->replay_speed;
    config->estimator.tick_s     = 0.005; // what digrig records at
    return status == DIG_OK
               ? dig_config_take_path(work, "input.replay.file", text->file, &config->replay)
               : status;
}

static enum dig_status refuse_absent(const struct dig_config_work *const work,
                                     const char *const                   key)
{
    return dig_yaml_refuse(work->path, work->error, "%s: missing, expected the settings of %s", key,
                           dig_input_kind_name(work->config->kind));
}

enum dig_status dig_config_take_input(const struct dig_config_work *const work,
                                      const struct dig_input_text *const  text)
{
    work->config->kind = text->kind;
    switch (text->kind) {
    case DIG_INPUT_CAN:
        return text->can != NULL ? take_can(work, text->can) : refuse_absent(work, "input.can");
    case DIG_INPUT_REPLAY:
        return text->replay != NULL ? take_replay(work, text->replay)
                                    : refuse_absent(work, "input.replay");
    case DIG_INPUT_MODBUS_TCP:
    case DIG_INPUT_MODBUS_RTU: break;
    }
    return text->modbus != NULL ? take_modbus(work, text->modbus)
                                : refuse_absent(work, "input.modbus");
}

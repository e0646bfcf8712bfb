// YAML to configuration: the first byte says which reader gets the rest.

#include "files/curve_map_yaml.h"
#include "files/grid_yaml.h"
#include "files/machine_yaml.h"
#include "files/scene_yaml.h"
#include "firmware_host/bus/dbc.h"
#include "firmware_host/bus/signal_map.h"
#include "firmware_host/config/config.h"
#include "tests/fuzz/as_file.h"

static enum dig_status read_can_map(const char *const path, struct dig_error *const error)
{
    static struct dig_dbc        dbc;
    static struct dig_signal_map map;
    if (dbc.messages == 0 && dig_dbc_read("config/can/zx200.dbc", &dbc, NULL) != DIG_OK) {
        exit(2);
    }
    return dig_signal_map_read(path, &dbc, &map, error);
}

static enum dig_status read_as(const uint8_t kind, const char *const path,
                               struct dig_error *const error)
{
    static union {
        struct dig_config     config;
        struct dig_scene      scene;
        struct dig_grid       grid;
        struct dig_machine    machine;
        struct dig_signal_map map;
        struct dig_curve_map  curves;
    } to;
    switch (kind) {
    case 'c': return dig_config_read(path, &to.config, error);
    case 's': return dig_scene_read(path, &to.scene, error);
    case 'g': return dig_grid_read(path, &to.grid, error);
    case 'm': return dig_machine_read(path, &to.machine, error);
    case 'r': return dig_signal_map_read(path, NULL, &to.map, error);
    case 'a': return read_can_map(path, error);
    case 'f': return dig_curve_map_read(path, &to.curves, error);
    default: return DIG_OK;
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *const data, const size_t size)
{
    if (size > 0) {
        struct dig_error error = { "" };
        expect_word(read_as(data[0], as_file(data + 1, size - 1), &error), &error);
    }
    return 0;
}

#include "tools/rig/options.h"

#include "core/command_line.h"

#include <getopt.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    OPT_MACHINE = 256,
    OPT_TOOTH,
    OPT_SCENE,
    OPT_PIN,
    OPT_SEED,
    OPT_NOISE,
    OPT_NO_NOISE,
    OPT_QUASI_STATIC,
    OPT_NO_BLEND,
    OPT_NO_AIR,
    OPT_RATE,
    OPT_TRUTH,
    OPT_NO_QUANTISATION,
    OPT_EXACT,
    OPT_CAN,
    OPT_SEALED,
    OPT_TCP,
    OPT_RTU,
    OPT_SPEED,
    OPT_DELAY,
    OPT_LOOP,
    OPT_FAULT,
    OPT_JSON
};

static const struct dig_command commands[] = {
    { "record", "RECORDING... --machine M.yaml -o OUT.csv [OPTION]...",
      "Writes what the machine's sensors read during recorded digs to a file.",
      "RECORDING is a force recording, or one campaign folder.",
      "digrig record simpleA.csv actual.csv -o run.csv \\\n"
      "       --machine config/machines/zx200_trench.yaml\n" },
    { "air", "--machine M.yaml -o OUT.csv [OPTION]...",
      "Writes what the machine's sensors read while every joint is moved in free air.",
      "About a minute: boom, arm and bucket one after the other, then all three. `digloop check` "
      "says what a machine file makes of such a recording.",
      "digrig air --machine config/machines/zx120.yaml -o air.csv\n" },
    { "serve", "RECORDING... --machine M.yaml BUS... [OPTION]...",
      "Serves what the machine's sensors read during recorded digs on real buses.",
      "RECORDING is a force recording, or one campaign folder. BUS is --can, --modbus-tcp or "
      "--modbus-rtu.",
      "digrig serve simpleA.csv --machine config/machines/zx200_trench.yaml \\\n"
      "       --modbus-tcp 127.0.0.1:1502 --speed 2\n"
      "digrig serve simpleA.csv --machine config/machines/zx200_trench.yaml \\\n"
      "       --can vcan0 --fault frozen@5:2\n" },
};

static const struct dig_option known[] = {
    { "machine", OPT_MACHINE, "M.yaml", NULL, "the machine (config/machines)" },
    { "output", 'o', "OUT.csv", " record air ", "machine recording to write" },
    { "can", OPT_CAN, "IFACE", " serve ", "CAN frames in the ZX200 layout" },
    { "modbus-tcp", OPT_TCP, "HOST:PORT", " serve ",
      "Modbus TCP server (port 0: any free one, told on stderr)" },
    { "modbus-rtu", OPT_RTU, "DEV[:BAUD]", " serve ",
      "Modbus RTU slave 1 (default 115200 baud, 8N1)" },
    { "can-sealed", OPT_SEALED, NULL, " serve ",
      "pressures and angles carry a counter and a checksum" },
    { "speed", OPT_SPEED, "F", " serve ", "times real time (default 1)" },
    { "start-delay", OPT_DELAY, "S", " serve ",
      "stand still so many seconds first, with the bus alive" },
    { "loop", OPT_LOOP, NULL, " serve ", "start again at the end, until SIGTERM" },
    { "fault", OPT_FAULT, "KIND[=N]@T[:DURATION]", " serve ",
      "what goes wrong at T seconds of machine time (may be given again): not-available, nan, "
      "frozen, missing, out-of-range, stuck-pressures, stuck-angles, far, far-silent; drop, "
      "duplicate, reorder, corrupt, exception for a share N; delay, slow by N seconds" },
    { "json", OPT_JSON, NULL, " serve ",
      "what was sent and asked for, as JSON on stdout at the end" },
    { "quiet", 'q', NULL, NULL, "no progress, only what goes wrong" },
    { "rate", OPT_RATE, "HZ", " record air ",
      "samples per second, a divisor of 1000 from 50 up (default 200)" },
    { "truth", OPT_TRUTH, "TRUTH.csv", " record air ",
      "also write the true pose and wrench of the bucket pin" },
    { "no-quantisation", OPT_NO_QUANTISATION, NULL, " record air ",
      "numbers as they are, not in steps of the machine's bus" },
    { "exact", OPT_EXACT, NULL, " record air ", "--no-noise --no-quantisation" },
    { "tooth-m", OPT_TOOTH, "L", " record serve ",
      "pin to tooth of the recordings' bucket (default 0.09, the rig)" },
    { "scene", OPT_SCENE, "SCENE.yaml", " record serve ",
      "take that from a scene instead (a campaign names its own)" },
    { "pin-start", OPT_PIN, "X,Z", " record serve ",
      "bucket pin at the first contact, from the boom foot (default: the place that leaves the "
      "machine most room)" },
    { "seed", OPT_SEED, "N", NULL, "of the sensors' noise (default 1)" },
    { "no-noise", OPT_NO_NOISE, NULL, NULL, "sensors without noise" },
    { "noise", OPT_NOISE, "0|1", NULL, "0: as --no-noise" },
    { "quasi-static", OPT_QUASI_STATIC, NULL, NULL, "leave the inertia of the links out" },
    { "no-blend", OPT_NO_BLEND, NULL, " record serve ",
      "keep the velocity jumps of the recording" },
    { "no-air", OPT_NO_AIR, NULL, " record serve ",
      "the dig alone, without motion before and after" },
};

const struct dig_program *dig_rig_program(void)
{
    static const struct dig_program program = {
        .self = { "digrig", "COMMAND [RECORDING...] --machine M.yaml [OPTION]...\nCOMMAND --help",
                  "Simulates the sensors of a machine that digs as was recorded.",
                  "Recorded digs become the joint angles and cylinder pressures of a machine, "
                  "or what a force sensor that carries the bucket reads (not on CAN). Several "
                  "recordings are dug one after the other.",
                  "digrig record simpleA.csv actual.csv -o run.csv \\\n"
                  "       --machine config/machines/zx200_trench.yaml\n"
                  "digrig serve simpleA.csv --modbus-tcp 127.0.0.1:1502 \\\n"
                  "       --machine config/machines/zx200_trench.yaml\n" },
        .exit_status = "0  done\n1  the work failed\n"
                       "2  bad usage, bad input or a dig the machine cannot do\n",
        .commands    = sizeof commands / sizeof commands[0],
        .command     = commands,
        .options     = sizeof known / sizeof known[0],
        .option      = known,
    };
    return &program;
}

static enum dig_status number(const char *const name, const char *const text, const double low,
                              const double high, double *const value, struct dig_error *const error)
{
    return dig_number_read(text, low, high, value)
               ? DIG_OK
               : dig_error_set(error, DIG_EINVAL, "--%s: \"%s\", expected a number from %g to %g",
                               name, text, low, high);
}

static enum dig_status pin_start(const char *const text, struct dig_rig_track_options *const track,
                                 struct dig_error *const error)
{
    char        *end = NULL;
    const double X_m = strtod(text, &end);
    if (end != text && *end == ',') {
        const char *const rest = end + 1;
        const double      Z_m  = strtod(rest, &end);
        if (end != rest && *end == '\0' && isfinite(X_m) && isfinite(Z_m)) {
            track->placed  = true;
            track->pin_X_m = X_m;
            track->pin_Z_m = Z_m;
            return DIG_OK;
        }
    }
    return dig_error_set(error, DIG_EINVAL, "--pin-start: \"%s\", expected X,Z in metres", text);
}

static enum dig_status seed(const char *const text, uint64_t *const value,
                            struct dig_error *const error)
{
    char                    *end   = NULL;
    const unsigned long long found = strtoull(text, &end, 10);
    if (end == text || *end != '\0' || text[0] == '-') {
        return dig_error_set(error, DIG_EINVAL, "--seed: \"%s\", expected a whole number", text);
    }
    *value = found;
    return DIG_OK;
}

// One option into *options. Flags and strings cannot fail.
static enum dig_status take(const int option, struct dig_rig_options *const options,
                            struct dig_error *const error)
{
    double flag = 0.0;
    switch (option) {
    case 'q': options->quiet = true; break;
    case 'o': options->out = optarg; break;
    case OPT_MACHINE: options->machine = optarg; break;
    case OPT_SCENE: options->scene = optarg; break;
    case OPT_TRUTH: options->truth = optarg; break;
    case OPT_SEALED: options->can_sealed = true; break;
    case OPT_CAN: options->can = optarg; break;
    case OPT_TCP: options->tcp = optarg; break;
    case OPT_RTU: options->rtu = optarg; break;
    case OPT_NO_NOISE: options->noise = false; break;
    case OPT_QUASI_STATIC: options->track.quasi_static = true; break;
    case OPT_NO_BLEND: options->track.blend = false; break;
    case OPT_NO_AIR: options->track.air = false; break;
    case OPT_NO_QUANTISATION: options->quantise = false; break;
    case OPT_EXACT: options->noise = options->quantise = false; break;
    case OPT_LOOP: options->loop = true; break;
    case OPT_JSON: options->json = true; break;
    case OPT_PIN: return pin_start(optarg, &options->track, error);
    case OPT_SEED: return seed(optarg, &options->seed, error);
    case OPT_TOOTH:
        options->tooth_given = true;
        return number("tooth-m", optarg, 1e-3, 10.0, &options->track.scene_tooth_m, error);
    case OPT_RATE: return number("rate", optarg, 50.0, 1000.0, &options->track.rate_Hz, error);
    case OPT_SPEED: return number("speed", optarg, 0.01, 100.0, &options->speed, error);
    case OPT_DELAY:
        return number("start-delay", optarg, 0.0, 3600.0, &options->start_delay_s, error);
    case OPT_NOISE:
        if (number("noise", optarg, 0.0, 1.0, &flag, error) != DIG_OK) {
            return DIG_EINVAL;
        }
        options->noise = flag > 0.5;
        break;
    case OPT_FAULT:
        if (options->faults == DIG_RIG_FAULTS_MAX) {
            return dig_error_set(error, DIG_EINVAL, "--fault: more than %d", DIG_RIG_FAULTS_MAX);
        }
        return dig_rig_fault_parse(optarg, &options->fault[options->faults++], error);
    default: return DIG_EINVAL; // said already
    }
    return DIG_OK;
}

static enum dig_status check(const struct dig_rig_options *const options,
                             struct dig_error *const             error)
{
    if (options->command == DIG_RIG_COMMAND_AIR && options->inputs > 0) {
        return dig_error_set(error, DIG_EINVAL, "%s: air takes no recording", options->input[0]);
    }
    if (options->command != DIG_RIG_COMMAND_AIR && options->inputs == 0) {
        return dig_error_set(error, DIG_EINVAL, "no recording given");
    }
    if (options->machine == NULL) {
        return dig_error_set(error, DIG_EINVAL, "--machine: missing, expected a machine YAML");
    }
    if (options->command != DIG_RIG_COMMAND_SERVE && options->out == NULL) {
        return dig_error_set(error, DIG_EINVAL, "-o: missing, expected the file to write");
    }
    if (options->command == DIG_RIG_COMMAND_SERVE && options->can == NULL && options->tcp == NULL &&
        options->rtu == NULL) {
        return dig_error_set(error, DIG_EINVAL,
                             "no bus: expected --can, --modbus-tcp or --modbus-rtu");
    }
    return DIG_OK;
}

enum dig_status dig_rig_options_parse(const int argc, char *argv[],
                                      struct dig_rig_options *const options,
                                      struct dig_error *const       error)
{
    struct dig_rig_options result = {
        .command  = DIG_RIG_COMMAND_HELP,
        .track    = dig_rig_track_options_default(),
        .seed     = 1,
        .noise    = true,
        .quantise = true,
        .speed    = 1.0,
    };
    const struct dig_command *const command = dig_command_find(dig_rig_program(), argv[1], error);
    if (command == NULL) {
        return DIG_EINVAL;
    }
    result.help_of = command;
    optind         = 0;
    for (int option; (option = dig_option_next(dig_rig_program(), command, argc, argv, error)) !=
                     DIG_OPTION_END;) {
        if (option == DIG_OPTION_HELP || option == DIG_OPTION_VERSION) {
            result.command =
                option == DIG_OPTION_HELP ? DIG_RIG_COMMAND_HELP : DIG_RIG_COMMAND_VERSION;
            *options = result;
            return DIG_OK;
        }
        const enum dig_status status = take(option, &result, error);
        if (status != DIG_OK) {
            return status;
        }
    }
    result.command = command->name[0] == 'r'   ? DIG_RIG_COMMAND_RECORD
                     : command->name[0] == 'a' ? DIG_RIG_COMMAND_AIR
                                               : DIG_RIG_COMMAND_SERVE;
    for (int i = optind; i < argc; i++) {
        if (result.inputs == DIG_RIG_INPUTS_MAX) {
            return dig_error_set(error, DIG_EINVAL, "more than %d recordings", DIG_RIG_INPUTS_MAX);
        }
        result.input[result.inputs++] = argv[i];
    }
    const enum dig_status status = check(&result, error);
    if (status == DIG_OK) {
        *options = result;
    }
    return status;
}

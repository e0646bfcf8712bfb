#include "tools/rig/options.h"

#include <getopt.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define USAGE_RECORD                                                                               \
    "  digrig record RECORDING.csv...|CAMPAIGN/ --machine M.yaml -o OUT.csv [options]\n"
#define USAGE_SERVE "  digrig serve RECORDING.csv...|CAMPAIGN/ --machine M.yaml BUS... [options]\n"

#define INTRO                                                                                      \
    "\n"                                                                                           \
    "Turns recorded digs into the joint angles and cylinder pressures of a machine, or what a\n"   \
    "force sensor that carries the bucket reads (not on CAN), and writes them to a file or\n"      \
    "serves them on real buses. Several recordings are dug one after the other.\n"                 \
    "\n"

#define OPTIONS                                                                                    \
    "  --machine M.yaml          the machine (config/machines)\n"                                  \
    "  --tooth-m L               pin to tooth of the recordings' bucket (default 0.09, the rig)\n" \
    "  --scene SCENE.yaml        take that from a scene instead (a campaign names its own)\n"      \
    "  --pin-start X,Z           bucket pin at the first contact, from the boom foot (default:\n"  \
    "                            the place that leaves the machine most room)\n"                   \
    "  --seed N                  of the sensors' noise (default 1)\n"                              \
    "  --no-noise                sensors without noise (--noise 0 too)\n"                          \
    "  --quasi-static            leave the inertia of the links out\n"                             \
    "  --no-blend                keep the velocity jumps of the recording\n"                       \
    "  --no-air                  the dig alone, without motion before and after\n"

#define OPTIONS_RECORD                                                                             \
    "record:\n"                                                                                    \
    "  -o OUT.csv                machine recording to write\n"                                     \
    "  --rate HZ                 samples per second, a divisor of 1000 from 50 up (default 200)\n" \
    "  --truth TRUTH.csv         also write the true pose and wrench of the bucket pin\n"          \
    "  --no-quantisation         numbers as they are, not in steps of the machine's bus\n"         \
    "  --exact                   --no-noise --no-quantisation\n"

#define OPTIONS_SERVE                                                                              \
    "serve, one or more buses:\n"                                                                  \
    "  --can IFACE               CAN frames in the ZX200 layout\n"                                 \
    "  --modbus-tcp HOST:PORT    Modbus TCP server (port 0: any free one, told on stderr)\n"       \
    "  --can-sealed              pressures and angles carry a counter and a checksum\n"            \
    "  --modbus-rtu DEV[:BAUD]   Modbus RTU slave 1 (default 115200 baud, 8N1)\n"                  \
    "  --speed F                 times real time (default 1)\n"                                    \
    "  --start-delay S           stand still so many seconds first, with the bus alive\n"          \
    "  --loop                    start again at the end, until SIGTERM\n"                          \
    "  --fault KIND[=N]@T[:DURATION]  what goes wrong at T seconds of machine time (may be\n"      \
    "                            given again): not-available, nan, frozen, missing,\n"             \
    "                            out-of-range, stuck-pressures, stuck-angles, far, far-silent;\n"  \
    "                            drop, duplicate, reorder, corrupt, exception for a share N;\n"    \
    "                            delay, slow by N seconds\n"                                       \
    "  --json                    what was sent and asked for, as JSON on stdout at the end\n"

#define EXAMPLES_RECORD                                                                            \
    "  digrig record simpleA.csv actual.csv --machine config/machines/zx200_trench.yaml \\\n"      \
    "         -o run.csv\n"
#define EXAMPLES_SERVE                                                                             \
    "  digrig serve simpleA.csv --machine config/machines/zx200_trench.yaml \\\n"                  \
    "         --modbus-tcp 127.0.0.1:1502 --speed 2\n"                                             \
    "  digrig serve simpleA.csv --machine config/machines/zx200_trench.yaml --can vcan0 \\\n"      \
    "         --fault frozen@5:2\n"

#define EXIT_STATUS                                                                                \
    "\nexit status: 0 done, 1 the work failed, 2 bad usage, bad input or a dig the machine\n"      \
    "cannot do\n"

const char *dig_rig_options_help(const enum dig_rig_command command)
{
    switch (command) {
    case DIG_RIG_COMMAND_RECORD:
        return "usage:\n" USAGE_RECORD "\n" OPTIONS OPTIONS_RECORD
               "\nexamples:\n" EXAMPLES_RECORD      EXIT_STATUS;
    case DIG_RIG_COMMAND_SERVE:
        return "usage:\n" USAGE_SERVE "\n" OPTIONS OPTIONS_SERVE
               "\nexamples:\n" EXAMPLES_SERVE      EXIT_STATUS;
    case DIG_RIG_COMMAND_HELP:
    case DIG_RIG_COMMAND_VERSION: break;
    }
    return "usage:\n" USAGE_RECORD USAGE_SERVE INTRO OPTIONS OPTIONS_RECORD OPTIONS_SERVE
           "\nexamples:\n" EXAMPLES_RECORD EXAMPLES_SERVE                   EXIT_STATUS;
}

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
    OPT_JSON,
    OPT_VERSION
};

static const struct option long_options[] = {
    { "machine", required_argument, NULL, OPT_MACHINE },
    { "tooth-m", required_argument, NULL, OPT_TOOTH },
    { "scene", required_argument, NULL, OPT_SCENE },
    { "pin-start", required_argument, NULL, OPT_PIN },
    { "seed", required_argument, NULL, OPT_SEED },
    { "noise", required_argument, NULL, OPT_NOISE },
    { "no-noise", no_argument, NULL, OPT_NO_NOISE },
    { "quasi-static", no_argument, NULL, OPT_QUASI_STATIC },
    { "no-blend", no_argument, NULL, OPT_NO_BLEND },
    { "no-air", no_argument, NULL, OPT_NO_AIR },
    { "rate", required_argument, NULL, OPT_RATE },
    { "truth", required_argument, NULL, OPT_TRUTH },
    { "no-quantisation", no_argument, NULL, OPT_NO_QUANTISATION },
    { "exact", no_argument, NULL, OPT_EXACT },
    { "can", required_argument, NULL, OPT_CAN },
    { "can-sealed", no_argument, NULL, OPT_SEALED },
    { "modbus-tcp", required_argument, NULL, OPT_TCP },
    { "modbus-rtu", required_argument, NULL, OPT_RTU },
    { "speed", required_argument, NULL, OPT_SPEED },
    { "start-delay", required_argument, NULL, OPT_DELAY },
    { "loop", no_argument, NULL, OPT_LOOP },
    { "fault", required_argument, NULL, OPT_FAULT },
    { "json", no_argument, NULL, OPT_JSON },
    { "help", no_argument, NULL, 'h' },
    { "version", no_argument, NULL, OPT_VERSION },
    { NULL, 0, NULL, 0 },
};

static enum dig_status number(const char *const name, const char *const text, const double low,
                              const double high, double *const value, struct dig_error *const error)
{
    char        *end   = NULL;
    const double found = strtod(text, &end);
    if (end == text || *end != '\0' || !(found >= low && found <= high)) {
        return dig_error_set(error, DIG_EINVAL, "--%s: \"%s\", expected a number from %g to %g",
                             name, text, low, high);
    }
    *value = found;
    return DIG_OK;
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
    case 'h':
        options->help_of = options->command;
        options->command = DIG_RIG_COMMAND_HELP;
        break;
    case OPT_VERSION: options->command = DIG_RIG_COMMAND_VERSION; break;
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
    default: return dig_error_set(error, DIG_EINVAL, "unknown option or missing value");
    }
    return DIG_OK;
}

static enum dig_status check(const struct dig_rig_options *const options,
                             struct dig_error *const             error)
{
    if (options->inputs == 0) {
        return dig_error_set(error, DIG_EINVAL, "no recording given");
    }
    if (options->machine == NULL) {
        return dig_error_set(error, DIG_EINVAL, "--machine: missing, expected a machine YAML");
    }
    const bool bus = options->can != NULL || options->tcp != NULL || options->rtu != NULL;
    if (options->command == DIG_RIG_COMMAND_RECORD && options->out == NULL) {
        return dig_error_set(error, DIG_EINVAL, "-o: missing, expected the file to write");
    }
    if (options->command == DIG_RIG_COMMAND_RECORD && bus) {
        return dig_error_set(error, DIG_EINVAL, "record writes a file; a bus belongs to serve");
    }
    if (options->command == DIG_RIG_COMMAND_SERVE && !bus) {
        return dig_error_set(error, DIG_EINVAL,
                             "no bus: expected --can, --modbus-tcp or --modbus-rtu");
    }
    if (options->command == DIG_RIG_COMMAND_SERVE && (options->out || options->truth)) {
        return dig_error_set(error, DIG_EINVAL,
                             "serve writes no file; -o and --truth belong to "
                             "record");
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
    if (argc < 2) {
        return dig_error_set(error, DIG_EINVAL, "expected record or serve");
    }
    int first = 1;
    if (strcmp(argv[1], "record") == 0 || strcmp(argv[1], "serve") == 0) {
        result.command = argv[1][0] == 'r' ? DIG_RIG_COMMAND_RECORD : DIG_RIG_COMMAND_SERVE;
        first          = 2;
    } else if (argv[1][0] != '-') {
        return dig_error_set(error, DIG_EINVAL, "\"%s\": expected record or serve", argv[1]);
    }

    opterr     = 0;
    optind     = first;
    int option = 0;
    while ((option = getopt_long(argc, argv, "ho:", long_options, NULL)) != -1) {
        if (option == '?') {
            return dig_error_set(error, DIG_EINVAL, "%s: unknown option, or its value is missing",
                                 argv[optind - 1]);
        }
        const enum dig_status status = take(option, &result, error);
        if (status != DIG_OK) {
            return status;
        }
        if (option == 'h' || option == OPT_VERSION) {
            *options = result;
            return DIG_OK;
        }
    }
    for (int i = optind; i < argc; i++) {
        if (result.inputs == DIG_RIG_INPUTS_MAX) {
            return dig_error_set(error, DIG_EINVAL, "more than %d recordings", DIG_RIG_INPUTS_MAX);
        }
        result.input[result.inputs++] = argv[i];
    }
    if (first == 1) {
        return dig_error_set(error, DIG_EINVAL, "expected record or serve");
    }
    const enum dig_status status = check(&result, error);
    if (status == DIG_OK) {
        *options = result;
    }
    return status;
}

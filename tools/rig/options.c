#include "tools/rig/options.h"

#include "core/command_line.h"

#include <getopt.h>

#define INTO(field) DIG_INTO(struct dig_rig_options, field)

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

static enum dig_status take_exact(const char *const none, void *const into,
                                  struct dig_error *const error)
{
    (void)none;
    (void)error;
    struct dig_rig_options *const options = into;
    options->noise = options->quantise = false;
    return DIG_OK;
}

static enum dig_status take_fault(const char *const text, void *const into,
                                  struct dig_error *const error)
{
    return dig_rig_fault_add(text, &((struct dig_rig_options *)into)->faults, error);
}

static const struct dig_option known[] = {
    { "machine", "M.yaml", NULL, "the machine (config/machines)", INTO(machine) },
    { "output", "OUT.csv", " record air ", "machine recording to write", INTO(out), .letter = 'o',
      .writes = true },
    { "can", "IFACE", " serve ", "CAN frames in the ZX200 layout", INTO(can) },
    { "modbus-tcp", "IPV4:PORT", " serve ",
      "Modbus TCP server (port 0: any free one, told on stderr)", INTO(tcp) },
    { "modbus-rtu", "DEV[:BAUD]", " serve ", "Modbus RTU slave 1 (default 115200 baud, 8N1)",
      INTO(rtu) },
    { "can-sealed", NULL, " serve ", "pressures and angles carry a counter and a checksum",
      INTO(can_sealed) },
    { "speed", "F", " serve ", "times real time (default 1)", INTO(speed), 0.01, 100.0 },
    { "start-delay", "S", " serve ", "stand still so many seconds first, with the bus alive",
      INTO(start_delay_s), 0.0, 3600.0, "s" },
    { "loop", NULL, " serve ", "start again at the end, until SIGTERM", INTO(loop) },
    { "fault", "KIND[=N]@T[:DURATION]", " serve ",
      "what goes wrong at T seconds of machine time (may be given again): not-available, "
      "frozen, missing, out-of-range, stuck-pressures, stuck-angles, far, far-silent; drop, "
      "duplicate, reorder, corrupt, exception for a share N; delay, slow by N seconds",
      .take = take_fault },
    { "json", NULL, " serve ", "what was sent and asked for, as JSON on stdout at the end",
      INTO(json) },
    { "quiet", NULL, NULL, "no progress, only what goes wrong", INTO(quiet), .letter = 'q' },
    { "truth", "TRUTH.csv", " record air ", "also write the true pose and wrench of the bucket pin",
      INTO(truth), .writes = true },
    { "exact", NULL, " record air ",
      "numbers as they are: without noise, not in steps of the machine's bus", .take = take_exact },
    { "scene", "SCENE.yaml", " record serve ",
      "the scene that they were dug in tells it (a campaign names its own)", INTO(scene) },
    { "seed", "N", NULL, "of the sensors' noise (default 1)", INTO(seed) },
    { "no-noise", NULL, NULL, "sensors without noise", INTO(noise), .clears = true },
    { "air-pace", "F", " record serve ",
      "how briskly the bucket is moved before and after a dig; 1 (default): at most 0.7 m/s2, 2: "
      "four times that",
      INTO(track.air_pace), 0.1, 4.0 },
    { "no-air", NULL, " record serve ", "the dig alone, without motion before and after",
      INTO(track.air), .clears = true },
};

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

static enum dig_status check(const struct dig_rig_options *const o, struct dig_error *const error)
{
    const bool            air   = o->command == DIG_RIG_COMMAND_AIR;
    const bool            serve = o->command == DIG_RIG_COMMAND_SERVE;
    struct dig_conditions c     = { .error = error };
    dig_require(&c, !air || o->inputs == 0, "%s: air takes no recording", o->input[0]);
    dig_require(&c, air || o->inputs > 0, "no recording given");
    dig_require(&c, o->machine != NULL, "--machine: missing, expected a machine YAML");
    dig_require(&c, serve || o->out != NULL, "-o: missing, expected the file to write");
    dig_require(&c, !serve || o->can != NULL || o->tcp != NULL || o->rtu != NULL,
                "no bus: expected --can, --modbus-tcp or --modbus-rtu");
    return c.status;
}

enum dig_status dig_rig_options_parse(const int argc, char *argv[],
                                      struct dig_rig_options *const options,
                                      struct dig_error *const       error)
{
    struct dig_rig_options result = {
        .track    = dig_rig_track_options_default(),
        .seed     = 1,
        .noise    = true,
        .quantise = true,
        .speed    = 1.0,
    };
    const struct dig_command *const command =
        dig_options_read(&program, argc, argv, &result, error);
    if (command == NULL) {
        return DIG_EINVAL;
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

void dig_rig_options_refuse(const char *const word, const struct dig_error *const error)
{
    dig_options_refuse(&program, word, error->text, stderr);
}

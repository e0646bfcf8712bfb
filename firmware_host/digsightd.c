// digsightd: reads a machine's bus, identifies the gravel, publishes what it will resist with.

#include "core/command_line.h"
#include "core/streams.h"
#include "core/text.h"
#include "firmware_host/daemon.h"

#include <getopt.h>
#include <stdbool.h>
#include <stdio.h>

enum { EXIT_DONE, EXIT_FAILED, EXIT_USAGE };

struct options {
    const char *config;
    bool        check, json;
};

#define INTO(field) DIG_INTO(struct options, field)

static const struct dig_option known[] = {
    { "config", "CONFIG.yaml", NULL, "what is read, and where: docs/formats/daemon.md",
      INTO(config), .letter = 'c' },
    { "check", NULL, NULL, "load everything the configuration names, say what was found, exit",
      INTO(check) },
    { "json", NULL, NULL, "say that as JSON; with --check", INTO(json) },
};

static const struct dig_program program = {
    .self        = { "digsightd", "-c CONFIG.yaml [OPTION]...",
                     "Predicts what the ground will resist an excavator's next dig with.",
                     "Reads cylinder pressures and joint angles from CAN or Modbus (or plays a "
                            "recording), computes the soil's moment on the bucket, identifies the gravel from "
                            "a simple dig, and publishes the predicted resistance of the digs that follow over "
                            "LCM. It only listens: no CAN frame is sent, and of Modbus only the read functions "
                            "3 and 4 are used. Its output is advice.\n\n"
                            "Channels: DIGSIGHT_SAMPLE, DIGSIGHT_ESTIMATE, DIGSIGHT_MATCH, "
                            "DIGSIGHT_PREDICTION, DIGSIGHT_HEALTH. SIGTERM and SIGINT end it cleanly; SIGHUP "
                            "takes the table and the model that the configuration names then, between two digs.",
                     "digsightd -c config/digsightd.yaml --check\n"
                            "digsightd -c config/digsightd_can.yaml\n"
                            "lcm-logger --lcm-url='udpm://239.255.76.67:7667?ttl=0' dig.lcm\n" },
    .exit_status = "0  done\n1  the work failed\n"
                   "2  bad usage, or a file that is not as it should be\n",
    .options     = sizeof known / sizeof known[0],
    .option      = known,
};

// Lines name files and what stands in them: nothing of that may command a terminal.
static void say(const char *const line)
{
    dig_text_print(stderr, "digsightd: %s\n", line);
}

static void print(const char *const line)
{
    dig_text_print(stdout, "%s\n", line);
}

static int fail(const enum dig_status status, const struct dig_error *const error)
{
    say(error->text[0] != '\0' ? error->text : dig_status_str(status));
    return status == DIG_ENOMEM ? EXIT_FAILED : EXIT_USAGE;
}

int main(const int argc, char *argv[])
{
    struct dig_error error = { "" };
    struct options   o     = { .config = NULL };
    dig_streams_begin();
    if (dig_options_read(&program, argc, argv, &o, &error) == NULL) {
        dig_options_refuse(&program, NULL, error.text, stderr);
        return EXIT_USAGE;
    }
    if (o.config == NULL || optind < argc || (o.json && !o.check)) {
        dig_options_refuse(&program, NULL,
                           o.config == NULL ? "no configuration, expected -c CONFIG.yaml"
                           : optind < argc  ? "unknown argument"
                                            : "--json: expected with --check only",
                           stderr);
        return EXIT_USAGE;
    }
    struct dig_daemon *daemon = NULL;
    enum dig_status    status = dig_daemon_create(o.config, &daemon, &error);
    if (status != DIG_OK) {
        return fail(status, &error);
    }
    if (o.json) {
        dig_daemon_describe_json(daemon, stdout);
    } else {
        dig_daemon_describe(daemon, o.check ? print : say);
    }
    if (!o.check) {
        status = dig_daemon_run(daemon, say, &error);
    }
    dig_daemon_destroy(daemon);
    if (status != DIG_OK) {
        say(error.text);
        return EXIT_FAILED;
    }
    return dig_streams_end("digsightd", EXIT_DONE);
}

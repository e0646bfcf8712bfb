// digsightd: reads a machine's bus, identifies the gravel, publishes what it will resist with.

#include "core/text.h"
#include "firmware_host/daemon.h"

#include <getopt.h>
#include <stdbool.h>
#include <stdio.h>
#include <unistd.h>

enum { EXIT_DONE, EXIT_FAILED, EXIT_USAGE };

static const char help[] =
    "Usage: digsightd -c CONFIG.yaml [--check]\n"
    "\n"
    "Reads cylinder pressures and joint angles from CAN or Modbus (or plays a recording),\n"
    "computes the soil's moment on the bucket, identifies the gravel from a simple dig, and\n"
    "publishes the predicted resistance of the digs that follow over LCM. It only listens: no\n"
    "CAN frame is sent, and of Modbus only the read functions 3 and 4 are used. Its output is\n"
    "advice.\n"
    "\n"
    "  -c, --config FILE  the configuration (docs/formats.md)\n"
    "      --check        load everything the configuration names, say what was found, exit\n"
    "  -h, --help\n"
    "      --version\n"
    "\n"
    "Channels: DIGSIGHT_SAMPLE, DIGSIGHT_ESTIMATE, DIGSIGHT_MATCH, DIGSIGHT_PREDICTION,\n"
    "DIGSIGHT_HEALTH. SIGTERM and SIGINT end it cleanly; SIGHUP takes the table that the\n"
    "configuration names then, between two digs.\n"
    "Exit status: 0 done, 1 the work failed, 2 bad usage or a file that is not as it should be.\n"
    "\n"
    "Examples:\n"
    "  digsightd -c config/digsightd.yaml --check\n"
    "  digsightd -c config/digsightd_can.yaml\n"
    "  lcm-logger --lcm-url='udpm://239.255.76.67:7667?ttl=0' dig.lcm    # record it\n";

// Lines name files and what stands in them: nothing of that may command a terminal.
static void put(FILE *const to, const char *const before, const char *const line,
                const char *const behind)
{
    (void)fputs(before, to);
    dig_text_put(to, line);
    (void)fputs(behind, to);
}

static void say(const char *const line)
{
    put(stderr, "digsightd: ", line, "\n");
}

// On a terminal the last line shows where things stand; a line that is said goes above it.
static void say_above(const char *const line)
{
    put(stderr, "\r\033[Kdigsightd: ", line, "\n");
}

static void show(const char *const line)
{
    put(stderr, "\r\033[K", line, "");
}

static void print(const char *const line)
{
    put(stdout, "", line, "\n");
}

static int fail(const enum dig_status status, const struct dig_error *const error)
{
    say(error->text[0] != '\0' ? error->text : dig_status_str(status));
    return status == DIG_ENOMEM ? EXIT_FAILED : EXIT_USAGE;
}

int main(const int argc, char *argv[])
{
    enum { CHECK = 256, VERSION };
    static const struct option options[] = {
        { "config", required_argument, NULL, 'c' },
        { "check", no_argument, NULL, CHECK },
        { "help", no_argument, NULL, 'h' },
        { "version", no_argument, NULL, VERSION },
        { NULL, 0, NULL, 0 },
    };
    const char *config = NULL;
    int         check  = 0;
    for (int option = 0; (option = getopt_long(argc, argv, "c:h", options, NULL)) != -1;) {
        switch (option) {
        case 'c': config = optarg; break;
        case CHECK: check = 1; break;
        case 'h': (void)fputs(help, stdout); return EXIT_DONE;
        case VERSION: (void)puts("digsightd " DIG_VERSION); return EXIT_DONE;
        default: (void)fputs("Try digsightd --help.\n", stderr); return EXIT_USAGE;
        }
    }
    if (config == NULL || optind < argc) {
        (void)fprintf(stderr, "digsightd: %s\nTry digsightd --help.\n",
                      config == NULL ? "no configuration, expected -c CONFIG.yaml"
                                     : "unknown argument");
        return EXIT_USAGE;
    }
    struct dig_daemon *daemon = NULL;
    struct dig_error   error  = { "" };
    enum dig_status    status = dig_daemon_create(config, &daemon, &error);
    if (status != DIG_OK) {
        return fail(status, &error);
    }
    dig_daemon_describe(daemon, check ? print : say);
    if (!check) {
        const bool               terminal = isatty(STDERR_FILENO) != 0;
        const struct dig_console console  = { .say  = terminal ? say_above : say,
                                              .show = terminal ? show : NULL };
        status                            = dig_daemon_run(daemon, &console, &error);
        (void)fputs(terminal ? "\n" : "", stderr);
    }
    dig_daemon_destroy(daemon);
    if (status != DIG_OK) {
        say(error.text);
        return EXIT_FAILED;
    }
    return EXIT_DONE;
}

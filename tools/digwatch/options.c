#include "tools/digwatch/options.h"

#include <assert.h>
#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>

static const char help[] =
    "digwatch shows in a terminal what digsightd measures, identifies and predicts, and what is\n"
    "wrong: live from LCM, or from a log.\n"
    "\n"
    "usage:\n"
    "  digwatch [--lcm-url URL] [--log LOG.lcm [--speed X]] [--ascii]\n"
    "      --lcm-url URL   the daemon's lcm url, default udpm://239.255.76.67:7667?ttl=0\n"
    "      --log FILE      play a log of lcm-logger instead\n"
    "      --speed X       X times as fast as it was logged, 0.01 to 10000, default 1; a pause of\n"
    "                      more than 10 s takes 10 s\n"
    "      --ascii         no braille and no shades, for terminals without UTF-8 (found by "
    "itself)\n"
    "  digwatch --prometheus FILE.prom [--lcm-url URL]\n"
    "      writes health once a second in Prometheus' text format, for node_exporter's textfile\n"
    "      collector, instead of showing it; SIGTERM ends it\n"
    "  digwatch --help | --version\n"
    "\n"
    "q ends it. Shown are advice, not a safety function. NO_COLOR=1 leaves colours out.\n"
    "Exit codes: 0 done, 1 the work failed, 2 bad usage, a log that is none, or no terminal.\n"
    "\n"
    "examples:\n"
    "  digwatch\n"
    "  digwatch --log day.lcm --speed 10\n"
    "  digwatch --prometheus /var/lib/prometheus/node-exporter/digsight.prom\n";

enum dig_status digwatch_parse(const int argc, char *argv[], struct digwatch_options *const options,
                               struct dig_error *const error)
{
    assert(argv != NULL && options != NULL);
    enum { URL = 256, LOG, SPEED, ASCII, PROMETHEUS, HELP, VERSION };
    static const struct option known[] = {
        { "lcm-url", required_argument, NULL, URL },
        { "log", required_argument, NULL, LOG },
        { "speed", required_argument, NULL, SPEED },
        { "ascii", no_argument, NULL, ASCII },
        { "prometheus", required_argument, NULL, PROMETHEUS },
        { "help", no_argument, NULL, HELP },
        { "version", no_argument, NULL, VERSION },
        { NULL, 0, NULL, 0 },
    };
    struct digwatch_options o     = { .url = NULL };
    char                   *end   = NULL;
    const char             *speed = NULL;
    opterr                        = 0;
    for (int c; (c = getopt_long(argc, argv, "", known, NULL)) != -1;) {
        switch (c) {
        case URL: o.url = optarg; break;
        case LOG: o.log = optarg; break;
        case SPEED: speed = optarg; break;
        case ASCII: o.ascii = true; break;
        case PROMETHEUS: o.prometheus = optarg; break;
        case HELP: (void)fputs(help, stdout); exit(EXIT_SUCCESS);
        case VERSION: (void)puts("digwatch " DIG_VERSION); exit(EXIT_SUCCESS);
        default:
            return dig_error_set(error, DIG_EINVAL, "unknown option or missing value: %s",
                                 argv[optind - 1]);
        }
    }
    if (optind < argc) {
        return dig_error_set(error, DIG_EINVAL, "%s: expected options alone (a log: --log %s)",
                             argv[optind], argv[optind]);
    }
    o.speed = speed != NULL ? strtod(speed, &end) : 1.0;
    if (speed != NULL && (end == speed || *end != '\0' || !(o.speed >= 0.01 && o.speed <= 1e4))) {
        return dig_error_set(error, DIG_EINVAL, "--speed %s: expected 0.01 to 10000", speed);
    }
    if ((o.log != NULL && (o.url != NULL || o.prometheus != NULL)) ||
        (o.log == NULL && speed != NULL)) {
        return dig_error_set(error, DIG_EINVAL,
                             "expected --speed with --log, and --log without --lcm-url and "
                             "--prometheus");
    }
    o.url    = o.url != NULL ? o.url : "udpm://239.255.76.67:7667?ttl=0";
    *options = o;
    return DIG_OK;
}

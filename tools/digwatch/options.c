#include "tools/digwatch/options.h"

#include "core/command_line.h"

#include <assert.h>
#include <getopt.h>

#define INTO(field) DIG_INTO(struct digwatch_options, field)

static const struct dig_option known[] = {
    { "lcm-url", "URL", NULL, "the daemon's lcm url (default udpm://239.255.76.67:7667?ttl=0)",
      INTO(url) },
    { "log", "LOG.lcm", NULL, "play a log of lcm-logger instead", INTO(log) },
    { "speed", "X", NULL,
      "X times as fast as it was logged, 0.01 to 10000 (default 1); a pause of more than 10 s "
      "takes 10 s",
      INTO(speed), 0.01, 1e4 },
    { "ascii", NULL, NULL,
      "no braille and no shades, for terminals without UTF-8 (found by itself)", INTO(ascii) },
    { "prometheus", "FILE.prom", NULL,
      "write health once a second in Prometheus' text format, for node_exporter's textfile "
      "collector, instead of showing it; SIGTERM ends it",
      INTO(prometheus) },
};

static const struct dig_program program = {
    .self = { "digwatch", "[--lcm-url URL] [OPTION]...\n--log LOG.lcm [OPTION]...",
              "Shows in a terminal what digsightd measures, identifies and predicts.",
              "And what is wrong: live from LCM, or from a log. q ends it. Shown are advice, not a "
              "safety function. NO_COLOR=1 leaves colours out.",
              "digwatch\n"
              "digwatch --log day.lcm --speed 10\n"
              "digwatch --prometheus /var/lib/prometheus/node-exporter/digsight.prom\n" },
    .exit_status =
        "0  done\n1  the work failed\n2  bad usage, a log that is none, or no terminal\n",
    .options = sizeof known / sizeof known[0],
    .option  = known,
};

enum dig_status digwatch_parse(const int argc, char *argv[], struct digwatch_options *const options,
                               struct dig_error *const error)
{
    assert(argv != NULL && options != NULL);
    struct digwatch_options o = { .speed = 0.0 };
    if (dig_options_read(&program, argc, argv, &o, error) == NULL) {
        return DIG_EINVAL;
    }
    if (optind < argc) {
        return dig_error_set(error, DIG_EINVAL, "%s: expected options alone (a log: --log %s)",
                             argv[optind], argv[optind]);
    }
    if ((o.log != NULL && (o.url != NULL || o.prometheus != NULL)) ||
        (o.log == NULL && o.speed > 0.0)) {
        return dig_error_set(error, DIG_EINVAL,
                             "expected --speed with --log, and --log without --lcm-url and "
                             "--prometheus");
    }
    o.speed  = o.speed > 0.0 ? o.speed : 1.0;
    o.url    = o.url != NULL ? o.url : "udpm://239.255.76.67:7667?ttl=0";
    *options = o;
    return DIG_OK;
}

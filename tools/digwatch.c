// digwatch: what digsightd knows, in a terminal, live or from a log.

#include "core/command_line.h"
#include "core/name.h"
#include "core/streams.h"
#include "tools/digwatch/model.h"
#include "tools/digwatch/prometheus.h"
#include "tools/digwatch/screen.h"
#include "tools/digwatch/source.h"
#include "tools/digwatch/terminal.h"

#include <errno.h>
#include <getopt.h>
#include <math.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#define FRAME_s 0.1 // between two pictures
#define WRITE_s 1.0 // between two files of --prometheus

struct options {
    const char *url, *log, *prometheus; // log, prometheus: NULL for none
    double      speed;
    bool        ascii;
};

#define INTO(field) DIG_INTO(struct options, field)

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
      INTO(prometheus), .writes = true },
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

static enum dig_status parse(const int argc, char *argv[], struct options *const o,
                             struct dig_error *const error)
{
    if (dig_options_read(&program, argc, argv, o, error) == NULL) {
        return DIG_EINVAL;
    }
    if (optind < argc) {
        return dig_error_set(error, DIG_EINVAL, "%s: expected options alone (a log: --log %s)",
                             argv[optind], argv[optind]);
    }
    if ((o->log != NULL && (o->url != NULL || o->prometheus != NULL)) ||
        (o->log == NULL && o->speed > 0.0)) {
        return dig_error_set(error, DIG_EINVAL,
                             "expected --speed with --log, and --log without --lcm-url and "
                             "--prometheus");
    }
    o->speed = o->speed > 0.0 ? o->speed : 1.0;
    o->url   = o->url != NULL ? o->url : "udpm://239.255.76.67:7667?ttl=0";
    return DIG_OK;
}

static volatile sig_atomic_t stopped;

static void stop(const int number)
{
    (void)number;
    stopped = 1;
}

static double now_s(void)
{
    struct timespec now;
    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

// What is watched, and since when nothing was heard.
struct watch {
    struct digwatch_source source;
    struct digwatch_model  model;
    double                 heard_s;
    struct dig_error       damage; // of a log
};

static void read_messages(struct watch *const w)
{
    const int64_t heard = w->model.messages + w->model.misread;
    // The screen shows the damage; the log has ended there.
    const enum dig_status status = digwatch_source_read(&w->source, now_s(), &w->model, &w->damage);
    (void)status;
    w->heard_s = w->model.messages + w->model.misread > heard ? now_s() : w->heard_s;
}

// Sleeps until a key, a message or the time due_s; false when the terminal is gone.
static bool wait_until(const struct watch *const w, const double due_s, const bool keyboard)
{
    struct pollfd fd[] = { { .fd = w->source.fd, .events = POLLIN },
                           { .fd = keyboard ? STDIN_FILENO : -1, .events = POLLIN } };
    const double  left = fmin(due_s, w->source.due_s) - now_s();
    const int     n    = poll(fd, 2, left > 0.0 ? (int)ceil(1e3 * fmin(left, 1e3)) : 0);
    return n < 0 ? errno == EINTR : (fd[1].revents & (POLLHUP | POLLERR | POLLNVAL)) == 0;
}

static void show(const struct watch *const w, const struct options *const options, const bool ascii)
{
    static struct digwatch_grid grid;
    char                        source[160];
    const bool                  ended = digwatch_source_ended(&w->source);
    if (options->log != NULL) {
        (void)snprintf(source, sizeof source, "%.100s, %gx", dig_path_last(options->log),
                       options->speed);
    } else {
        (void)snprintf(source, sizeof source, "%.150s", options->url);
    }
    const struct digwatch_view view = { .source = source,
                                        .silent_s =
                                            options->log != NULL ? 0.0 : now_s() - w->heard_s,
                                        .ended  = ended,
                                        .damage = w->damage.text };
    int                        rows;
    int                        columns;
    digwatch_terminal_size(&rows, &columns);
    digwatch_grid_init(&grid, rows, columns, ascii);
    digwatch_screen(&w->model, &view, &grid);
    digwatch_terminal_show(&grid);
}

static enum dig_status watch(struct watch *const w, const struct options *const options,
                             struct dig_error *const error)
{
    bool            utf8   = false;
    enum dig_status status = digwatch_terminal_open(&utf8, error);
    if (status != DIG_OK) {
        return status;
    }
    const bool ascii   = options->ascii || !utf8;
    double     frame_s = 0.0;
    while (stopped == 0) {
        read_messages(w);
        const int key = digwatch_terminal_key();
        if (key == 'q') {
            break;
        }
        if (key != 0 || now_s() >= frame_s) {
            show(w, options, ascii);
            frame_s = now_s() + FRAME_s;
        }
        if (!wait_until(w, frame_s, true)) {
            break;
        }
    }
    digwatch_terminal_close();
    return DIG_OK;
}

static enum dig_status write_health(struct watch *const w, const char *const path,
                                    struct dig_error *const error)
{
    enum dig_status status = DIG_OK;
    for (double due_s = now_s() + WRITE_s; stopped == 0 && status == DIG_OK;) {
        read_messages(w);
        if (now_s() >= due_s) {
            status = digwatch_prometheus(&w->model, now_s() - w->heard_s, path, error);
            due_s  = now_s() + WRITE_s;
        }
        (void)wait_until(w, due_s, false);
    }
    return status;
}

int main(const int argc, char *argv[])
{
    static struct watch w;
    struct options      options = { .speed = 0.0 };
    struct dig_error    error   = { "" };
    dig_streams_begin();
    if (parse(argc, argv, &options, &error) != DIG_OK) {
        dig_options_refuse(&program, NULL, error.text, stderr);
        return 2;
    }
    const int              ends[] = { SIGINT, SIGTERM, SIGHUP, SIGQUIT };
    const struct sigaction action = { .sa_handler = stop };
    for (size_t i = 0; i < sizeof ends / sizeof ends[0]; i++) {
        (void)sigaction(ends[i], &action, NULL);
    }
    digwatch_model_init(&w.model);
    w.heard_s = now_s();

    enum dig_status status =
        options.log != NULL ? digwatch_source_play(options.log, options.speed, &w.source, &error)
                            : digwatch_source_listen(options.url, &w.source, &error);
    if (status == DIG_OK) {
        status = options.prometheus != NULL ? write_health(&w, options.prometheus, &error)
                                            : watch(&w, &options, &error);
        digwatch_source_close(&w.source);
    }
    if (status != DIG_OK) {
        (void)fprintf(stderr, "digwatch: %s\n", error.text);
    }
    return dig_streams_end("digwatch",
                           status == DIG_OK ? EXIT_SUCCESS
                           : status == DIG_EINVAL || (options.log != NULL && status == DIG_EIO)
                               ? 2
                               : EXIT_FAILURE);
}

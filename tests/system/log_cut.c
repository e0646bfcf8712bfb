// Cuts an LCM log of the daemon down to the first messages of each channel, 20 samples and as many
// estimates, two of all others; of predictions those that are valid:
//   log_cut LOG.lcm OUT.lcm

#include "messages/digsight_prediction_t.h"

#include <lcm/eventlog.h>

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

static const struct channel {
    const char *name;
    int         keep;
} channels[] = {
    { "DIGSIGHT_SAMPLE", 20 },    { "DIGSIGHT_ESTIMATE", 20 }, { "DIGSIGHT_MATCH", 2 },
    { "DIGSIGHT_PREDICTION", 2 }, { "DIGSIGHT_HEALTH", 2 },
};
enum { CHANNELS = sizeof channels / sizeof channels[0] };

static bool is_empty(const lcm_eventlog_event_t *const event)
{
    digsight_prediction_t m;
    if (strcmp(event->channel, "DIGSIGHT_PREDICTION") != 0 ||
        digsight_prediction_t_decode(event->data, 0, event->datalen, &m) < 0) {
        return false;
    }
    const bool empty = !m.valid;
    (void)digsight_prediction_t_decode_cleanup(&m);
    return empty;
}

// True for the first messages of a channel that is known, which it counts.
static bool is_kept(const lcm_eventlog_event_t *const event, int kept[const CHANNELS])
{
    for (int c = 0; c < CHANNELS; c++) {
        if (strcmp(event->channel, channels[c].name) == 0 && !is_empty(event)) {
            return kept[c]++ < channels[c].keep;
        }
    }
    return false;
}

static int cut(lcm_eventlog_t *const from, lcm_eventlog_t *const to)
{
    int                   kept[CHANNELS] = { 0 };
    int                   status         = 0;
    lcm_eventlog_event_t *event          = NULL;
    while (status == 0 && (event = lcm_eventlog_read_next_event(from)) != NULL) {
        status = is_kept(event, kept) ? lcm_eventlog_write_event(to, event) : 0;
        lcm_eventlog_free_event(event);
    }
    for (int c = 0; c < CHANNELS; c++) {
        if (kept[c] < channels[c].keep) {
            (void)fprintf(stderr, "log_cut: %s: %d messages, expected at least %d\n",
                          channels[c].name, kept[c], channels[c].keep);
            status = -1;
        }
    }
    return status;
}

int main(const int argc, char *argv[])
{
    if (argc != 3) {
        (void)fprintf(stderr, "usage: log_cut LOG.lcm OUT.lcm\n");
        return 2;
    }
    lcm_eventlog_t *const from   = lcm_eventlog_create(argv[1], "r");
    lcm_eventlog_t *const to     = lcm_eventlog_create(argv[2], "w");
    const int             status = from != NULL && to != NULL ? cut(from, to) : -1;
    if (from != NULL) {
        lcm_eventlog_destroy(from);
    }
    if (to != NULL) {
        lcm_eventlog_destroy(to);
    }
    return status == 0 ? 0 : 1;
}

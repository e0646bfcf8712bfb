#include "tools/digwatch/trouble.h"

#include <assert.h>
#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

struct list {
    size_t                   n;
    struct digwatch_trouble *trouble;
};

__attribute__((format(printf, 3, 4))) static void
add(struct list *const list, const char *const todo, const char *const what, ...)
{
    if (list->n == DIGWATCH_TROUBLES_MAX) {
        return;
    }
    struct digwatch_trouble *const t = &list->trouble[list->n++];
    va_list                        args;
    va_start(args, what);
    // NOLINTNEXTLINE(clang-analyzer-valist.Uninitialized): va_start is the line above
    (void)vsnprintf(t->what, sizeof t->what, what, args);
    va_end(args);
    (void)snprintf(t->todo, sizeof t->todo, "%s", todo);
}

static void add_health(struct list *const list, const struct digwatch_health *const h)
{
    const struct dig_health_text *const state = dig_health_state_text(h->state);
    if (state != NULL) {
        add(list, state->todo, "%s", state->what);
    }
    if (h->note[0] != '\0') {
        add(list, "", "digsightd says: %s", h->note);
    }
    for (size_t i = 0; i < DIG_HEALTH_COUNTERS; i++) {
        if (h->grew_ns[i] > 0 && h->time_ns - h->grew_ns[i] <= DIGWATCH_TROUBLE_ns) {
            const struct dig_health_text *const text = dig_health_counter_text(i);
            add(list, text->todo, "%s (%" PRId64 " so far)", text->what, h->count[i]);
        }
    }
    if (h->missing[0] != '\0') {
        add(list,
            "check those sensors and their plugs; the bucket's pressures alone give the moment",
            "no value of %s", h->missing);
    }
    if (!h->realtime || !h->memory_locked) {
        add(list, "run it by its systemd unit, which grants it",
            "%s not granted: predictions may come late",
            h->realtime ? "locked memory was" : "real-time priority was");
    }
}

static void add_ground(struct list *const list, const struct digwatch_model *const model)
{
    const struct dig_matched_gravel *const m = &model->match;
    if (m->wanted[0] != '\0') {
        add(list, "", "wanted: %s", m->wanted);
    } else if (m->known && !digwatch_model_match_holds(model)) {
        add(list, "dig a simple dig", "the gravel known is too old");
    }
    if (m->known && m->outside) {
        add(list, "do not rely on predictions; use a table that holds this ground",
            "the ground is none of the table's gravels");
    }
}

size_t digwatch_troubles(const struct digwatch_model *const model, const double silent_s,
                         struct digwatch_trouble trouble[DIGWATCH_TROUBLES_MAX])
{
    assert(model != NULL && trouble != NULL);
    struct list list = { .trouble = trouble };
    if (model->messages == 0) {
        add(&list,
            "is digsightd running, is its lcm url this one, is there a route "
            "(`ip route add 239.255.76.67 dev lo`)?",
            "no message of a daemon was heard yet");
    } else if (silent_s > DIGWATCH_SILENT_s) {
        add(&list, "is digsightd running? `systemctl status digsightd`",
            "no message for %.0f s: what is shown is old", silent_s);
    }
    // Times of messages may be any: their difference need not be an int64_t.
    const double ago_us = (double)model->time_us - (double)model->misread_us;
    if (model->misread > 0 && ago_us <= 1e-3 * DIGWATCH_TROUBLE_ns) {
        add(&list, "digwatch and digsightd must be of one version; or somebody else sends",
            "%" PRId64 " messages on its channels were not understood", model->misread);
    }
    if (model->any_health) {
        add_health(&list, &model->health);
    }
    add_ground(&list, model);
    return list.n;
}

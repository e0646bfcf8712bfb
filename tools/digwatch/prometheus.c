#include "tools/digwatch/prometheus.h"

#include "files/text/whole.h"
#include "tools/digwatch/trouble.h"

#include <assert.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

static void put(FILE *const to, const char *const name, const char *const kind,
                const char *const help, const double value)
{
    (void)fprintf(to, "# HELP digsight_%s %s\n# TYPE digsight_%s %s\ndigsight_%s %.15g\n", name,
                  help, name, kind, name, value);
}

static void put_counters(const struct digwatch_health *const h, FILE *const to)
{
    for (size_t i = 0; i < DIG_HEALTH_COUNTERS; i++) {
        const struct dig_health_text *const text = dig_health_counter_text(i);
        char                                name[64];
        (void)snprintf(name, sizeof name, "%s_total", text->name);
        put(to, name, "counter", text->what, (double)h->count[i]);
    }
}

enum dig_status digwatch_prometheus(const struct digwatch_model *const model, const double silent_s,
                                    const char *const path, struct dig_error *const error)
{
    assert(model != NULL && path != NULL);
    const struct digwatch_health *const h  = &model->health;
    const bool                          up = model->any_health && silent_s <= DIGWATCH_SILENT_s;
    struct digwatch_trouble             trouble[DIGWATCH_TROUBLES_MAX];
    struct dig_out                      out;
    const enum dig_status               status = dig_out_open(&out, path, error);
    if (status != DIG_OK) {
        return status;
    }
    FILE *const to = out.file;
    put(to, "up", "gauge", "1 while digsightd is heard", up ? 1.0 : 0.0);
    put(to, "troubles", "gauge", "What is wrong now, as digwatch shows it",
        (double)digwatch_troubles(model, silent_s, trouble));
    put(to, "misread_total", "counter", "Messages on its channels that were not understood",
        (double)model->misread);
    if (model->any_health) {
        put(to, "running", "gauge", "1 while fresh samples come",
            up && strcmp(h->state, "running") == 0 ? 1.0 : 0.0);
        put(to, "gravel_known", "gauge", "1 while a gravel is known",
            digwatch_model_match_holds(model) ? 1.0 : 0.0);
        put(to, "frames_total", "counter", "Frames or polls received", (double)h->frames);
        put(to, "digs_total", "counter", "Digs finished", h->digs);
        put(to, "digs_aborted_total", "counter", "Digs that left their trajectory", h->aborted);
        put(to, "matches_total", "counter", "Digs that identified a gravel", h->matches);
        put(to, "latency_p99_seconds", "gauge", "99 % of samples were published within",
            1e-6 * h->latency_p99_us);
        put_counters(h, to);
    }
    return dig_out_commit(&out, error);
}

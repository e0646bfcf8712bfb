#include "tests/blind/tally.h"

#include "core/sort.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define NAMES_MAX 64

static const char *const class_title[BLIND_CLASSES] = { "below 1", "1 to 2.25", "2.25 to 3",
                                                        "3 and more" };

static const char *const answer_title[BLIND_ANSWERS] = { "right",    "in set", "extra",  "none",
                                                         "unlisted", "wrong",  "refused" };

// Medians over campaigns with one effect of size 3 and more of after / oracle and before / oracle.
static void ratios(const size_t n, const struct blind_result result[], double *const before,
                   double *const after, size_t *const count)
{
    double *const b = calloc(n + 1, sizeof *b);
    double *const a = calloc(n + 1, sizeof *a);
    size_t        k = 0;
    for (size_t i = 0; i < n && a != NULL && b != NULL; i++) {
        const struct blind_result *const r = &result[i];
        if (r->state == BLIND_TRACED && r->order.kind == BLIND_SINGLE &&
            blind_class_of(r) == BLIND_CLASSES - 1 && isfinite(r->verdict.before) &&
            isfinite(r->verdict.after) && r->truth.error > 0.0) {
            b[k] = r->verdict.before / r->truth.error;
            a[k] = r->verdict.after / r->truth.error;
            k++;
        }
    }
    *count = k;
    if (k > 0) {
        *before = dig_sort_median(k, b);
        *after  = dig_sort_median(k, a);
    }
    free(a);
    free(b);
}

static void title_of(const struct blind_result *const r, const size_t size, char text[])
{
    if (r->order.effects == 0) {
        (void)snprintf(text, size, "none");
    } else {
        (void)snprintf(text, size, "%s%s%s%s", r->order.kind == BLIND_OUTSIDE ? "(out) " : "",
                       r->order.effect[0].name, r->order.effects > 1 ? " + " : "",
                       r->order.effects > 1 ? r->order.effect[1].name : "");
    }
}

struct row {
    char   title[80];
    size_t n, answer[BLIND_ANSWERS];
    char   worst[DIG_NAME_SIZE]; // a wrong name given
};

// The row of that title among the first *rows, made when it is new; NULL when all are taken.
static struct row *row_of(struct row row[], size_t *const rows, const char *const title)
{
    size_t i = 0;
    while (i < *rows && strcmp(row[i].title, title) != 0) {
        i++;
    }
    if (i == *rows && i < NAMES_MAX) {
        row[(*rows)++] = (struct row){ .n = 0 };
        (void)snprintf(row[i].title, sizeof row[i].title, "%s", title);
    }
    return i < NAMES_MAX ? &row[i] : NULL;
}

static void print_class(const size_t n, const struct blind_result result[], const int class,
                        FILE *const to)
{
    struct row row[NAMES_MAX];
    size_t     rows = 0;
    for (size_t i = 0; i < n; i++) {
        const struct blind_result *const r = &result[i];
        char                             title[80];
        if (r->state < BLIND_REFUSED || r->order.kind == BLIND_NONE ||
            r->order.kind == BLIND_PAIR || blind_class_of(r) != class) {
            continue;
        }
        title_of(r, sizeof title, title);
        struct row *const at = row_of(row, &rows, title);
        if (at == NULL) {
            continue;
        }
        const enum blind_answer answer = blind_answer_of(r);
        at->n++;
        at->answer[answer]++;
        for (size_t e = 0; e < r->verdict.names; e++) {
            if (answer == BLIND_WRONG || answer == BLIND_EXTRA) {
                if (!blind_justified(r, r->verdict.name[e])) {
                    (void)snprintf(at->worst, sizeof at->worst, "%s", r->verdict.name[e]);
                }
            }
        }
    }
    if (rows == 0) {
        return;
    }
    (void)fprintf(to, "\nsize %s\n  %-28s %4s", class_title[class], "truth", "n");
    for (int a = 0; a < BLIND_ANSWERS; a++) {
        (void)fprintf(to, " %8s", answer_title[a]);
    }
    (void)fputs("  taken for, say\n", to);
    for (size_t i = 0; i < rows; i++) {
        (void)fprintf(to, "  %-28s %4zu", row[i].title, row[i].n);
        for (int a = 0; a < BLIND_ANSWERS; a++) {
            (void)fprintf(to, " %8zu", row[i].answer[a]);
        }
        (void)fprintf(to, "  %s\n", row[i].worst);
    }
}

static void print_none(const size_t n, const struct blind_result result[], FILE *const to)
{
    for (int machine = 0; machine < 2; machine++) {
        for (int ours = 0; ours < 2; ours++) {
            size_t all    = 0;
            size_t false_ = 0;
            for (size_t i = 0; i < n; i++) {
                const struct blind_result *const r = &result[i];
                if (r->state >= BLIND_REFUSED && r->order.kind == BLIND_NONE &&
                    r->by_machine == (machine == 1) &&
                    (strcmp(r->source, "ours") == 0) == (ours == 1)) {
                    all++;
                    false_ += blind_says(r, "none") ? 0 : 1;
                }
            }
            const struct blind_share s = blind_share_of(false_, all);
            if (all > 0) {
                (void)fprintf(to, "  none, %s, %-16s %4zu of %4zu alarmed (95 %%: %.3f to %.3f)\n",
                              machine ? "machine" : "force  ", ours ? "our DEM" : "LIGGGHTS", s.k,
                              s.n, s.low, s.high);
            }
        }
    }
}

static size_t count_state(const size_t n, const struct blind_result result[],
                          const enum blind_state state)
{
    size_t k = 0;
    for (size_t i = 0; i < n; i++) {
        k += result[i].state == state ? 1 : 0;
    }
    return k;
}

void blind_tally_print(const size_t n, const struct blind_result result[], FILE *const to)
{
    (void)fprintf(to, "%zu campaigns traced, %zu refused, %zu failed, %zu could not be made\n",
                  count_state(n, result, BLIND_TRACED), count_state(n, result, BLIND_REFUSED),
                  count_state(n, result, BLIND_FAILED), count_state(n, result, BLIND_UNMADE));
    print_none(n, result, to);
    for (int c = BLIND_CLASSES - 1; c >= 0; c--) {
        print_class(n, result, c, to);
    }
    double before = 0.0;
    double after  = 0.0;
    size_t count  = 0;
    ratios(n, result, &before, &after, &count);
    if (count > 0) {
        (void)fprintf(to,
                      "\nholdout error over the oracle's, medians of %zu campaigns with one effect "
                      "of size 3 and more: before %.2f, after %.2f\n",
                      count, before, after);
    }
    (void)fputs("\ncriterion\n", to);
    for (size_t i = 0; i < BLIND_CRITERIA; i++) {
        const struct blind_share s = blind_criterion_judge(&blind_criterion[i], n, result);
        (void)fprintf(to,
                      "  %-64s %s %4.0f %%: %4zu of %4zu = %5.1f %% (95 %%: %.1f to %.1f)  %s\n",
                      blind_criterion[i].title,
                      blind_criterion[i].at_least ? ">=" : "<=", 100.0 * blind_criterion[i].bound,
                      s.k, s.n, s.n == 0 ? 0.0 : 100.0 * (double)s.k / (double)s.n, 100.0 * s.low,
                      100.0 * s.high, blind_criterion_holds(&blind_criterion[i], &s));
    }
}

static void put_number(FILE *const to, const char *const key, const double value)
{
    if (isfinite(value)) {
        (void)fprintf(to, ", \"%s\": %.5g", key, value);
    } else {
        (void)fprintf(to, ", \"%s\": null", key);
    }
}

static void put_campaign(FILE *const to, const struct blind_result *const r)
{
    static const char *const kind[BLIND_KINDS] = { "none", "single", "pair", "outside" };
    (void)fprintf(to, "{\"number\": %llu, \"kind\": \"%s\", \"strength\": %d, \"truth\": [",
                  (unsigned long long)r->order.number, kind[r->order.kind], r->order.strength);
    for (size_t e = 0; e < r->order.effects; e++) {
        (void)fprintf(to, "%s\"%s\"", e == 0 ? "" : ", ", r->order.effect[e].name);
    }
    (void)fprintf(to,
                  "], \"source\": \"%s\", \"machine\": %s, \"other_simple\": %s, \"digs\": %zu, "
                  "\"state\": %d",
                  r->source, r->by_machine ? "true" : "false", r->other_simple ? "true" : "false",
                  r->digs, (int)r->state);
    for (size_t e = 0; e < r->order.effects; e++) {
        put_number(to, e == 0 ? "size" : "size2", r->truth.size[e]);
        put_number(to, e == 0 ? "size_air" : "size_air2", r->truth.size_air[e]);
    }
    if (r->state == BLIND_TRACED) {
        (void)fputs(", \"verdict\": [", to);
        for (size_t i = 0; i < r->verdict.names; i++) {
            (void)fprintf(to, "%s\"%s\"", i == 0 ? "" : ", ", r->verdict.name[i]);
        }
        (void)fprintf(to, "], \"answer\": \"%s\"", answer_title[blind_answer_of(r)]);
        static const char *const axis[DIG_AXES] = { "friction", "rolling", "density_kgpm3" };
        for (int a = 0; a < DIG_AXES; a++) {
            (void)fprintf(to, ", \"%s\": [%.5g, %.5g, %.5g]", axis[a], r->gravel.value[a],
                          r->verdict.gravel_low.value[a], r->verdict.gravel_high.value[a]);
        }
        put_number(to, "magnitude", r->magnitude);
        put_number(to, "before", r->verdict.before);
        put_number(to, "after", r->verdict.after);
        put_number(to, "oracle", r->truth.error);
        put_number(to, "noise_floor", r->verdict.noise_floor);
        put_number(to, "cpu_s", r->cpu_s);
        put_number(to, "peak_MB", 1e-6 * r->peak_B);
    }
    (void)fputs("}", to);
}

void blind_tally_json(const size_t n, const struct blind_result result[], const char *const split,
                      FILE *const to)
{
    (void)fprintf(to, "{\"split\": \"%s\", \"criteria\": [", split);
    for (size_t i = 0; i < BLIND_CRITERIA; i++) {
        const struct blind_share s = blind_criterion_judge(&blind_criterion[i], n, result);
        (void)fprintf(
            to, "%s\n {\"name\": \"%s\", \"bound\": %g, \"at_least\": %s, \"k\": %zu, \"n\": %zu",
            i == 0 ? "" : ",", blind_criterion[i].title, blind_criterion[i].bound,
            blind_criterion[i].at_least ? "true" : "false", s.k, s.n);
        put_number(to, "low", s.low);
        put_number(to, "high", s.high);
        (void)fprintf(to, ", \"result\": \"%s\"}", blind_criterion_holds(&blind_criterion[i], &s));
    }
    (void)fputs("],\n \"campaigns\": [", to);
    for (size_t i = 0; i < n; i++) {
        (void)fputs(i == 0 ? "\n  " : ",\n  ", to);
        put_campaign(to, &result[i]);
    }
    (void)fputs("]}\n", to);
}

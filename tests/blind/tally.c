#include "tests/blind/tally.h"

#include "core/effect.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define NAMES_MAX 64
#define SURE      0.5

// Bounds of the classes of size; the second is where the criterion for 1.5 is read off.
static const double      class_low[]   = { 0.0, 1.0, 2.25, 3.0 };
static const char *const class_title[] = { "below 1", "1 to 2.25", "2.25 to 3", "3 and more" };
#define CLASSES 4

static const char *const answer_title[BLIND_ANSWERS] = { "right", "in set",   "extra",
                                                         "none",  "unlisted", "wrong" };

struct blind_share blind_share_of(const size_t k, const size_t n)
{
    if (n == 0) {
        return (struct blind_share){ k, n, 0.0, 1.0 };
    }
    const double z      = 1.96;
    const double p      = (double)k / (double)n;
    const double zz     = z * z / (double)n;
    const double middle = (p + zz / 2.0) / (1.0 + zz);
    const double half   = z * sqrt(p * (1.0 - p) / (double)n + zz / (4.0 * (double)n)) / (1.0 + zz);
    return (struct blind_share){ k, n, fmax(middle - half, 0.0), fmin(middle + half, 1.0) };
}

double blind_size_of(const struct blind_result *const result)
{
    double least = (double)INFINITY;
    for (size_t e = 0; e < result->order.effects; e++) {
        least = fmin(least, fmax(result->truth.size[e], result->truth.size_air[e]));
    }
    return result->order.effects == 0 ? 0.0 : least;
}

// What is left of it in the soil after the best refit of the gravel, alone.
static double size_in_soil(const struct blind_result *const result)
{
    double least = (double)INFINITY;
    for (size_t e = 0; e < result->order.effects; e++) {
        least = fmin(least, result->truth.size[e]);
    }
    return result->order.effects == 0 ? 0.0 : least;
}

static int class_of_size(const double size)
{
    int c = CLASSES - 1;
    while (c > 0 && size < class_low[c]) {
        c--;
    }
    return c;
}

static int class_of(const struct blind_result *const result)
{
    return class_of_size(blind_size_of(result));
}

static bool says(const struct blind_result *const r, const char *const name)
{
    bool is = false;
    for (size_t i = 0; i < r->verdict.names; i++) {
        is = is || strcmp(r->verdict.name[i], name) == 0;
    }
    return is;
}

static bool set_holds(const struct blind_result *const r, const size_t s, const char *const name)
{
    bool is = false;
    for (size_t i = 0; i < r->verdict.set_size[s]; i++) {
        is = is || strcmp(r->verdict.set[s][i], name) == 0;
    }
    return is;
}

// Named, or in a small enough set together with something that the verdict names.
static bool found(const struct blind_result *const r, const struct blind_choice *const truth)
{
    const size_t most = truth->how == BLIND_BY_MACHINE ? 2 : 3;
    bool         is   = says(r, truth->name);
    for (size_t s = 0; s < r->verdict.sets && !is; s++) {
        for (size_t i = 0; i < r->verdict.names && r->verdict.set_size[s] <= most; i++) {
            is = is || (set_holds(r, s, truth->name) && set_holds(r, s, r->verdict.name[i]));
        }
    }
    return is;
}

// True when what the verdict names is there, or stands for something that is there.
static bool justified(const struct blind_result *const r, const char *const name)
{
    bool is = false;
    for (size_t e = 0; e < r->order.effects; e++) {
        const struct blind_choice *const truth = &r->order.effect[e];
        const size_t                     most  = truth->how == BLIND_BY_MACHINE ? 2 : 3;

        is = is || strcmp(name, truth->name) == 0;
        for (size_t s = 0; s < r->verdict.sets; s++) {
            is = is || (r->verdict.set_size[s] <= most && set_holds(r, s, name) &&
                        set_holds(r, s, truth->name));
        }
    }
    return is;
}

enum blind_answer blind_answer_of(const struct blind_result *const r)
{
    size_t there = 0;
    size_t wrong = 0;
    bool   named = r->order.effects > 0;
    for (size_t e = 0; e < r->order.effects; e++) {
        there += found(r, &r->order.effect[e]) ? 1 : 0;
        named = named && says(r, r->order.effect[e].name);
    }
    for (size_t i = 0; i < r->verdict.names; i++) {
        wrong += justified(r, r->verdict.name[i]) ? 0 : 1;
    }
    if (r->order.effects > 0 && there == r->order.effects) {
        return wrong > 0 ? BLIND_EXTRA : (named ? BLIND_RIGHT : BLIND_IN_SET);
    }
    if (says(r, "none")) {
        return r->order.effects == 0 ? BLIND_RIGHT : BLIND_SAID_NONE;
    }
    return says(r, "unlisted") ? BLIND_SAID_UNLISTED : BLIND_WRONG;
}

// An effect of the catalogue that is not there, claimed with a probability above one half.
static bool sure_of_wrong(const struct blind_result *const r)
{
    bool is = false;
    for (size_t i = 0; i < r->verdict.effects; i++) {
        is = is ||
             (r->verdict.probability[i] > SURE && strcmp(r->verdict.effect[i], "unlisted") != 0 &&
              !justified(r, r->verdict.effect[i]));
    }
    return is;
}

static bool sure_of_any(const struct blind_result *const r)
{
    bool is = false;
    for (size_t i = 0; i < r->verdict.effects; i++) {
        is = is ||
             (r->verdict.probability[i] > SURE && strcmp(r->verdict.effect[i], "unlisted") != 0);
    }
    return is;
}

// One acceptance criterion: whom it is about, what counts, and what the share is to be.
struct criterion {
    const char *title;
    bool (*about)(const struct blind_result *);
    bool (*counts)(const struct blind_result *);
    double bound;
    bool   at_least;
};

static bool is_none(const struct blind_result *const r)
{
    return r->order.kind == BLIND_NONE;
}
static bool alarmed(const struct blind_result *const r)
{
    return !says(r, "none");
}
static bool is_clear(const struct blind_result *const r)
{
    return r->order.kind == BLIND_SINGLE && class_of(r) == 3;
}
static bool is_middling(const struct blind_result *const r)
{
    return r->order.kind == BLIND_SINGLE && class_of(r) == 1;
}
static bool is_faint(const struct blind_result *const r)
{
    return r->order.kind == BLIND_SINGLE && class_of(r) == 0;
}
static bool is_single_in_soil(const struct blind_result *const r, const int class)
{
    return r->order.kind == BLIND_SINGLE && class_of_size(size_in_soil(r)) == class;
}
static bool is_clear_in_soil(const struct blind_result *const r)
{
    return is_single_in_soil(r, 3);
}
static bool is_middling_in_soil(const struct blind_result *const r)
{
    return is_single_in_soil(r, 1);
}
static bool is_faint_in_soil(const struct blind_result *const r)
{
    return is_single_in_soil(r, 0);
}
static bool is_right(const struct blind_result *const r)
{
    return blind_answer_of(r) == BLIND_RIGHT || blind_answer_of(r) == BLIND_IN_SET;
}
static bool is_clear_pair(const struct blind_result *const r)
{
    return r->order.kind == BLIND_PAIR && class_of(r) == 3;
}
static bool has_both(const struct blind_result *const r)
{
    return found(r, &r->order.effect[0]) && found(r, &r->order.effect[1]);
}
static bool is_outside(const struct blind_result *const r)
{
    return r->order.kind == BLIND_OUTSIDE;
}
static bool is_clear_outside(const struct blind_result *const r)
{
    return r->order.kind == BLIND_OUTSIDE && class_of(r) == 3;
}
static bool is_unlisted(const struct blind_result *const r)
{
    return says(r, "unlisted");
}
static bool is_known(const struct blind_result *const r)
{
    return r->order.kind == BLIND_SINGLE && isfinite(r->verdict.after) && class_of(r) == 3;
}
static bool is_near_oracle(const struct blind_result *const r)
{
    return r->verdict.after <= 1.15 * r->truth.error;
}
static bool has_errors(const struct blind_result *const r)
{
    return isfinite(r->verdict.before) && isfinite(r->verdict.after);
}
static bool made_worse(const struct blind_result *const r)
{
    return r->verdict.after > r->verdict.before * (1.0 + 1e-9);
}
static bool is_any(const struct blind_result *const r)
{
    (void)r;
    return true;
}
static bool is_quick(const struct blind_result *const r)
{
    return r->cpu_s <= 10.0 && r->peak_B <= 500e6;
}

static const struct criterion criteria[] = {
    { "no effect: false alarms", is_none, alarmed, 0.02, false },
    { "one effect, size 3 and more: named or in a small set", is_clear, is_right, 0.95, true },
    { "one effect, size about 1.5: named or in a small set", is_middling, is_right, 0.70, true },
    { "one effect, size below 1: something named with p > .5", is_faint, sure_of_any, 0.05, false },
    { "the same by the size in the soil alone: 3 and more", is_clear_in_soil, is_right, 0.95,
      true },
    { "  about 1.5", is_middling_in_soil, is_right, 0.70, true },
    { "  below 1: something named with p > .5", is_faint_in_soil, sure_of_any, 0.05, false },
    { "pairs, each of size 3 and more: both named", is_clear_pair, has_both, 0.80, true },
    { "outside the catalogue: a wrong name with p > .5", is_outside, sure_of_wrong, 0.05, false },
    { "outside the catalogue, size 3 and more: unlisted", is_clear_outside, is_unlisted, 0.80,
      true },
    { "one effect, size 3 and more: error after <= 1.15 of the oracle's", is_known, is_near_oracle,
      0.50, true },
    { "holdout error made worse", has_errors, made_worse, 0.02, false },
    { "traced in 10 s of one core and 500 MB", is_any, is_quick, 1.0, true },
};
#define CRITERIA (sizeof criteria / sizeof criteria[0])

static struct blind_share judge(const struct criterion *const c, const size_t n,
                                const struct blind_result result[])
{
    size_t about  = 0;
    size_t counts = 0;
    for (size_t i = 0; i < n; i++) {
        if (result[i].state == BLIND_TRACED && c->about(&result[i])) {
            about++;
            counts += c->counts(&result[i]) ? 1 : 0;
        }
    }
    return blind_share_of(counts, about);
}

static const char *holds(const struct criterion *const c, const struct blind_share *const s)
{
    if (s->n == 0) {
        return "not tried";
    }
    const double share = (double)s->k / (double)s->n;
    return (c->at_least ? share >= c->bound : share <= c->bound) ? "holds" : "DOES NOT HOLD";
}

static int compare(const void *const a, const void *const b)
{
    return (*(const double *)a > *(const double *)b) - (*(const double *)a < *(const double *)b);
}

// Median over campaigns of after / oracle and of before / oracle.
static void ratios(const size_t n, const struct blind_result                       result[],
                   bool (*const about)(const struct blind_result *), double *const before,
                   double *const after, size_t *const count)
{
    double *const b = calloc(n + 1, sizeof *b);
    double *const a = calloc(n + 1, sizeof *a);
    size_t        k = 0;
    for (size_t i = 0; i < n && a != NULL && b != NULL; i++) {
        const struct blind_result *const r = &result[i];
        if (r->state == BLIND_TRACED && about(r) && has_errors(r) && r->truth.error > 0.0) {
            b[k] = r->verdict.before / r->truth.error;
            a[k] = r->verdict.after / r->truth.error;
            k++;
        }
    }
    *count = k;
    if (k > 0) {
        qsort(a, k, sizeof *a, compare);
        qsort(b, k, sizeof *b, compare);
        *before = b[k / 2];
        *after  = a[k / 2];
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
        if (r->state != BLIND_TRACED || r->order.kind == BLIND_NONE ||
            r->order.kind == BLIND_PAIR || class_of(r) != class) {
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
                if (!justified(r, r->verdict.name[e])) {
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
                if (r->state == BLIND_TRACED && is_none(r) && r->by_machine == (machine == 1) &&
                    (strcmp(r->source, "ours") == 0) == (ours == 1)) {
                    all++;
                    false_ += alarmed(r) ? 1 : 0;
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
    (void)fprintf(to, "%zu campaigns traced, %zu failed, %zu could not be made\n",
                  count_state(n, result, BLIND_TRACED), count_state(n, result, BLIND_FAILED),
                  count_state(n, result, BLIND_UNMADE));
    print_none(n, result, to);
    for (int c = CLASSES - 1; c >= 0; c--) {
        print_class(n, result, c, to);
    }
    double before = 0.0;
    double after  = 0.0;
    size_t count  = 0;
    ratios(n, result, is_clear, &before, &after, &count);
    if (count > 0) {
        (void)fprintf(to,
                      "\nholdout error over the oracle's, medians of %zu campaigns with one effect "
                      "of size 3 and more: before %.2f, after %.2f\n",
                      count, before, after);
    }
    (void)fputs("\ncriterion\n", to);
    for (size_t i = 0; i < CRITERIA; i++) {
        const struct blind_share s = judge(&criteria[i], n, result);
        (void)fprintf(
            to, "  %-64s %s %4.0f %%: %4zu of %4zu = %5.1f %% (95 %%: %.1f to %.1f)  %s\n",
            criteria[i].title, criteria[i].at_least ? ">=" : "<=", 100.0 * criteria[i].bound, s.k,
            s.n, s.n == 0 ? 0.0 : 100.0 * (double)s.k / (double)s.n, 100.0 * s.low, 100.0 * s.high,
            holds(&criteria[i], &s));
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
    (void)fprintf(to, "], \"source\": \"%s\", \"machine\": %s, \"digs\": %zu, \"state\": %d",
                  r->source, r->by_machine ? "true" : "false", r->digs, (int)r->state);
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
    for (size_t i = 0; i < CRITERIA; i++) {
        const struct blind_share s = judge(&criteria[i], n, result);
        (void)fprintf(
            to, "%s\n {\"name\": \"%s\", \"bound\": %g, \"at_least\": %s, \"k\": %zu, \"n\": %zu",
            i == 0 ? "" : ",", criteria[i].title, criteria[i].bound,
            criteria[i].at_least ? "true" : "false", s.k, s.n);
        put_number(to, "low", s.low);
        put_number(to, "high", s.high);
        (void)fprintf(to, ", \"result\": \"%s\"}", holds(&criteria[i], &s));
    }
    (void)fputs("],\n \"campaigns\": [", to);
    for (size_t i = 0; i < n; i++) {
        (void)fputs(i == 0 ? "\n  " : ",\n  ", to);
        put_campaign(to, &result[i]);
    }
    (void)fputs("]}\n", to);
}

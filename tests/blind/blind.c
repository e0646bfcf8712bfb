// The blind bench: draws campaigns whose truth it keeps to itself, lets `digloop trace` answer, and
// says how right the answers were. README.md beside this file says what is drawn.

#include "core/effect.h"
#include "files/machine_yaml.h"
#include "tables/load.h"
#include "tests/blind/base.h"
#include "tests/blind/tally.h"

#include <errno.h>
#include <getopt.h>
#include <limits.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

static const char help[] =
    "usage: blind --table T.sqlite [options]      (from the root of the sources)\n"
    "\n"
    "  --bin DIR         where digloop and digrig are (build/bin)\n"
    "  --data DIR        where the digs are (tests/data)\n"
    "  --scene FILE      the scene that they were dug in (config/scenes/rig.yaml)\n"
    "  --cache DIR       for exact machine recordings, kept between calls (build/blind)\n"
    "  --split dev|judge seeds to develop with, or to judge with (dev)\n"
    "  --seed N          other seeds of that split: campaigns that no run has drawn before (0)\n"
    "  -n N              campaigns without an effect (100); those with one follow from it\n"
    "  -j N              at a time (1)\n"
    "  --only NAME       only campaigns with this effect, of this kind (none, single, pair,\n"
    "                    outside; machine-single, machine-pair: of the catalogue's effects of\n"
    "                    the machine), or the one of this number\n"
    "  --keep DIR        leave every campaign, its trace and its truth there (dev only)\n"
    "  --make            make the campaigns, trace none (with --keep)\n"
    "  --json FILE       everything, for programs\n"
    "\n"
    "exit codes: 0 done, whatever the criteria say; 1 it failed; 2 bad usage\n";

struct options {
    const char *table, *bin, *data, *scene, *cache, *split, *only, *keep, *json;
    size_t      n, jobs;
    uint64_t    seed;
    bool        make_only;
};

struct bench {
    struct options             o;
    const struct blind_site   *site;
    const struct blind_oracle *oracle;
    size_t                     orders;
    struct blind_order        *order;
    char                       digloop[PATH_MAX];
    char                       folder[PATH_MAX]; // of all campaigns
};

static int usage(const char *const what)
{
    (void)fprintf(stderr, "blind: %s\n%s", what, help);
    return 2;
}

static bool parse(const int argc, char *argv[], struct options *const options)
{
    enum { TABLE = 256, BIN, DATA, SCENE, CACHE, SPLIT, SEED, ONLY, KEEP, MAKE, JSON };
    static const struct option known[] = {
        { "table", required_argument, NULL, TABLE }, { "bin", required_argument, NULL, BIN },
        { "data", required_argument, NULL, DATA },   { "scene", required_argument, NULL, SCENE },
        { "cache", required_argument, NULL, CACHE }, { "split", required_argument, NULL, SPLIT },
        { "seed", required_argument, NULL, SEED },   { "only", required_argument, NULL, ONLY },
        { "keep", required_argument, NULL, KEEP },   { "make", no_argument, NULL, MAKE },
        { "json", required_argument, NULL, JSON },   { NULL, 0, NULL, 0 },
    };
    struct options o = { .bin   = "build/bin",
                         .data  = "tests/data",
                         .scene = "config/scenes/rig.yaml",
                         .cache = "build/blind",
                         .split = "dev",
                         .n     = 100,
                         .jobs  = 1 };
    for (int c; (c = getopt_long(argc, argv, "n:j:", known, NULL)) != -1;) {
        switch (c) {
        case TABLE: o.table = optarg; break;
        case BIN: o.bin = optarg; break;
        case DATA: o.data = optarg; break;
        case SCENE: o.scene = optarg; break;
        case CACHE: o.cache = optarg; break;
        case SPLIT: o.split = optarg; break;
        case SEED: o.seed = strtoull(optarg, NULL, 10); break;
        case ONLY: o.only = optarg; break;
        case KEEP: o.keep = optarg; break;
        case MAKE: o.make_only = true; break;
        case JSON: o.json = optarg; break;
        case 'n': o.n = (size_t)strtoul(optarg, NULL, 10); break;
        case 'j': o.jobs = (size_t)strtoul(optarg, NULL, 10); break;
        default: return false;
        }
    }
    *options = o;
    return optind == argc && o.table != NULL && o.jobs > 0 &&
           (strcmp(o.split, "dev") == 0 || strcmp(o.split, "judge") == 0) &&
           (!o.make_only || o.keep != NULL);
}

// Everything that can be put into a campaign: what the pool holds, and what formulas make.
static size_t choices(const struct blind_pool *const pool, struct blind_choice choice[],
                      size_t most)
{
    size_t n = 0;
    for (int m = 0; m < BLIND_MACHINE_EFFECTS && n < most; m++) {
        choice[n] = (struct blind_choice){ .how     = BLIND_BY_MACHINE,
                                           .which   = m,
                                           .outside = m >= BLIND_MACHINE_LISTED };
        (void)snprintf(choice[n++].name, DIG_NAME_SIZE, "%s",
                       blind_machine_effect_name((enum blind_machine_effect)m));
    }
    for (int s = 0; s < BLIND_SOIL_EFFECTS && n < most; s++) {
        choice[n] = (struct blind_choice){ .how     = BLIND_BY_GROUND,
                                           .which   = s,
                                           .outside = s >= BLIND_SOIL_LISTED };
        (void)snprintf(choice[n++].name, DIG_NAME_SIZE, "%s",
                       blind_soil_effect_name((enum blind_soil_effect)s));
    }
    for (size_t g = 0; g < pool->groups && n < most; g++) {
        const struct blind_group *const group = &pool->group[g];

        bool is_new = group->effect[0] != '\0' && group->beds >= 2;
        for (size_t i = 0; i < n && is_new; i++) {
            is_new = strcmp(choice[i].name, group->effect) != 0;
        }
        if (is_new) {
            choice[n] = (struct blind_choice){ .how = BLIND_BY_POOL, .outside = group->outside };
            (void)snprintf(choice[n++].name, DIG_NAME_SIZE, "%s", group->effect);
        }
    }
    return n;
}

#define CHOICES_MAX 64

struct plan {
    struct blind_choice choice[CHOICES_MAX];
    size_t              choices;
    uint64_t            seed;
    const char         *only;
    size_t              orders, most;
    struct blind_order *order;
    uint64_t            number;
};

// Whether all of a campaign's effects are of the machine.
static bool is_of_machine(const struct blind_order *const order)
{
    bool all = order->effects > 0;
    for (size_t e = 0; e < order->effects; e++) {
        all = all && order->effect[e].how == BLIND_BY_MACHINE;
    }
    return all;
}

// Numbers count what is left out too, so that a campaign is the same whatever --only says.
static void want(struct plan *const plan, const enum blind_kind kind, const int strength,
                 const struct blind_choice *const a, const struct blind_choice *const b)
{
    struct blind_order order = { .seed = plan->seed, .number = plan->number++, .kind = kind };
    order.strength           = strength;
    if (a != NULL) {
        order.effect[order.effects++] = *a;
    }
    if (b != NULL) {
        order.effect[order.effects++] = *b;
    }
    static const char *const name[BLIND_KINDS] = { "none", "single", "pair", "outside" };

    char number[24];
    (void)snprintf(number, sizeof number, "%llu", (unsigned long long)order.number);

    static const char *const machine = "machine-";

    const bool of_kind = plan->only != NULL && is_of_machine(&order) &&
                         strncmp(plan->only, machine, strlen(machine)) == 0 &&
                         strcmp(plan->only + strlen(machine), name[kind]) == 0;
    const bool this = plan->only == NULL || of_kind || strcmp(plan->only, name[kind]) == 0 ||
                      strcmp(plan->only, number) == 0 ||
                      (a != NULL && strcmp(plan->only, a->name) == 0) ||
                      (b != NULL && strcmp(plan->only, b->name) == 0);
    if (this && plan->orders < plan->most) {
        plan->order[plan->orders++] = order;
    }
}

static size_t at_least_one(const size_t n)
{
    return n > 0 ? n : 1;
}

static void schedule(struct plan *const plan, const size_t n)
{
    for (size_t i = 0; i < n; i++) {
        want(plan, BLIND_NONE, 0, NULL, NULL);
    }
    for (size_t c = 0; c < plan->choices; c++) {
        const struct blind_choice *const a = &plan->choice[c];
        for (int s = 0; s < BLIND_STRENGTHS; s++) {
            for (size_t i = 0; i < at_least_one(n / (a->outside ? 100 : 50)); i++) {
                want(plan, a->outside ? BLIND_OUTSIDE : BLIND_SINGLE, s, a, NULL);
            }
        }
    }
    struct blind_draw draw = blind_draw_init(plan->seed, UINT64_C(0xFFFFFFFF));
    for (size_t i = 0; i < n / 5;) {
        const struct blind_choice *const a = &plan->choice[blind_below(&draw, plan->choices)];
        const struct blind_choice *const b = &plan->choice[blind_below(&draw, plan->choices)];
        // One bed holds one effect of the pool.
        if (a != b && !a->outside && !b->outside &&
            !(a->how == BLIND_BY_POOL && b->how == BLIND_BY_POOL)) {
            want(plan, BLIND_PAIR, 2, a, b);
            i++;
        }
    }
}

static void remove_folder(const char *const folder)
{
    const char *const words[] = { "/bin/rm", "-rf", "--", folder, NULL };
    (void)blind_spawn(words, "/dev/null", 60, NULL, NULL);
}

// Of a log: why the program ended. Left as it is where there is none.
static void last_line(const char *const path, const size_t size, char line[])
{
    FILE *const file = fopen(path, "r");
    char        text[1024];
    while (file != NULL && fgets(text, sizeof text, file) != NULL) {
        text[strcspn(text, "\n")] = '\0';
        (void)snprintf(line, size, "%.*s", (int)size - 1, text);
    }
    if (file != NULL) {
        (void)fclose(file);
    }
}

static void trace(const struct bench *const bench, const char *const folder,
                  struct blind_result *const r)
{
    char json[PATH_MAX + 16];
    char log[PATH_MAX + 16];
    (void)snprintf(json, sizeof json, "%s/trace.json", folder);
    (void)snprintf(log, sizeof log, "%s/trace.log", folder);
    const char *const words[] = { bench->digloop, "trace", bench->o.table, folder, "--json",
                                  json,           NULL };
    const int         status  = blind_spawn(words, log, 300, &r->cpu_s, &r->peak_B);
    struct dig_error  error   = { "" };
    r->state                  = BLIND_FAILED;
    if (status == 2) {
        r->state = BLIND_REFUSED;
        last_line(log, sizeof r->why, r->why);
    } else if (status != 0) {
        (void)snprintf(r->why, sizeof r->why, "digloop ended with %d", status);
    } else if (blind_verdict_read(json, &r->verdict, &error) == DIG_OK) {
        r->state = BLIND_TRACED;
    } else {
        (void)snprintf(r->why, sizeof r->why, "%.*s", (int)sizeof r->why - 1, error.text);
    }
}

// The truth of a kept campaign, for whoever looks into it.
static void leave_truth(const char *const folder, const struct blind_result *const r)
{
    char path[PATH_MAX + 16];
    (void)snprintf(path, sizeof path, "%s/truth.txt", folder);
    FILE *const file = fopen(path, "w");
    if (file == NULL) {
        return;
    }
    for (size_t e = 0; e < r->order.effects; e++) {
        (void)fprintf(file, "%s strength %d size %.3g in the soil, %.3g in the air\n",
                      r->order.effect[e].name, r->order.strength, r->truth.size[e],
                      r->truth.size_air[e]);
    }
    (void)fprintf(file, "digs of %s, friction %g rolling %g density %g, magnitude %g\n", r->source,
                  r->gravel.value[0], r->gravel.value[1], r->gravel.value[2], r->magnitude);
    if (r->state == BLIND_TRACED) {
        (void)fprintf(file, "error before %.3f after %.3f oracle %.3f\n", r->verdict.before,
                      r->verdict.after, r->truth.error);
    }
    (void)fclose(file);
}

static struct blind_result play(const struct bench *const       bench,
                                const struct blind_order *const order)
{
    struct blind_result          r     = { .order = *order, .state = BLIND_UNMADE };
    struct blind_campaign *const c     = calloc(1, sizeof *c);
    struct dig_error             error = { "" };
    char                         folder[PATH_MAX];
    (void)snprintf(folder, sizeof folder, "%.*s/%05llu", PATH_MAX - 32, bench->folder,
                   (unsigned long long)order->number);
    if (c == NULL || (mkdir(folder, 0755) != 0 && errno != EEXIST) ||
        blind_campaign_make(bench->site, order, folder, c, &error) != DIG_OK) {
        (void)snprintf(r.why, sizeof r.why, "%.*s", (int)sizeof r.why - 1, error.text);
        free(c);
        return r;
    }
    (void)snprintf(r.source, sizeof r.source, "%s", c->group->source);
    r.gravel    = c->group->gravel;
    r.magnitude = c->group->magnitude;
    for (size_t e = 0; e < order->effects; e++) {
        r.magnitude = order->effect[e].how == BLIND_BY_GROUND ? c->ground[e].p[0] : r.magnitude;
    }
    r.by_machine = c->by_machine;
    r.digs       = c->digs;
    for (size_t d = 0; d < c->digs; d++) {
        r.other_simple = r.other_simple || c->dig[d].path == BLIND_OTHER_SIMPLE;
    }
    if (blind_oracle_judge(bench->oracle, c, &r.truth) != DIG_OK) {
        (void)snprintf(r.why, sizeof r.why, "the oracle has no gravel for it");
    } else if (bench->o.make_only) {
        r.state = BLIND_FAILED;
        (void)snprintf(r.why, sizeof r.why, "not asked for");
    } else {
        trace(bench, folder, &r);
    }
    free(c);
    if (bench->o.keep != NULL) {
        leave_truth(folder, &r);
    } else {
        remove_folder(folder);
    }
    return r;
}

_Static_assert(sizeof(struct blind_result) <= 4096, "one write to a pipe must be whole");

static void work(const struct bench *const bench, const size_t worker, const int to)
{
    for (size_t i = worker; i < bench->orders; i += bench->o.jobs) {
        const struct blind_result r = play(bench, &bench->order[i]);
        if (write(to, &r, sizeof r) != (ssize_t)sizeof r) {
            _exit(1);
        }
    }
    _exit(0);
}

static int by_number(const void *const a, const void *const b)
{
    const uint64_t x = ((const struct blind_result *)a)->order.number;
    const uint64_t y = ((const struct blind_result *)b)->order.number;
    return (x > y) - (x < y);
}

static size_t gather(const struct bench *const bench, struct blind_result result[])
{
    int ends[2];
    if (pipe(ends) != 0) {
        return 0;
    }
    (void)fflush(NULL);
    for (size_t w = 0; w < bench->o.jobs; w++) {
        if (fork() == 0) {
            (void)close(ends[0]);
            work(bench, w, ends[1]);
        }
    }
    (void)close(ends[1]);
    size_t n = 0;
    while (n < bench->orders &&
           read(ends[0], &result[n], sizeof *result) == (ssize_t)sizeof *result) {
        const struct blind_result *const r = &result[n++];
        if (r->state != BLIND_TRACED && !bench->o.make_only) {
            (void)fprintf(stderr, "\nblind: campaign %llu: %s\n",
                          (unsigned long long)r->order.number, r->why);
        }
        if (isatty(STDERR_FILENO)) {
            (void)fprintf(stderr, "\r%zu of %zu", n, bench->orders);
        }
    }
    (void)close(ends[0]);
    while (wait(NULL) > 0) {
    }
    qsort(result, n, sizeof *result, by_number);
    return n;
}

static int run(struct bench *const bench)
{
    struct blind_result *const result = calloc(bench->orders + 1, sizeof *result);
    if (result == NULL) {
        return 1;
    }
    const size_t n = gather(bench, result);
    blind_tally_print(n, result, stdout);
    int status = n == bench->orders ? 0 : 1;
    if (bench->o.json != NULL) {
        FILE *const file = fopen(bench->o.json, "w");
        if (file == NULL) {
            (void)fprintf(stderr, "blind: %s: %s\n", bench->o.json, strerror(errno));
            status = 1;
        } else {
            blind_tally_json(n, result, bench->o.split, file);
            (void)fclose(file);
        }
    }
    free(result);
    return status;
}

static enum dig_status find_site(const struct options *const       o,
                                 const struct dig_curve_set *const set,
                                 struct blind_site *const site, struct dig_error *const error)
{
    static const char *const machine[BLIND_MACHINES] = { "config/machines/zx200_trench.yaml",
                                                         "config/machines/mini_2t8.yaml" };
    static char              scene[PATH_MAX];
    char                     here[256];
    enum dig_status          status = DIG_OK;
    if (getcwd(here, sizeof here) == NULL) {
        return dig_error_set(error, DIG_EIO, "here: %s", strerror(errno));
    }
    (void)snprintf(scene, sizeof scene, "%s%s%s", o->scene[0] == '/' ? "" : here,
                   o->scene[0] == '/' ? "" : "/", o->scene);
    site->scene   = scene;
    site->tooth_m = set->tooth_m;
    site->cache   = o->cache;
    for (int m = 0; m < BLIND_MACHINES && status == DIG_OK; m++) {
        (void)snprintf(site->machine_path[m], sizeof site->machine_path[m], "%s/%s", here,
                       machine[m]);
        status = dig_machine_read(machine[m], &site->machine[m], error);
    }
    for (int p = 0; p < BLIND_PATHS; p++) {
        for (size_t t = 0; t < set->trajectories; t++) {
            if (strcmp(set->trajectory[t].name, blind_path_name((enum blind_path)p)) == 0) {
                site->trajectory[p] = &set->trajectory[t];
            }
        }
    }
    return status;
}

static int bench_with(const struct options *const o, const struct dig_curve_set *const set,
                      const struct blind_pool *const pool)
{
    static struct bench  bench;
    struct dig_error     error = { "" };
    char                 digrig[PATH_MAX];
    char                 temporary[PATH_MAX];
    struct blind_site    site   = { .pool = pool, .digrig = digrig };
    struct blind_oracle *oracle = NULL;
    struct plan          plan   = { .only = o->only, .most = 100 * o->n + 10000 };
    (void)snprintf(digrig, sizeof digrig, "%s/digrig", o->bin);
    (void)snprintf(bench.digloop, sizeof bench.digloop, "%s/digloop", o->bin);
    (void)snprintf(temporary, sizeof temporary, "%s/blind_XXXXXX",
                   getenv("TMPDIR") != NULL ? getenv("TMPDIR") : "/tmp");
    plan.seed = (strcmp(o->split, "dev") == 0 ? UINT64_C(20260101) : UINT64_C(77001977)) +
                o->seed * UINT64_C(0x9E3779B97F4A7C15);
    plan.choices = choices(pool, plan.choice, CHOICES_MAX);
    plan.order   = calloc(plan.most, sizeof *plan.order);
    if (plan.order == NULL || blind_oracle_create(set, &oracle, &error) != DIG_OK ||
        find_site(o, set, &site, &error) != DIG_OK) {
        (void)fprintf(stderr, "blind: %s\n", error.text);
        free(plan.order);
        blind_oracle_destroy(oracle);
        return 1;
    }
    schedule(&plan, o->n);
    bench.o                  = *o;
    bench.site               = &site;
    bench.oracle             = oracle;
    bench.orders             = plan.orders;
    bench.order              = plan.order;
    const char *const folder = o->keep != NULL ? o->keep : mkdtemp(temporary);
    int               status = 1;
    if (folder != NULL && (mkdir(folder, 0755) == 0 || errno == EEXIST)) {
        (void)snprintf(bench.folder, sizeof bench.folder, "%s", folder);
        status = run(&bench);
    }
    if (o->keep == NULL && folder != NULL) {
        remove_folder(folder);
    }
    free(plan.order);
    blind_oracle_destroy(oracle);
    return status;
}

int main(const int argc, char *argv[])
{
    struct options o;
    if (!parse(argc, argv, &o)) {
        return usage("bad usage");
    }
    if (o.keep != NULL && strcmp(o.split, "judge") == 0) {
        return usage("campaigns to judge with are not kept, so that nobody looks into them");
    }
    struct dig_error      error = { "" };
    struct dig_curve_set *set   = NULL;
    struct blind_pool     pool  = { 0, NULL };
    if ((mkdir(o.cache, 0755) != 0 && errno != EEXIST) ||
        dig_table_load(o.table, &set, &error) != DIG_OK ||
        blind_pool_read(o.data, strcmp(o.split, "judge") == 0, &pool, &error) != DIG_OK) {
        (void)fprintf(stderr, "blind: %s\n", error.text[0] != '\0' ? error.text : strerror(errno));
        dig_curve_set_destroy(set);
        return 1;
    }
    const int status = bench_with(&o, set, &pool);
    blind_pool_finish(&pool);
    dig_curve_set_destroy(set);
    return status;
}

// How often the check of a machine file in free air names what is broken, and how often it calls
// something wrong that is not: every machine that ships, broken in one way at a time, with seeds of
// sensor noise that no test uses.
//
//   build/tests/bench/air [SEEDS [MACHINE [BREAK [FRICTION [stand]]]]]
//
// MACHINE, BREAK: parts of names; with them, line by line. FRICTION: of every drive's seals, as a
// share of its largest push; stand: they hold a rod that stands, too.

#include "tests/broken_air.h"

#include <time.h>

enum { FIRST_SEED = 100 };

struct tally {
    int runs, named, alone, tied;
};

static double now_s(void)
{
    struct timespec t;
    (void)clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void say(const struct dig_check_item *const item)
{
    printf(
        "    question %d of %d: verdict %d, %.4g +- %.3g (allowed %.3g), %.3g sigma, or line %d\n",
        (int)item->question, item->of, (int)item->verdict, item->value, item->sigma,
        item->tolerance, item->excess, item->or_item);
}

static void judge(const struct dig_machine_air_check *const check,
                  const struct air_break *const broken, struct tally *const tally, const bool loud)
{
    const bool named  = broken == NULL || air_is_named(check, broken);
    const bool others = air_says_more(check, broken);
    bool       tied   = false;
    for (size_t i = 0; i < check->items; i++) {
        const struct dig_check_item *const item = &check->item[i];
        const bool                         mine = broken != NULL && air_is_asked(item, broken);
        tied                                    = tied || (mine && item->or_item >= 0);
        if (loud && (item->verdict >= DIG_CHECK_DOUBTFUL || (mine && !named))) {
            say(item);
        }
    }
    tally->runs++;
    tally->named += named ? 1 : 0;
    tally->alone += named && !others ? 1 : 0;
    tally->tied += tied ? 1 : 0;
}

struct bench {
    const char  *machine, *which; // parts of names
    bool         loud;
    double       spent_s;
    struct tally tally[AIR_BREAKS + 1]; // the last: nothing is broken
};

static bool check_all(struct bench *const bench, const char *const name,
                      const struct dig_machine *const   machine,
                      const struct dig_rig_track *const track, const uint64_t seed)
{
    for (size_t b = 0; b <= AIR_BREAKS; b++) {
        const struct air_break *const broken = b < AIR_BREAKS ? &air_breaks[b] : NULL;
        const char *const             what   = broken != NULL ? broken->name : "nothing";
        struct dig_machine_air_check  check;
        struct dig_error              error = { "" };
        if (strstr(what, bench->which) == NULL) {
            continue;
        }
        struct dig_machine_recording recording = air_record(machine, track, broken, seed);
        const struct dig_machine     file      = air_file(machine, broken);
        const double                 from_s    = now_s();
        if (dig_machine_air_check_run(&file, &recording, &check, &error) != DIG_OK) {
            fprintf(stderr, "%s, %s: %s\n", name, what, error.text);
            return false;
        }
        bench->spent_s += now_s() - from_s;
        if (bench->loud) {
            printf("%s, %s, seed %d:\n", name, what, (int)seed);
        }
        judge(&check, broken, &bench->tally[b], bench->loud);
        dig_machine_air_check_finish(&check);
        dig_machine_recording_finish(&recording);
    }
    return true;
}

int main(const int argc, char *argv[])
{
    const uint64_t seeds = argc > 1 ? strtoull(argv[1], NULL, 10) : 3;
    struct bench   bench = { .machine = argc > 2 ? argv[2] : "",
                             .which   = argc > 3 ? argv[3] : "",
                             .loud    = argc > 2 };
    const double   rubs  = argc > 4 ? strtod(argv[4], NULL) : 0.0;
    const bool     stand = argc > 5 && strcmp(argv[5], "stand") == 0;
    for (size_t m = 0; m < AIR_MACHINES; m++) {
        struct dig_machine   machine;
        struct dig_rig_track track;
        struct dig_error     error = { "" };
        if (strstr(air_machines[m], bench.machine) == NULL) {
            continue;
        }
        if (!air_move(air_machines[m], &machine, &track, &error)) {
            fprintf(stderr, "%s: %s\n", air_machines[m], error.text);
            return EXIT_FAILURE;
        }
        air_rub(&machine, &track, rubs, stand);
        for (uint64_t seed = 0; seed < seeds; seed++) {
            if (!check_all(&bench, air_machines[m], &machine, &track, FIRST_SEED + seed)) {
                return EXIT_FAILURE;
            }
        }
        dig_rig_track_finish(&track);
    }
    struct tally all = { 0 };
    printf("%-40s %5s %6s %12s %5s\n", "broken", "runs", "named", "nothing else", "tied");
    for (size_t b = 0; b <= AIR_BREAKS; b++) {
        const struct tally *const t = &bench.tally[b];
        if (t->runs > 0) {
            printf("%-40s %5d %6d %12d %5d\n", b < AIR_BREAKS ? air_breaks[b].name : "nothing",
                   t->runs, t->named, t->alone, t->tied);
        }
        if (b < AIR_BREAKS) {
            all.runs += t->runs;
            all.named += t->named;
            all.alone += t->alone;
            all.tied += t->tied;
        }
    }
    const struct tally *const right = &bench.tally[AIR_BREAKS];
    printf("broken: named %d of %d, nothing else %d of %d, with another answer %d of %d\n",
           all.named, all.runs, all.alone, all.runs, all.tied, all.runs);
    printf("nothing broken: nothing said %d of %d\n", right->alone, right->runs);
    printf("%.2f s of one core a check\n", bench.spent_s / fmax(1.0, all.runs + right->runs));
    return EXIT_SUCCESS;
}

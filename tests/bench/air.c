// How often the check of a machine file in free air names what is broken, and how often it says
// that something is where nothing is. See --help.

#include "tests/broken_air.h"

#include <time.h>

struct tally {
    int runs, named, alone, doubtful;
};

static double now_s(void)
{
    struct timespec t;
    (void)clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void say(const struct dig_check_item *const item)
{
    printf("      question %d of %d: verdict %d, %.4g +- %.3g (tolerance %.3g), excess %.3g, or %d\n",
           (int)item->question, item->of, (int)item->verdict, item->value, item->sigma,
           item->tolerance, item->excess, item->or_item);
}

static void judge(const struct dig_machine_air_check *const check,
                  const struct air_break *const broken, struct tally *const tally, const bool loud)
{
    bool   named = broken == NULL, others = false, doubts = false;
    for (size_t i = 0; i < check->items; i++) {
        const struct dig_check_item *const item = &check->item[i];
        const bool mine = broken != NULL && item->question == broken->asked && item->of == broken->found;
        if (mine) {
            named  = item->verdict == broken->verdict;
            doubts = item->verdict == DIG_CHECK_DOUBTFUL && !named;
        }
        const bool same_kind = broken != NULL && item->question == broken->asked;
        if (!mine && !same_kind && item->verdict >= DIG_CHECK_DOUBTFUL) {
            others = true;
        }
        if (loud && (item->verdict >= DIG_CHECK_DOUBTFUL || (mine && !named))) {
            say(item);
        }
    }
    tally->runs++;
    tally->named += named ? 1 : 0;
    tally->alone += named && !others ? 1 : 0;
    tally->doubtful += doubts ? 1 : 0;
}

int main(const int argc, char *argv[])
{
    const uint64_t    seeds = argc > 1 ? strtoull(argv[1], NULL, 10) : 1;
    const char *const only  = argc > 2 ? argv[2] : "";
    const char *const which = argc > 3 ? argv[3] : "";
    const bool        loud  = argc > 2;
    struct tally      tally[AIR_BREAKS + 1] = { { 0 } };
    double            spent_s = 0.0;
    for (size_t m = 0; m < AIR_MACHINES; m++) {
        struct dig_machine   machine;
        struct dig_rig_track track;
        struct dig_error     error = { "" };
        if (strstr(air_machines[m], only) == NULL) {
            continue;
        }
        if (!air_move(air_machines[m], &machine, &track, &error)) {
            fprintf(stderr, "%s: %s\n", air_machines[m], error.text);
            continue;
        }
        for (uint64_t seed = 1; seed <= seeds; seed++) {
            for (size_t b = 0; b <= AIR_BREAKS; b++) {
                const struct air_break *const broken = b > 0 ? &air_breaks[b - 1] : NULL;
                const char *const name = broken != NULL ? broken->name : "nothing";
                if (strstr(name, which) == NULL) {
                    continue;
                }
                struct dig_machine_recording recording = air_record(&machine, &track, broken, seed);
                const struct dig_machine     file      = air_file(&machine, broken);
                struct dig_machine_air_check check;
                const double                 from_s = now_s();
                if (loud) {
                    printf("%s, %s:\n", air_machines[m], name);
                }
                if (dig_machine_air_check_run(&file, &recording, &check, &error) != DIG_OK) {
                    fprintf(stderr, "%s, %s: %s\n", air_machines[m], name, error.text);
                    return EXIT_FAILURE;
                }
                spent_s += now_s() - from_s;
                judge(&check, broken, &tally[b], loud);
                if (loud) { printf("      rest %.2f %.2f %.2f -> %.2f %.2f %.2f; %.2f s\n", check.rest_plain[0], check.rest_plain[1], check.rest_plain[2],
                    check.item[check.items-3].value, check.item[check.items-2].value, check.item[check.items-1].value, now_s() - from_s); fflush(stdout); }
                dig_machine_air_check_finish(&check);
                dig_machine_recording_finish(&recording);
            }
        }
        dig_rig_track_finish(&track);
    }
    int runs = 0;
    for (size_t b = 0; b <= AIR_BREAKS; b++) {
        const struct tally *const t = &tally[b];
        runs += t->runs;
        if (t->runs > 0) {
            printf("%-40s named %3d of %3d, nothing else %3d, doubtful %d\n",
                   b > 0 ? air_breaks[b - 1].name : "nothing", t->named, t->runs, t->alone, t->doubtful);
        }
    }
    printf("%.1f s of one core a check\n", spent_s / (runs > 0 ? runs : 1));
    return EXIT_SUCCESS;
}

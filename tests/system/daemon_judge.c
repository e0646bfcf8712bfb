// Judges what a daemon published against what was really there:
//   daemon_judge LOG.lcm TRUTH.csv FRICTION ROLLING DENSITY
// TRUTH.csv is `digrig record --truth`'s. Prints a line for all, and one for each dig as the daemon
// counts them:
//   all ESTIMATES WRONG WORST_sigmas MATCHES WRONG_MATCHES PREDICTIONS WRONG_PREDICTIONS
//   dig N ESTIMATES WRONG WORST_sigmas MATCHED 0|1
// and, asked for by two more arguments FROM_s and LENGTH_s of the truth's time, how many are wrong
// then:
//   within WRONG
//
// An estimate said to be valid is wrong when no moment that was there at that pose of the bucket,
// within 1.5 s of it (machine time: the clocks are brought together by the pose), is within 5
// sigma. A match said to be valid and not outside is wrong when an axis' interval, widened by half,
// misses the truth; a prediction when its peak is off the truth's by more than a third.

#include "files/lcm/lcm_log.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define NEAR_s  1.5
#define ROWS    200000
#define DIGS    64
#define STEP_s  0.002
#define RANGE_s 15.0

struct row {
    double t_s, X_m, Z_m, phi_rad, My_Nm;
};

struct judge {
    size_t     rows, estimates, matches, wrong_matches, predictions, wrong_predictions;
    int        dig[ROWS]; // finished before the estimate
    bool       matched[DIGS];
    struct row truth[ROWS], seen[ROWS];
    double     sigma_Nm[ROWS], gravel[3], peak_Nm;
};

static bool misses(const double truth, const double low, const double high)
{
    const double margin = 0.5 * (high - low) + 0.02 * truth;
    return truth < low - margin || truth > high + margin;
}

static void estimate(void *const context, const int64_t time_us, const digsight_estimate_t *const m)
{
    struct judge *const j = context;
    (void)time_us;
    if (m->moment_valid && j->estimates < ROWS) {
        j->sigma_Nm[j->estimates] = m->sigma_moment_Nm;
        j->dig[j->estimates]      = m->dig_count;
        j->seen[j->estimates++]   = (struct row){ 1e-9 * (double)m->time_ns, m->pin_X_m, m->pin_Z_m,
                                                  m->bucket_phi_rad, m->moment_Nm };
    }
}

static void match(void *const context, const int64_t time_us, const digsight_match_t *const m)
{
    struct judge *const j = context;
    (void)time_us;
    if (m->valid && !m->outside) {
        j->matches++;
        const bool right = !misses(j->gravel[0], m->friction_low, m->friction_high) &&
                           !misses(j->gravel[1], m->rolling_low, m->rolling_high) &&
                           !misses(j->gravel[2], m->density_low_kgpm3, m->density_high_kgpm3);
        j->wrong_matches += right ? 0 : 1;
        j->matched[m->dig_count % DIGS] |= right;
    }
}

static void prediction(void *const context, const int64_t time_us,
                       const digsight_prediction_t *const m)
{
    struct judge *const j = context;
    (void)time_us;
    if (m->valid && !m->outside && strcmp(m->trajectory, "simpleA") == 0) {
        j->predictions++;
        j->wrong_predictions += fabs(m->peak_Nm / j->peak_Nm - 1.0) > 1.0 / 3.0 ? 1 : 0;
    }
}

static int read_truth(const char *const path, struct judge *const j)
{
    char        line[256];
    FILE *const file = fopen(path, "r");
    if (file == NULL || fgets(line, sizeof line, file) == NULL) {
        return -1;
    }
    while (j->rows < ROWS && fgets(line, sizeof line, file) != NULL) {
        struct row *const r = &j->truth[j->rows];
        double            force[2];
        j->rows += sscanf(line, "%lf,%lf,%lf,%lf,%lf,%lf,%lf", &r->t_s, &r->X_m, &r->Z_m,
                          &r->phi_rad, &force[0], &force[1], &r->My_Nm) == 7;
        j->peak_Nm = fmax(j->peak_Nm, r->My_Nm);
    }
    (void)fclose(file);
    return j->rows > 1 ? 0 : -1;
}

static const struct row *truth_at(const struct judge *const j, const double t_s)
{
    const double step_s = j->truth[1].t_s - j->truth[0].t_s;
    const double at     = fmin(fmax(t_s / step_s, 0.0), (double)j->rows - 1.0);
    return &j->truth[(size_t)at];
}

static double misfit(const struct judge *const j, const double shift_s)
{
    double sum = 0.0;
    for (size_t i = 0; i < j->estimates; i += 16) {
        const struct row *const e = &j->seen[i];
        const struct row *const t = truth_at(j, e->t_s - shift_s);
        sum += fmin(fabs(e->X_m - t->X_m) + fabs(e->Z_m - t->Z_m) + fabs(e->phi_rad - t->phi_rad),
                    0.5);
    }
    return sum;
}

// The daemon's time at the truth's zero. The bucket is let stand first: when it begins to move is
// known to a second or so.
static double find_shift(const struct judge *const j)
{
    size_t moves = 0;
    while (moves + 1 < j->estimates && fabs(j->seen[moves].phi_rad - j->seen[0].phi_rad) < 0.05) {
        moves++;
    }
    size_t begins = 0;
    while (begins + 1 < j->rows && fabs(j->truth[begins].phi_rad - j->truth[0].phi_rad) < 0.05) {
        begins++;
    }
    const double about_s = j->seen[moves].t_s - j->truth[begins].t_s;
    double       best_s  = about_s;
    double       least   = INFINITY;
    for (double s = about_s - RANGE_s; s < about_s + RANGE_s; s += STEP_s) {
        const double sum = misfit(j, s);
        if (sum < least) {
            least  = sum;
            best_s = s;
        }
    }
    return best_s;
}

static double sigmas_off(const struct judge *const j, const size_t i, const double shift_s)
{
    const struct row *const e   = &j->seen[i];
    double                  off = INFINITY;
    for (double d = -NEAR_s; d <= NEAR_s; d += 0.005) {
        const struct row *const t = truth_at(j, e->t_s - shift_s + d);
        if (fabs(t->X_m - e->X_m) + fabs(t->Z_m - e->Z_m) < 0.1 &&
            fabs(t->phi_rad - e->phi_rad) < 0.05) {
            off = fmin(off, fabs(e->My_Nm - t->My_Nm) / j->sigma_Nm[i]);
        }
    }
    return off;
}

int main(const int argc, char *argv[])
{
    struct judge *const         j      = calloc(1, sizeof *j);
    const struct dig_lcm_reader reader = {
        .context = j, .estimate = estimate, .match = match, .prediction = prediction
    };
    struct dig_error error = { "" };
    if (j == NULL || (argc != 6 && argc != 8) || read_truth(argv[2], j) != 0) {
        (void)fprintf(stderr, "usage: daemon_judge LOG.lcm TRUTH.csv FRICTION ROLLING DENSITY "
                              "[FROM_s LENGTH_s]\n");
        return 2;
    }
    for (int a = 0; a < 3; a++) {
        j->gravel[a] = strtod(argv[3 + a], NULL);
    }
    if (dig_lcm_log_each(argv[1], &reader, &error) != DIG_OK || j->estimates == 0) {
        (void)fprintf(stderr, "daemon_judge: %s\n", error.text[0] ? error.text : "no estimates");
        return 1;
    }
    const double shift_s  = find_shift(j);
    const double from_s   = argc == 8 ? strtod(argv[6], NULL) : 0.0;
    const double length_s = argc == 8 ? strtod(argv[7], NULL) : 0.0;
    size_t       within   = 0;
    size_t       wrong = 0, of_dig[DIGS] = { 0 }, wrong_of[DIGS] = { 0 };
    double       worst = 0.0, worst_of[DIGS] = { 0 };
    int          digs = 0;
    for (size_t i = 0; i < j->estimates; i++) {
        const double off  = sigmas_off(j, i, shift_s);
        const int    d    = (j->dig[i] + 1) % DIGS;
        digs              = j->dig[i] > digs ? j->dig[i] : digs;
        const double at_s = j->seen[i].t_s - shift_s;
        within += off > 5.0 && at_s >= from_s && at_s < from_s + length_s ? 1 : 0;
        wrong += off > 5.0 ? 1 : 0;
        wrong_of[d] += off > 5.0 ? 1 : 0;
        of_dig[d]++;
        worst       = fmax(worst, off);
        worst_of[d] = fmax(worst_of[d], off);
    }
    (void)printf("all %zu %zu %.2f %zu %zu %zu %zu\n", j->estimates, wrong, worst, j->matches,
                 j->wrong_matches, j->predictions, j->wrong_predictions);
    for (int d = 1; d <= digs && d < DIGS; d++) {
        (void)printf("dig %d %zu %zu %.2f %d\n", d, of_dig[d], wrong_of[d], worst_of[d],
                     j->matched[d]);
    }
    if (argc == 8) {
        (void)printf("within %zu\n", within);
    }
    free(j);
    return 0;
}

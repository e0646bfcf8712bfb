#include "tests/offline_dem/phase_means.h"

#include "tests/read.h"

#include <unistd.h>

const char *const phase_channel_name[PHASE_CHANNELS] = { "My", "Fx", "Fz" };

// One dig's windows, summed by phase.
struct dig_sums {
    int    windows[DIG_PHASES_MAX];
    double sum[DIG_PHASES_MAX][PHASE_CHANNELS];
};

static void add_window(struct dig_sums *const s, const struct dig_trajectory *const t,
                       const double t_s, const double value[PHASE_CHANNELS])
{
    const size_t p = dig_trajectory_phase(t, t_s);
    s->windows[p]++;
    for (int c = 0; c < PHASE_CHANNELS; c++) {
        s->sum[p][c] += value[c];
    }
}

static void add_bed(struct phase_means *const means, const struct dig_sums *const s,
                    const size_t phases)
{
    means->beds++;
    for (size_t p = 0; p < phases; p++) {
        for (int c = 0; c < PHASE_CHANNELS; c++) {
            const double mean = s->sum[p][c] / s->windows[p];
            means->sum[p][c] += mean;
            means->sum2[p][c] += mean * mean;
        }
    }
}

void phase_means_add_run(struct phase_means *const          means,
                         const struct dig_trajectory *const trajectory,
                         const struct dig_run *const        run)
{
    struct dig_sums sums = { 0 };
    for (size_t i = 0; i < run->windows; i++) {
        double value[PHASE_CHANNELS];
        for (size_t c = 0; c < PHASE_CHANNELS; c++) {
            value[c] = (double)run->value[c * run->windows + i];
        }
        add_window(&sums, trajectory, run->first_s + (double)i * run->step_s, value);
    }
    add_bed(means, &sums, trajectory->phases);
}

void phase_means_add_recording(struct phase_means *const          means,
                               const struct dig_trajectory *const trajectory,
                               const struct dig_recording *const  recording)
{
    struct dig_sums sums = { 0 };
    for (size_t i = 0; i < recording->rows; i++) {
        const struct dig_force_row *const row = &recording->row[i];
        add_window(&sums, trajectory, row->t_s,
                   (const double[]){ row->My_Nm, row->Fx_N, row->Fz_N });
    }
    add_bed(means, &sums, trajectory->phases);
}

bool phase_means_add_file(struct phase_means *const          means,
                          const struct dig_trajectory *const trajectory, const char *const path)
{
    if (access(path, R_OK) != 0) {
        return false;
    }
    struct dig_recording r = read_recording(path);
    phase_means_add_recording(means, trajectory, &r);
    dig_recording_finish(&r);
    return true;
}

double phase_means_mean(const struct phase_means *const means, const size_t phase,
                        const int channel)
{
    return means->sum[phase][channel] / means->beds;
}

double phase_means_spread(const struct phase_means *const means, const size_t phase,
                          const int channel)
{
    const double n    = means->beds;
    const double mean = phase_means_mean(means, phase, channel);
    return sqrt(fmax(means->sum2[phase][channel] / n - mean * mean, 0.0) * n / (n - 1.0));
}

double phase_means_largest(const struct phase_means *const    means,
                           const struct dig_trajectory *const trajectory, const int channel)
{
    double most = 0.0;
    for (size_t p = 0; p < trajectory->phases; p++) {
        most = fmax(most, fabs(phase_means_mean(means, p, channel)));
    }
    return most;
}

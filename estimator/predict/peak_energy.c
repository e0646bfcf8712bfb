#include "estimator/predict/peak_energy.h"

#include "estimator/predict/predict.h"

#include <assert.h>
#include <math.h>
#include <stdint.h>

void dig_peak_energy_weights(const struct dig_trajectory *const trajectory, const double tooth_m,
                             struct dig_channels *const weight)
{
    assert(trajectory != NULL && weight != NULL);
    struct dig_channels sum    = { { { 0.0 } } };
    struct dig_pose     before = dig_trajectory_pose(trajectory, 0.0);
    for (size_t k = 1; k < DIG_CURVE_POINTS; k++) {
        const double          progress = (double)k / (DIG_CURVE_POINTS - 1);
        const double          time_s   = dig_trajectory_time_s(trajectory, tooth_m, progress);
        const struct dig_pose pose     = dig_trajectory_pose(trajectory, time_s);

        const double step[DIG_FORCE_CHANNELS] = {
            [DIG_CHANNEL_MY_Nm] = pose.theta_rad - before.theta_rad,
            [DIG_CHANNEL_FX_N]  = before.x_m - pose.x_m,
            [DIG_CHANNEL_FZ_N]  = before.z_m - pose.z_m,
        };
        for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
            sum.of[c][k - 1] += 0.5 * step[c];
            sum.of[c][k] += 0.5 * step[c];
        }
        before = pose;
    }
    *weight = sum;
}

// Draws of a peak, each with its antithetic one, over all gravels: the mean of so many is off
// by a twelfth of what one scatters by, at most.
enum { DRAWN_PAIRS = 128 };

// Of digs in one gravel: what is to be expected, and the variance of one.
struct expected {
    double mean, variance;
};

static double larger(const double a, const double b)
{
    return a > b ? a : b;
}

// Of some of the draws; the seed moves on.
static struct expected peak_Nm(const struct dig_cell *const cell, const double mean_Nm[],
                               const double sd_Nm[], const struct dig_entry_scatter *const scatter,
                               const size_t pairs, uint64_t *const seed)
{
    const double within  = sqrt(fmax(1.0 - cell->mean_variance, 0.0));
    const double widened = sqrt(1.0 + cell->inverse_packings);
    double       sum     = 0.0; // of peaks as they are to be expected
    double       wide    = 0.0; // of peaks about a mean that is off itself, and their squares
    double       wide2   = 0.0;
    for (size_t d = 0; d < pairs; d++) {
        double error[DIG_CURVE_POINTS];
        dig_entry_scatter_draw(scatter, seed, error);
        // NOLINTNEXTLINE(readability-isolate-declaration)
        double up = -INFINITY, down = -INFINITY, more = -INFINITY, less = -INFINITY;
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            const double one = sd_Nm[k] * error[k];
            up               = larger(up, mean_Nm[k] + within * one);
            down             = larger(down, mean_Nm[k] - within * one);
            more             = larger(more, mean_Nm[k] + widened * one);
            less             = larger(less, mean_Nm[k] - widened * one);
        }
        sum += up + down;
        wide += more + less;
        wide2 += more * more + less * less;
    }
    // The variance of so few is that of the draws about their own mean, which lies nearer to them.
    const double n    = 2.0 * (double)pairs;
    const double off2 = fmax(wide2 / n - (wide / n) * (wide / n), 0.0);
    return (struct expected){ .mean = sum / n, .variance = off2 * n / (n - 1.0) };
}

static struct expected energy_J(const struct dig_cell *const          cell,
                                const struct dig_channels *const      weight,
                                const struct dig_channels *const      mean,
                                const struct dig_channels *const      sd,
                                const struct dig_entry_scatter *const scatter)
{
    double              sum = 0.0;
    struct dig_channels one;
    for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            sum += weight->of[c][k] * mean->of[c][k];
            one.of[c][k] = weight->of[c][k] * sd->of[c][k];
        }
    }
    const double widened2 = 1.0 + cell->inverse_packings;
    return (struct expected){ .mean     = sum,
                              .variance = widened2 * dig_entry_scatter_variance(scatter, &one) };
}

// Over gravels that are equally likely.
struct total {
    double gravels, sum, sum2, within2;
};

static void add(struct total *const total, const struct expected one)
{
    total->gravels += 1.0;
    total->sum += one.mean;
    total->sum2 += one.mean * one.mean;
    total->within2 += one.variance;
}

static double mean_of(const struct total *const total)
{
    return total->sum / total->gravels;
}

static double sigma_of(const struct total *const total)
{
    const double mean = mean_of(total);
    return sqrt(total->within2 / total->gravels +
                fmax(total->sum2 / total->gravels - mean * mean, 0.0));
}

enum dig_status dig_peak_energy_predict(const struct dig_curve_set *const set,
                                        const struct dig_match *const     match,
                                        const size_t                      trajectory,
                                        struct dig_peak_energy *const     whole)
{
    assert(set != NULL && match != NULL && whole != NULL);
    struct dig_cell       cell[DIG_MATCH_SAMPLES];
    size_t                cells  = 0;
    const enum dig_status status = dig_predict_cells(set, match, trajectory, cell, &cells);
    if (status != DIG_OK) {
        return status;
    }
    struct dig_entry_scatter scatter;
    struct dig_channels      weight;
    dig_entry_scatter_make(&set->trajectory[trajectory], set->tooth_m, &scatter);
    dig_peak_energy_weights(&set->trajectory[trajectory], set->tooth_m, &weight);

    const size_t pairs  = (DRAWN_PAIRS + cells - 1) / cells;
    uint64_t     seed   = 1; // the same draws at every call
    struct total peak   = { .gravels = 0.0 };
    struct total energy = { .gravels = 0.0 };
    for (size_t i = 0; i < cells; i++) {
        struct dig_channels mean;
        struct dig_channels sd;
        for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
            dig_cell_blend(&cell[i], (enum dig_channel)c, mean.of[c], sd.of[c]);
        }
        add(&peak, peak_Nm(&cell[i], mean.of[DIG_CHANNEL_MY_Nm], sd.of[DIG_CHANNEL_MY_Nm], &scatter,
                           pairs, &seed));
        add(&energy, energy_J(&cell[i], &weight, &mean, &sd, &scatter));
    }
    *whole = (struct dig_peak_energy){
        .peak_Nm        = mean_of(&peak),
        .peak_sigma_Nm  = sigma_of(&peak),
        .energy_J       = mean_of(&energy),
        .energy_sigma_J = sigma_of(&energy),
    };
    return DIG_OK;
}

// From a force recording through the rig's machine (virtual work) and the estimator (force balance)
// back to the force recording: digs of another DEM code, on the machines that ship.

#include "estimator/estimator.h"

#include "estimator/wrench/wrench.h"
#include "tests/made_table.h"
#include "tests/read.h"
#include "tools/rig/motion/track.h"
#include "tools/rig/sensors.h"

#include <stdlib.h>
#include <string.h>

enum { GRAVELS = 3, DIGS = 2, KINDS = 3, PARTS = 3 };
static const char *const gravels[GRAVELS] = { "0.3", "0.5", "0.9" };
static const char *const kinds[KINDS]     = { "simpleA", "actual", "simpleB" };
static const char *const parts[PARTS]     = { "My", "Fx", "Fz" };

static void scale(struct dig_recording *const recording, const double share)
{
    for (size_t i = 0; i < recording->rows; i++) {
        recording->row[i].Fx_N *= share;
        recording->row[i].Fz_N *= share;
        recording->row[i].My_Nm *= share;
    }
}

// simpleB is no part of the reference digs: it was computed here (tests/data/round_trip).
static struct dig_recording read_dig(const char *const gravel, const char *const kind)
{
    char path[200];
    (void)snprintf(path, sizeof path, "tests/data/%s/mu%s_mur%s_rho2500__%s.csv",
                   strcmp(kind, "simpleB") == 0 ? "round_trip" : "reference", gravel, gravel, kind);
    return read_recording(path);
}

static void build(const struct dig_machine *const           machine,
                  const struct dig_rig_track_options *const options, const size_t digs,
                  const struct dig_recording recording[], struct dig_rig_track *const track)
{
    struct dig_error error = { "" };
    if (dig_rig_track_build(machine, options, digs, recording, track, &error) != DIG_OK) {
        fail_msg("%s: %s", machine->name, error.text);
    }
}

static int64_t row_ns(const struct dig_rig_track *const track, const size_t row)
{
    return (int64_t)(1e9 * track->step_s * (double)row) + 1;
}

// What each machine that ships is made to dig. The wide buckets of machines from 12 t on would lift
// them in any of these gravels: they dig one that is so much lighter, as whose loads a share of
// these is taken. The places are digrig's own for the three digs together, whose search takes
// longest.
static const struct run {
    const char *machine, *gravel;
    double      share, X_m, Z_m;
} runs[] = {
    { "zx200_trench", "0.3", 1.0, 7.60, -1.03 }, { "zx200_trench", "0.5", 1.0, 7.60, -1.03 },
    { "zx200_trench", "0.9", 1.0, 6.15, -1.03 }, { "zx200", "0.3", 0.2, 7.69, -0.39 },
    { "zx120", "0.3", 0.3, 6.41, -0.56 },        { "mini_2t8", "0.3", 1.0, 2.76, 0.0 },
    { "mini_1t8", "0.3", 1.0, 2.41, -0.05 },     { "crawler_14t", "0.3", 0.3, 6.73, -0.71 },
    { "crawler_36t", "0.3", 0.15, 8.78, -0.44 },
};
#define RUNS (sizeof runs / sizeof runs[0])

static struct dig_rig_track_options placed(const struct run *const run)
{
    struct dig_rig_track_options options = dig_rig_track_options_default();
    options.placed                       = true;
    options.pin_X_m                      = run->X_m;
    options.pin_Z_m                      = run->Z_m;
    return options;
}

// One dig of a run, without inertia; dig_rig_track_finish() frees it.
static struct dig_rig_track one_dig(const struct run *const run, const char *const kind,
                                    struct dig_machine *const machine)
{
    struct dig_rig_track         track;
    struct dig_rig_track_options options = placed(run);
    options.quasi_static                 = true;
    options.placed                       = true;
    options.pin_X_m                      = run->X_m;
    options.pin_Z_m                      = run->Z_m;
    *machine                             = read_machine(run->machine);
    struct dig_recording recording       = read_dig(run->gravel, kind);
    scale(&recording, run->share);
    build(machine, &options, 1, &recording, &track);
    dig_recording_finish(&recording);
    return track;
}

// Of one part of the wrench, over the rows in the soil.
struct tally {
    int    all, in;
    double miss2, sigma, whole2;
};

static void add_row(const struct dig_machine *const machine, const struct dig_rig_row *const row,
                    const struct dig_sample *const sample, struct tally tally[const PARTS])
{
    struct dig_wrench w;
    struct dig_front  front;
    assert_int_equal(dig_wrench_solve(machine, sample, &w, &front), DIG_OK);
    const double found[PARTS] = { w.My_Nm, w.Fx_N, w.Fz_N };
    const double truth[PARTS] = { row->soil.M_Nm, -row->soil.FX_N, row->soil.FZ_N };
    const double sigma[PARTS] = { w.sigma_My_Nm, w.sigma_Fx_N, w.sigma_Fz_N };
    const bool   valid[PARTS] = { w.moment_valid, w.force_valid, w.force_valid };
    for (int p = 0; p < PARTS; p++) {
        if (valid[p]) {
            tally[p].in += fabs(found[p] - truth[p]) < sigma[p] ? 1 : 0;
            tally[p].miss2 += pow(found[p] - truth[p], 2.0);
            tally[p].sigma += sigma[p];
            tally[p].whole2 += truth[p] * truth[p];
            tally[p].all++;
        }
    }
}

// In the soil; still air shows one pose and one rounding for seconds.
static bool digs(const struct dig_rig_track *const track, const size_t row)
{
    return hypot(track->row[row].soil.FX_N, track->row[row].soil.FZ_N) > 0.0;
}

TEST(without_sensors_the_recording_comes_back_within_a_thousandth)
{
    for (size_t r = 0; r < RUNS; r++) {
        struct tally tally[PARTS] = { { 0 } };
        int          rows         = 0;
        for (int k = 0; k < KINDS; k++) {
            struct dig_machine   machine;
            struct dig_rig_track track = one_dig(&runs[r], kinds[k], &machine);
            for (size_t i = 0; i < track.rows; i++) {
                const struct dig_sample sample =
                    dig_rig_sense(&machine, &track.row[i], row_ns(&track, i), NULL);
                add_row(&machine, &track.row[i], &sample, tally);
                rows++;
            }
            dig_rig_track_finish(&track);
        }
        for (int p = 0; p < PARTS; p++) {
            const double error = sqrt(tally[p].miss2 / tally[p].whole2);
            print_message("%s %s: rms error of %s without sensors: %.2g\n", runs[r].machine,
                          runs[r].gravel, parts[p], error);
            // Of the stiffest gravel two rows come too near a relief pressure to be told.
            assert_true(tally[p].all >= rows - 2);
            assert_true(error < 1e-3);
        }
    }
}

// Noise and steps of the machine's sensors. Its geometry is the file's to the last digit here, so
// sigma is held without what tolerances of the geometry add.
TEST(with_sensors_one_sigma_covers_two_thirds_and_is_not_too_large)
{
    for (size_t d = 0; d < RUNS * KINDS; d++) {
        const struct run *const run  = &runs[d / KINDS];
        const char *const       kind = kinds[d % KINDS];
        struct dig_machine      machine;
        struct dig_rig_track    track        = one_dig(run, kind, &machine);
        struct tally            tally[PARTS] = { { 0 } };
        for (uint64_t seed = 1; seed <= 3; seed++) {
            struct dig_rig_noise noise = dig_rig_noise_init(seed);
            for (size_t i = 0; i < track.rows; i++) {
                struct dig_sample sample =
                    dig_rig_sense(&machine, &track.row[i], row_ns(&track, i), &noise);
                dig_rig_quantise(&machine, &sample);
                if (digs(&track, i)) {
                    add_row(&machine, &track.row[i], &sample, tally);
                }
            }
        }
        for (int p = 0; p < PARTS; p++) {
            const struct tally *const t     = &tally[p];
            const double              share = (double)t->in / t->all;
            const double              ratio = t->sigma / t->all / sqrt(t->miss2 / t->all);
            print_message("%s %s %s %s: %.1f %% within one sigma, mean sigma / rms error %.3f\n",
                          run->machine, run->gravel, kind, parts[p], 100.0 * share, ratio);
            assert_true(t->all > 5000);
            assert_close(share, 0.68, 0.05);
            assert_true(ratio < 1.2);
        }
        dig_rig_track_finish(&track);
    }
}

static double step_m(const struct dig_force_row *const a, const struct dig_force_row *const b)
{
    return hypot(b->pin_x_m - a->pin_x_m, b->pin_z_m - a->pin_z_m) +
           0.09 * fabs(b->theta_deg - a->theta_deg) * 0.017453292519943295;
}

// Plain mean of the rows within 0.16 s of row at.
static double window_mean_Nm(const struct dig_recording *const r, const size_t at)
{
    double sum_Nm = 0.0;
    int    n      = 0;
    for (size_t i = 0; i < r->rows; i++) {
        if (fabs(r->row[i].t_s - r->row[at].t_s) <= 0.1625) {
            sum_Nm += r->row[i].My_Nm;
            n++;
        }
    }
    return sum_Nm / n;
}

// The recording at one progress of the path its poses went: the test's own smoothing and mapping.
static double recorded_Nm(const struct dig_recording *const r, const double progress)
{
    double whole_m = 0.0;
    for (size_t i = 1; i < r->rows; i++) {
        whole_m += step_m(&r->row[i - 1], &r->row[i]);
    }
    double path_m = 0.0;
    size_t i      = 1;
    while (i + 1 < r->rows && path_m + step_m(&r->row[i - 1], &r->row[i]) < progress * whole_m) {
        path_m += step_m(&r->row[i - 1], &r->row[i]);
        i++;
    }
    const double f = fmin((progress * whole_m - path_m) / step_m(&r->row[i - 1], &r->row[i]), 1.0);
    return (1.0 - f) * window_mean_Nm(r, i - 1) + f * window_mean_Nm(r, i);
}

// Everything on: inertia, noise, steps of the bus, blended corners, air before and after.
TEST(a_whole_run_gives_the_recorded_curves_within_their_sigma)
{
    const struct made_options   options = { .relative_sd = 0.1, .packings = 3 };
    struct dig_curve_set *const set     = made_table(&options);
    for (int g = 0; g < GRAVELS; g++) {
        const struct dig_machine           machine = read_machine("zx200_trench");
        struct dig_recording               recording[DIGS];
        const struct dig_rig_track_options at = placed(&runs[g]);
        struct dig_rig_track               track;
        for (int d = 0; d < DIGS; d++) {
            recording[d] = read_dig(gravels[g], kinds[d]);
        }
        build(&machine, &at, DIGS, recording, &track);
        struct dig_rig_noise                noise     = dig_rig_noise_init(7);
        struct dig_estimator *const         estimator = malloc(dig_estimator_size());
        const struct dig_estimator_settings settings  = dig_estimator_settings_default();
        assert_int_equal(dig_estimator_init(estimator, &machine, set, &settings), DIG_OK);

        int digs = 0;
        for (size_t i = 0; i < track.rows; i++) {
            struct dig_sample sample =
                dig_rig_sense(&machine, &track.row[i], row_ns(&track, i), &noise);
            dig_rig_quantise(&machine, &sample);
            struct dig_estimate    estimate;
            struct dig_observation o;
            assert_int_equal(dig_estimator_step(estimator, &sample, &estimate), DIG_OK);
            if (!made_observed(estimator, set, &o)) {
                continue;
            }
            assert_true(digs < DIGS);
            assert_int_equal(o.trajectory, digs == 0 ? MADE_SIMPLE_A : MADE_ACTUAL);
            assert_true(o.off_path_m < 5e-4);
            double miss2 = 0.0, sigma2 = 0.0, whole2 = 0.0;
            for (int k = 0; k < DIG_CURVE_POINTS; k++) {
                if (k / 255.0 >= o.first && k / 255.0 <= o.last) {
                    const double truth = recorded_Nm(&recording[digs], k / 255.0);
                    miss2 += pow(o.moment_Nm[k] - truth, 2.0);
                    sigma2 += pow(o.sigma_Nm[k], 2.0);
                    whole2 += truth * truth;
                }
            }
            print_message("%s %s: error %.4f, sigma %.4f\n", gravels[g], kinds[digs],
                          sqrt(miss2 / whole2), sqrt(sigma2 / whole2));
            // Errors of alignment, half a per cent, come on top of the sensors'.
            assert_true(miss2 < 4.0 * sigma2 + 2.5e-5 * whole2);
            assert_true(sigma2 < 4.0 * miss2 + 2.5e-5 * whole2);
            digs++;
        }
        assert_int_equal(digs, DIGS);
        free(estimator);
        for (int d = 0; d < DIGS; d++) {
            dig_recording_finish(&recording[d]);
        }
        dig_rig_track_finish(&track);
    }
    made_table_destroy(set);
}

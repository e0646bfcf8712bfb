// From a force recording through the rig's machine (virtual work) and the estimator (force balance)
// back to the force recording: digs of another DEM code, on the machines that ship.

#include "estimator/estimator.h"

#include "estimator/wrench.h"
#include "files/machine_yaml.h"
#include "files/recording_csv.h"
#include "tests/made_table.h"
#include "tests/testlib.h"
#include "tools/rig/sensors.h"
#include "tools/rig/track.h"

#include <stdlib.h>

enum { GRAVELS = 3, DIGS = 2 };
static const char *const gravels[GRAVELS] = { "mu0.3_mur0.3", "mu0.5_mur0.5", "mu0.9_mur0.9" };
static const char *const kinds[DIGS]      = { "simpleA", "actual" };

struct round {
    struct dig_machine   machine;
    struct dig_recording recording[DIGS];
    struct dig_rig_track track;
};

static struct round start(const char *const machine, const char *const of, const bool quasi_static)
{
    char             path[200];
    struct dig_error error = { "" };
    struct round     round;
    (void)snprintf(path, sizeof path, "config/machines/%s.yaml", machine);
    if (dig_machine_read(path, &round.machine, &error) != DIG_OK) {
        fail_msg("%s", error.text);
    }
    for (int d = 0; d < DIGS; d++) {
        (void)snprintf(path, sizeof path, "tests/data/reference/%s_rho2500__%s.csv", of, kinds[d]);
        if (dig_recording_read(path, &round.recording[d], &error) != DIG_OK) {
            fail_msg("%s", error.text);
        }
    }
    struct dig_rig_track_options options = dig_rig_track_options_default();
    options.quasi_static                 = quasi_static;
    if (dig_rig_track_build(&round.machine, &options, DIGS, round.recording, &round.track,
                            &error) != DIG_OK) {
        fail_msg("%s: %s: %s", machine, of, error.text);
    }
    return round;
}

static void finish(struct round *const round)
{
    for (int d = 0; d < DIGS; d++) {
        dig_recording_finish(&round->recording[d]);
    }
    dig_rig_track_finish(&round->track);
}

static int64_t row_ns(const struct dig_rig_track *const track, const size_t row)
{
    return (int64_t)(1e9 * track->step_s * (double)row) + 1;
}

static void without_sensors_the_recording_comes_back_within_a_thousandth(void **state)
{
    (void)state;
    const char *const machines[] = { "zx200_trench", "mini_2t8" };
    const char *const of[]       = { gravels[2], gravels[0] }; // what each can dig
    for (size_t m = 0; m < sizeof machines / sizeof machines[0]; m++) {
        struct round round    = start(machines[m], of[m], true);
        double       miss2[3] = { 0.0 }, whole2[3] = { 0.0 };
        for (size_t i = 0; i < round.track.rows; i++) {
            const struct dig_rig_row *const row = &round.track.row[i];
            const struct dig_sample         sample =
                dig_rig_sense(&round.machine, row, row_ns(&round.track, i), NULL);
            struct dig_wrench w;
            struct dig_front  front;
            assert_int_equal(dig_wrench_solve(&round.machine, &sample, &w, &front), DIG_OK);
            assert_true(w.moment_valid && w.force_valid);
            assert_close(front.pin_m[DIG_JOINT_BUCKET].x, row->pose.X_m, 1e-9);
            assert_close(front.pin_m[DIG_JOINT_BUCKET].y, row->pose.Z_m, 1e-9);
            const double found[3] = { w.My_Nm, w.Fx_N, w.Fz_N };
            const double truth[3] = { row->soil.M_Nm, -row->soil.FX_N, row->soil.FZ_N };
            for (int k = 0; k < 3; k++) {
                miss2[k] += pow(found[k] - truth[k], 2.0);
                whole2[k] += truth[k] * truth[k];
            }
        }
        for (int k = 0; k < 3; k++) {
            print_message("%s: rms error of part %d: %.2g\n", machines[m], k,
                          sqrt(miss2[k] / whole2[k]));
            assert_true(sqrt(miss2[k] / whole2[k]) < 1e-3);
        }
        finish(&round);
    }
}

static void with_the_zx200s_sensors_one_sigma_covers_two_thirds_of_the_digs(void **state)
{
    (void)state;
    for (int g = 0; g < GRAVELS; g++) {
        struct round round = start("zx200_trench", gravels[g], true);
        assert_close(round.machine.pressure_step_Pa, 2e5, 0.0);
        assert_close(round.machine.angle_step_rad, 4e-4, 0.0);

        int    in = 0, all = 0;
        double z2 = 0.0;
        for (uint64_t seed = 1; seed <= 3; seed++) {
            struct dig_rig_noise noise = dig_rig_noise_init(seed);
            for (size_t i = 0; i < round.track.rows; i++) {
                const struct dig_rig_row *const row = &round.track.row[i];
                struct dig_sample               sample =
                    dig_rig_sense(&round.machine, row, row_ns(&round.track, i), &noise);
                dig_rig_quantise(&round.machine, &sample);
                struct dig_wrench w;
                struct dig_front  front;
                assert_int_equal(dig_wrench_solve(&round.machine, &sample, &w, &front), DIG_OK);

                // In the soil; still air shows one pose and one rounding for seconds.
                if (fabs(row->soil.M_Nm) > 1000.0 && w.moment_valid) {
                    const double z = (w.My_Nm - row->soil.M_Nm) / w.sigma_My_Nm;
                    in += fabs(z) < 1.0 ? 1 : 0;
                    z2 += z * z;
                    all++;
                }
            }
        }
        print_message("%s: %.1f %% within one sigma, rms of error / sigma %.3f\n", gravels[g],
                      100.0 * in / all, sqrt(z2 / all));
        assert_true(all > 10000);
        assert_close((double)in / all, 0.68, 0.05);
        finish(&round);
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
static void a_whole_run_gives_the_recorded_curves_within_their_sigma(void **state)
{
    (void)state;
    const struct made_options   options = { .relative_sd = 0.1, .packings = 3 };
    struct dig_curve_set *const set     = made_table(&options);
    for (int g = 0; g < GRAVELS; g++) {
        struct round                        round     = start("zx200_trench", gravels[g], false);
        struct dig_rig_noise                noise     = dig_rig_noise_init(7);
        struct dig_estimator *const         estimator = malloc(dig_estimator_size());
        const struct dig_estimator_settings settings  = dig_estimator_settings_default();
        assert_int_equal(dig_estimator_init(estimator, &round.machine, set, &settings), DIG_OK);

        int digs = 0;
        for (size_t i = 0; i < round.track.rows; i++) {
            struct dig_sample sample =
                dig_rig_sense(&round.machine, &round.track.row[i], row_ns(&round.track, i), &noise);
            dig_rig_quantise(&round.machine, &sample);
            struct dig_estimate    estimate;
            struct dig_observation o;
            assert_int_equal(dig_estimator_step(estimator, &sample, &estimate), DIG_OK);
            if (!dig_estimator_take_dig(estimator, &o)) {
                continue;
            }
            assert_true(digs < DIGS);
            assert_int_equal(o.trajectory, digs == 0 ? MADE_SIMPLE_A : MADE_ACTUAL);
            assert_true(o.off_path_m < 5e-4);
            double miss2 = 0.0, sigma2 = 0.0, whole2 = 0.0;
            for (int k = 0; k < DIG_CURVE_POINTS; k++) {
                if (k / 255.0 >= o.first && k / 255.0 <= o.last) {
                    const double truth = recorded_Nm(&round.recording[digs], k / 255.0);
                    miss2 += pow(o.moment_Nm[k] - truth, 2.0);
                    sigma2 += pow(o.sigma_Nm[k], 2.0);
                    whole2 += truth * truth;
                }
            }
            print_message("%s %s: error %.4f, sigma %.4f\n", gravels[g], kinds[digs],
                          sqrt(miss2 / whole2), sqrt(sigma2 / whole2));
            // Errors of alignment, half a per cent, come on top of the sensors'.
            assert_true(miss2 < 4.0 * sigma2 + 2.5e-5 * whole2);
            digs++;
        }
        assert_int_equal(digs, DIGS);
        free(estimator);
        finish(&round);
    }
    made_table_destroy(set);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(without_sensors_the_recording_comes_back_within_a_thousandth),
        cmocka_unit_test(with_the_zx200s_sensors_one_sigma_covers_two_thirds_of_the_digs),
        cmocka_unit_test(a_whole_run_gives_the_recorded_curves_within_their_sigma),
    };
    return cmocka_run_group_tests_name("round_trip", tests, NULL, NULL);
}

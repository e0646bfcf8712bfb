// Tests for estimator/predict/peak_energy.c

#include "estimator/predict/peak_energy.h"

#include "core/units.h"
#include "tests/made_table.h"
#include "tests/table_runs.h"
#include "tests/testlib.h"

#include <stdlib.h>

static struct dig_match sure_of(const struct dig_curve_set *const set, const size_t entry)
{
    return (struct dig_match){ .valid = true, .nearest = (int)entry, .gravel = set->gravel[entry] };
}

static double highest(const float moment_Nm[DIG_CURVE_POINTS])
{
    double most = (double)moment_Nm[0];
    for (int k = 1; k < DIG_CURVE_POINTS; k++) {
        most = fmax(most, (double)moment_Nm[k]);
    }
    return most;
}

// By hand: a constant force of -2 N along a drag of 92.6 mm, of -3 N along a sink of 26.137 mm (it
// pushes down, with the motion), back over 36.6 mm of lift, and 0.5 Nm over a turn.
TEST(energy_is_what_the_bucket_does_on_the_soil)
{
    static const double         force[DIG_FORCE_CHANNELS] = { 0.5, -2.0, -3.0 };
    const struct dig_trajectory t[]                       = { made_trajectory(MADE_SIMPLE_A),
                                                              made_trajectory(MADE_SIMPLE_B) };
    double                      is[]                      = { 0.0, 0.0 };
    for (int i = 0; i < 2; i++) {
        struct dig_channels weight;
        dig_peak_energy_weights(&t[i], 0.09, &weight);
        for (int c = 0; c < DIG_FORCE_CHANNELS; c++) {
            for (int k = 0; k < DIG_CURVE_POINTS; k++) {
                is[i] += weight.of[c][k] * force[c];
            }
        }
    }
    const double in_x_m = 0.6 * 0.02515 + 2.0 * 0.0463, in_z_m = -0.6 * 0.04356107781 + 0.0366;
    assert_close(is[0], 2.0 * in_x_m + 3.0 * in_z_m, 1e-6);

    const double turn_rad = 2.5 * 20.05 * DIG_RAD_PER_DEG;
    const double x_m = 0.9 * 0.029565598190311397, z_m = -0.9 * 0.04069355481705986;
    assert_close(is[1], 2.0 * x_m + 3.0 * z_m + 0.5 * turn_rad, 1e-6);
}

// Without any scatter, and one packing alone: a dig's own peak, and what two gravels differ by.
TEST(what_does_not_scatter_peaks_where_the_table_does)
{
    const struct made_options   still = { .relative_sd = 0.0, .packings = 3 };
    struct dig_curve_set *const set   = made_table(&still);
    struct dig_match            match = sure_of(set, 5);
    struct dig_peak_energy      whole;
    assert_int_equal(dig_peak_energy_predict(set, &match, MADE_ACTUAL, &whole), DIG_OK);
    const double peak_Nm = highest(set->curve[5 * 3 + MADE_ACTUAL].mean[0]);
    assert_close(whole.peak_Nm, peak_Nm, 1e-9);
    assert_close(whole.peak_sigma_Nm, 0.0, 1e-6);
    assert_close(whole.energy_sigma_J, 0.0, 1e-6);

    match.samples                  = 2;
    match.sample[0]                = set->gravel[5];
    match.sample[1]                = set->gravel[41];
    const double           other_J = whole.energy_J;
    struct dig_peak_energy both;
    assert_int_equal(dig_peak_energy_predict(set, &match, MADE_ACTUAL, &both), DIG_OK);
    const double other_Nm = highest(set->curve[41 * 3 + MADE_ACTUAL].mean[0]);
    assert_close(both.peak_Nm, 0.5 * (peak_Nm + other_Nm), 1e-9);
    assert_close(both.peak_sigma_Nm, 0.5 * fabs(peak_Nm - other_Nm), 1e-6);
    assert_close(both.energy_sigma_J, fabs(both.energy_J - other_J), 1e-6);
    made_table_destroy(set);

    const struct made_options   once = { .relative_sd = 0.1, .packings = 1 };
    struct dig_curve_set *const one  = made_table(&once);
    match                            = sure_of(one, 5);
    assert_int_equal(dig_peak_energy_predict(one, &match, MADE_ACTUAL, &whole), DIG_OK);
    assert_close(whole.peak_Nm, peak_Nm, 1e-9);
    assert_true(whole.peak_sigma_Nm > 0.05 * peak_Nm && whole.energy_sigma_J > 0.0);
    made_table_destroy(one);
}

// Each packing of the table against the table without it: the peak told is met in the mean, and as
// many lie within a sigma, and in the 90 % band, as its name says.
TEST(packings_left_out_peak_and_take_what_is_told)
{
    struct table_runs *const t = calloc(1, sizeof *t);
    assert_non_null(t);
    assert_int_equal(table_runs_read("tables/reference_rig.sqlite", NULL, t, NULL), DIG_OK);
    for (size_t j = 0; j < t->set->trajectories; j++) {
        struct dig_channels weight;
        dig_peak_energy_weights(&t->set->trajectory[j], t->set->tooth_m, &weight);
        double digs = 0.0, peaks = 0.0, means = 0.0, one[2] = { 0.0 }, band[2] = { 0.0 };
        for (size_t i = 0; i < t->runs; i++) {
            const size_t slot = table_run_slot(t, &t->run[i]);
            if (slot % t->set->trajectories != j) {
                continue;
            }
            const struct dig_curve kept = t->set->curve[slot];
            (void)table_runs_without(t, i, &t->set->curve[slot]);
            t->set->packings[slot]--;
            const struct dig_match match = sure_of(t->set, slot / t->set->trajectories);
            struct dig_peak_energy whole;
            assert_int_equal(dig_peak_energy_predict(t->set, &match, j, &whole), DIG_OK);
            double peak_Nm = 0.0, energy_J = 0.0;
            for (int k = 0; k < DIG_CURVE_POINTS; k++) {
                peak_Nm = fmax(peak_Nm, t->run[i].value[0][k]);
                for (int c = 0; c < DIG_FORCE_CHANNELS; c++) {
                    energy_J += weight.of[c][k] * t->run[i].value[c][k];
                }
            }
            digs += 1.0;
            peaks += peak_Nm / whole.peak_Nm;
            means += peak_Nm / highest(t->set->curve[slot].mean[0]);
            const double off[2] = { fabs(peak_Nm - whole.peak_Nm) / whole.peak_sigma_Nm,
                                    fabs(energy_J - whole.energy_J) / whole.energy_sigma_J };
            for (int q = 0; q < 2; q++) {
                one[q] += off[q] < 1.0 ? 1.0 : 0.0;
                band[q] += off[q] < 1.645 ? 1.0 : 0.0;
            }
            t->set->packings[slot]++;
            t->set->curve[slot] = kept;
        }
        print_message("%s, %.0f digs: peak / told %.3f, / peak of the mean %.3f; within a sigma "
                      "%.3f and %.3f of energy, in the band %.3f and %.3f\n",
                      t->set->trajectory[j].name, digs, peaks / digs, means / digs, one[0] / digs,
                      one[1] / digs, band[0] / digs, band[1] / digs);
        assert_true(means / digs > 1.05);
        assert_close(peaks / digs, 1.0, 0.02);
        for (int q = 0; q < 2; q++) {
            assert_in_range((int)(1000.0 * band[q] / digs), 850, 950);
        }
    }
    dig_curve_set_destroy(t->set);
    free(t);
}

TEST(refusals_write_nothing)
{
    const struct made_options   plain = { .relative_sd = 0.1, .packings = 3 };
    struct dig_curve_set *const set   = made_table(&plain);
    struct dig_match            match = sure_of(set, 7);
    const struct dig_match      none  = { .valid = false };
    struct dig_peak_energy      whole, before;
    memset(&whole, 0x5a, sizeof whole);
    memcpy(&before, &whole, sizeof before);
    assert_int_equal(dig_peak_energy_predict(set, &none, 0, &whole), DIG_EINVAL);
    assert_int_equal(dig_peak_energy_predict(set, &match, 3, &whole), DIG_EINVAL);
    set->packings[7 * 3] = 0;
    assert_int_equal(dig_peak_energy_predict(set, &match, 0, &whole), DIG_ENOMATCH);
    match.nearest = -1;
    assert_int_equal(dig_peak_energy_predict(set, &match, 1, &whole), DIG_EINVAL);
    assert_memory_equal(&whole, &before, sizeof whole);
    made_table_destroy(set);
}

// Tests for estimator/wrench/tolerance.c and the tolerances of sensed.c: machines drawn with other
// pins, masses and centres, their samples by virtual work, read as the file's machine would. No
// formula is shared.

#include "estimator/wrench/tolerance.h"

#include "estimator/wrench/sensed.h"
#include "estimator/wrench/wrench.h"
#include "tests/model_front.h"
#include "tests/read.h"
#include "tools/rig/sensors.h"

enum { PARTS = 3, DRAWS = 1500 };

// Three times the standard error of a standard deviation of so many draws, and what a square of a
// tolerance adds.
static const double within = 3.0 / 54.8 + 0.01;

static void draw_length(double *const length_m, const double sigma_m, uint64_t *const seed)
{
    *length_m += sigma_m * model_normal(seed);
}

static void draw_point(struct dig_vec2 *const point, const double sigma_m, uint64_t *const seed)
{
    draw_length(&point->x, sigma_m, seed);
    draw_length(&point->y, sigma_m, seed);
}

static struct dig_machine another(const struct dig_machine *const file, uint64_t *const seed)
{
    const struct dig_tolerance *const t = &file->tolerance;
    struct dig_machine                m = *file;
    for (int j = 0; j < DIG_JOINTS; j++) {
        draw_point(&m.cylinder[j].base_m, t->pin_m, seed);
        draw_point(&m.cylinder[j].eye_m, t->pin_m, seed);
        draw_point(&m.link[j].com_m, t->com_share * m.link[j].length_m, seed);
        m.link[j].mass_kg *= 1.0 + t->mass_share * model_normal(seed);
    }
    draw_point(&m.four_bar.rocker_pin_m, t->pin_m, seed);
    draw_point(&m.four_bar.ear_m, t->pin_m, seed);
    draw_length(&m.four_bar.rocker_m, t->pin_m, seed);
    draw_length(&m.four_bar.link_m, t->pin_m, seed);
    draw_point(&m.sensor.place_m, t->pin_m, seed);
    return m;
}

static const double            poses[][DIG_JOINTS] = { { 0.3, -1.4, -0.8 },
                                                       { -0.2, -0.9, 0.2 },
                                                       { 0.7, -2.2, -1.6 } };
static const struct model_load loads[]             = { { .FX_N = -2e4, .FZ_N = 1e4, .M_Nm = 2e4 },
                                                       { .FX_N = 0.0, .FZ_N = 0.0, .M_Nm = 0.0 },
                                                       { .FX_N = -5e3, .FZ_N = 3e4, .M_Nm = 4e4 } };
#define POSES (sizeof poses / sizeof poses[0])

static void spread_is_sigma(const struct dig_tolerance *const tolerance)
{
    struct dig_machine file = model_machine();
    file.tolerance          = *tolerance;
    for (size_t i = 0; i < POSES; i++) {
        uint64_t seed        = 7 + i;
        double   sum2[PARTS] = { 0.0 }, sigma[PARTS];
        for (int n = 0; n < DRAWS; n++) {
            const struct dig_machine built = another(&file, &seed);
            const struct dig_sample sample = model_sample(&built, poses[i], 0.1, &loads[i], 1e6, 1);
            struct dig_wrench       w;
            struct dig_front        front;
            assert_int_equal(dig_wrench_solve(&file, &sample, &w, &front), DIG_OK);
            assert_true(w.moment_valid && w.force_valid);
            sum2[0] += pow(w.My_Nm - loads[i].M_Nm, 2.0);
            sum2[1] += pow(w.Fx_N + loads[i].FX_N, 2.0);
            sum2[2] += pow(w.Fz_N - loads[i].FZ_N, 2.0);

            // It hardly differs from sample to sample.
            sigma[0] = w.geometry_sigma_My_Nm;
            sigma[1] = w.geometry_sigma_Fx_N;
            sigma[2] = w.geometry_sigma_Fz_N;
            assert_close(w.sigma_My_Nm, 0.0, 1e-6); // its sensors are perfect
        }
        for (int p = 0; p < PARTS; p++) {
            const double spread = sqrt(sum2[p] / DRAWS);
            print_message("pose %zu part %d: spread %.4g, sigma %.4g\n", i, p, spread, sigma[p]);
            assert_close(sigma[p] / spread, 1.0, within);
        }
    }
}

TEST(machines_with_other_pins_spread_by_sigma)
{
    spread_is_sigma(&(struct dig_tolerance){ .pin_m = 1e-3 });
}

TEST(machines_with_other_masses_and_centres_spread_by_sigma)
{
    spread_is_sigma(&(struct dig_tolerance){ .mass_share = 0.05 });
    spread_is_sigma(&(struct dig_tolerance){ .com_share = 0.02 });
}

TEST(rigs_with_other_buckets_and_places_spread_by_sigma)
{
    struct dig_machine file = read_machine("rig_sensor");
    file.tolerance = (struct dig_tolerance){ .pin_m = 3e-4, .mass_share = 0.03, .com_share = 0.03 };
    const struct dig_rig_pose      pose        = { 0.3, 0.2, -1.4 };
    const struct dig_rig_motion    still       = { .turn_radps2 = { 0.0 } };
    const struct dig_rig_wrench    soil        = { -20.0, 12.0, 1.5 };
    const struct dig_sensed_motion rests       = { .turn_radps = 0.0 };
    uint64_t                       seed        = 11;
    double                         sum2[PARTS] = { 0.0 };
    struct dig_wrench              w;
    for (int n = 0; n < DRAWS; n++) {
        const struct dig_machine built = another(&file, &seed);
        const struct dig_rig_row row   = {
              .pose = pose,
              .load = dig_rig_gauge_read(&built, &pose, &still, &soil),
        };
        const struct dig_sample sample = dig_rig_sense(&file, &row, 1, NULL);
        struct dig_front        front;
        assert_int_equal(dig_sensed_solve(&file, &sample, &rests, &w, &front), DIG_OK);
        sum2[0] += pow(w.My_Nm - soil.M_Nm, 2.0);
        sum2[1] += pow(w.Fx_N + soil.FX_N, 2.0);
        sum2[2] += pow(w.Fz_N - soil.FZ_N, 2.0);
    }
    assert_close(w.geometry_sigma_My_Nm / sqrt(sum2[0] / DRAWS), 1.0, within);

    // The force turns with the bucket alone: along x it weighs nothing.
    assert_close(w.geometry_sigma_Fx_N, sqrt(sum2[1] / DRAWS), 1e-9);
    assert_close(w.geometry_sigma_Fz_N / sqrt(sum2[2] / DRAWS), 1.0, within);
}

TEST(a_machine_that_is_its_file_has_none)
{
    const struct dig_machine file   = model_machine();
    const struct dig_sample  sample = model_sample(&file, poses[0], 0.1, &loads[0], 1e6, 1);
    struct dig_wrench        w;
    struct dig_front         front;
    assert_int_equal(dig_wrench_solve(&file, &sample, &w, &front), DIG_OK);
    assert_close(w.geometry_sigma_My_Nm + w.geometry_sigma_Fx_N + w.geometry_sigma_Fz_N, 0.0, 0.0);
}

// What scatters from sample to sample is what the matcher weighs; a tolerance is not in it.
TEST(tolerances_leave_the_noise_and_what_is_not_told_alone)
{
    struct dig_machine exact              = model_machine();
    exact.pressure_step_Pa                = 2e5;
    exact.angle_sigma_rad                 = 2e-4;
    struct dig_machine built              = exact;
    built.tolerance                       = (struct dig_tolerance){ 2e-3, 0.05, 0.02 };
    struct dig_sample sample              = model_sample(&exact, poses[0], 0.1, &loads[0], 1e6, 1);
    sample.valid[DIG_SIGNAL_BOOM_HEAD_Pa] = false;
    struct dig_wrench plain, tolerant;
    struct dig_front  front;
    assert_int_equal(dig_wrench_solve(&exact, &sample, &plain, &front), DIG_OK);
    assert_int_equal(dig_wrench_solve(&built, &sample, &tolerant, &front), DIG_OK);
    assert_close(tolerant.My_Nm, plain.My_Nm, 0.0);
    assert_close(tolerant.sigma_My_Nm, plain.sigma_My_Nm, 0.0);
    assert_close(tolerant.slow_sigma_My_Nm, plain.slow_sigma_My_Nm, 0.0);
    assert_true(tolerant.geometry_sigma_My_Nm > 0.0);
    assert_false(tolerant.force_valid);
    assert_close(tolerant.geometry_sigma_Fx_N + tolerant.geometry_sigma_Fz_N, 0.0, 0.0);
}

// Tests for firmware_host/matching/fit.c and gravel_track.c: what is known outlives the daemon in
// its file.

#include "files/identity_json.h"
#include "firmware_host/matching/gravel_state.h"
#include "tests/firmware_host/fit_bench.h"
#include "tests/scratch.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <time.h>

// A file of a match comes back as that match; another table's, an old one or a damaged one does
// not.
TEST(what_is_known_survives_in_its_file)
{
    struct bench *const b = bench_create();
    (void)snprintf(b->config.match_state.text, sizeof b->config.match_state.text, "%s",
                   scratch_path("match.json"));
    bench_dig(b, 6, 0, 1.0);
    const struct dig_gravel_track before = b->fit.track;

    struct bench *const again = bench_create();
    again->config.match_state = b->config.match_state;
    dig_fit_restore(&again->fit);
    const struct dig_gravel_track *const k = &again->fit.track;
    assert_true(k->valid && k->restored);
    assert_int_equal(k->match.nearest, 6);
    assert_int_equal(before.match.weighted, 6);
    assert_int_equal(k->match.weighted, 6);
    assert_close(k->match.weighted_distance, before.match.weighted_distance, 1e-8);
    assert_memory_equal(&k->weighted, &b->cube.set.gravel[6], sizeof k->weighted);
    assert_int_equal(k->match.samples, before.match.samples);
    for (int a = 0; a < DIG_AXES; a++) {
        assert_close(k->match.gravel.value[a], before.match.gravel.value[a],
                     1e-8 * before.match.gravel.value[a]);
    }
    const struct dig_prediction_basis *const basis = dig_latest_look(&again->wires.handoffs.basis);
    assert_non_null(basis);
    assert_true(basis->known && basis->forecast.expected[0].valid);

    static const struct {
        const char *what, *expected;
    } bad[] = { { "table", "expected one of the table's" },
                { "old", "h old, expected at most" },
                { "future", "dated 2.0 h ahead of the clock" },
                { "damaged", "match.json" } };
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        struct bench *const other = bench_create();
        other->config.match_state = b->config.match_state;
        struct timespec wall;
        (void)clock_gettime(CLOCK_REALTIME, &wall);
        struct timespec times[2] = { wall, wall };
        if (i == 0) {
            other->cube.set.scene_hash[0] = 'b';
        }
        times[1].tv_sec += i == 1 ? -3700 : i == 2 ? 7200 : 0;
        assert_int_equal(utimensat(AT_FDCWD, scratch_path("match.json"), times, 0), 0);
        if (i == 3) {
            (void)scratch_write("match.json", "{\"scene_hash\": 3}\n");
        }
        dig_fit_restore(&other->fit);
        struct dig_log_line note = { "" };
        assert_false(other->fit.track.any);
        assert_null(dig_latest_look(&other->wires.handoffs.basis));
        assert_true(dig_latest_take(&other->wires.handoffs.fit_log, &note));
        assert_non_null(strstr(note.text, bad[i].expected));
        free(other);
    }
    free(b);
    free(again);
}

// Which axes were not told is no field of the file: the interval says it, and the table's axes.
TEST(what_was_not_told_is_not_told_after_a_restart_either)
{
    struct bench *const b     = bench_create();
    struct bench *const again = bench_create();
    (void)snprintf(again->config.match_state.text, sizeof again->config.match_state.text, "%s",
                   scratch_path("family.json"));
    bench_dig(b, 5, 0, 1.0);
    struct dig_gravel_track family = b->fit.track;

    const double *const axis                   = b->cube.set.axis[DIG_AXIS_ROLLING];
    family.match.low.value[DIG_AXIS_ROLLING]   = axis[0] + 0.2 * (axis[1] - axis[0]);
    family.match.high.value[DIG_AXIS_ROLLING]  = axis[0] + 0.8 * (axis[1] - axis[0]);
    family.match.low.value[DIG_AXIS_FRICTION]  = family.match.gravel.value[DIG_AXIS_FRICTION];
    family.match.high.value[DIG_AXIS_FRICTION] = family.match.gravel.value[DIG_AXIS_FRICTION];

    assert_int_equal(dig_gravel_state_write(scratch_path("family.json"), &family, &b->cube.set,
                                            &b->fit.pool, NULL),
                     DIG_OK);
    dig_fit_restore(&again->fit);
    assert_true(again->fit.track.restored);
    assert_true(again->fit.track.match.untold[DIG_AXIS_ROLLING]);
    assert_false(again->fit.track.match.untold[DIG_AXIS_FRICTION]);

    // A file from before there was a noise-weighted entry tells none.
    family.match.weighted = -1;
    assert_int_equal(dig_gravel_state_write(scratch_path("family.json"), &family, &b->cube.set,
                                            &b->fit.pool, NULL),
                     DIG_OK);
    dig_fit_restore(&again->fit);
    assert_int_equal(again->fit.track.match.weighted, -1);
    assert_true(isnan(again->fit.track.match.weighted_distance));
    free(b);
    free(again);
}

// After a restart the digs before still count; from a file without them the next begins anew.
TEST(the_digs_of_a_ground_survive_too)
{
    struct bench *const b = bench_create();
    (void)snprintf(b->config.match_state.text, sizeof b->config.match_state.text, "%s",
                   scratch_path("pool.json"));
    for (int i = 0; i < 9; i++) {
        bench_dig(b, 5, 0, 1.0 + 0.001 * i);
    }
    for (int bare = 0; bare < 2; bare++) {
        struct bench *const again = bench_create();
        again->config.match_state = b->config.match_state;
        if (bare == 1) {
            struct dig_identity id;
            assert_int_equal(dig_identity_read(scratch_path("pool.json"), &id, NULL), DIG_OK);
            id.recorded      = 0;
            FILE *const file = fopen(scratch_path("pool.json"), "w");
            dig_identity_write(file, &id);
            (void)fclose(file);
        }
        dig_fit_restore(&again->fit);
        assert_true(again->fit.track.restored && again->fit.track.match.digs == DIG_POOL_MAX);
        assert_int_equal(again->fit.pool.digs, bare == 1 ? 0 : DIG_POOL_MAX);
        if (bare == 0) {
            for (int k = 0; k < DIG_CURVE_POINTS; k++) {
                assert_close(again->fit.pool.dig[7].moment_Nm[k], b->fit.pool.dig[7].moment_Nm[k],
                             1e-6);
            }
        }
        bench_dig(again, 5, 0, 1.0);
        assert_int_equal(again->fit.track.match.digs, bare == 1 ? 1 : DIG_POOL_MAX);
        assert_false(again->fit.track.restored);
        free(again);
    }
    free(b);
}

// Forces that tell the gravels apart otherwise than the moment does.
static void give_forces(struct bench *const b)
{
    for (int g = 0; g < GRAVELS; g++) {
        struct dig_curve *const curve = &b->cube.curve[g * TRAJECTORIES];
        for (int c = 0; c < 2; c++) {
            for (int p = 0; p < DIG_CURVE_POINTS; p++) {
                curve->mean[1 + c][p] =
                    (float)((c == 0 ? -3.0 : 2.0) * bench_moment_Nm(GRAVELS - g, p));
                curve->sd[1 + c][p] = 0.03F;
            }
        }
    }
    dig_outlines_draw(&b->cube.set);
}

// A dig in one of the gravels, with its forces.
static void dig_with_forces_in(struct bench *const b, const int gravel, const double factor)
{
    struct dig_observation dig = bench_observation(gravel, factor);
    dig.forces                 = true;
    for (int p = 0; p < DIG_CURVE_POINTS; p++) {
        for (int c = 0; c < 2; c++) {
            dig.force_N[c][p]       = (double)b->cube.curve[gravel * TRAJECTORIES].mean[1 + c][p];
            dig.force_sigma_N[c][p] = 0.02 + 0.001 * c;
        }
    }
    dig_fit_take(&b->fit, &dig);
}

// What comes after a restart is matched with the forces of what was before it.
TEST(the_forces_of_a_ground_survive_too)
{
    struct bench *const b = bench_create(), *const again = bench_create();
    for (int i = 0; i < 2; i++) {
        struct bench *const one = i == 0 ? b : again;
        give_forces(one);
        (void)snprintf(one->config.match_state.text, sizeof one->config.match_state.text, "%s",
                       scratch_path("forces.json"));
    }
    for (int i = 0; i < 8; i++) {
        dig_with_forces_in(b, 5, 1.0 + 0.001 * i);
    }
    assert_true(b->fit.track.match.forces);
    dig_fit_restore(&again->fit);
    assert_true(again->fit.track.restored && again->fit.track.match.forces);
    assert_int_equal(again->fit.pool.digs, 8);
    for (int d = 0; d < 8; d++) {
        const struct dig_observation *const was = &b->fit.pool.dig[d],
                                            *is = &again->fit.pool.dig[d];
        assert_true(is->forces);
        for (int p = 0; p < DIG_CURVE_POINTS; p++) {
            for (int c = 0; c < 2; c++) {
                assert_close(is->force_N[c][p], was->force_N[c][p],
                             1e-6 * fabs(was->force_N[c][p]));
                assert_close(is->force_sigma_N[c][p], 0.02 + 0.001 * c, 1e-9);
            }
        }
    }
    dig_with_forces_in(b, 5, 1.0);
    dig_with_forces_in(again, 5, 1.0);
    assert_true(again->fit.track.match.forces && again->fit.track.match.digs == 8);
    for (int a = 0; a < DIG_AXES; a++) {
        assert_close(again->fit.track.match.low.value[a], b->fit.track.match.low.value[a],
                     1e-5 * b->fit.track.match.low.value[a]);
        assert_close(again->fit.track.match.high.value[a], b->fit.track.match.high.value[a],
                     1e-5 * b->fit.track.match.high.value[a]);
    }

    // A dig that lacks them leaves the moment to the pool.
    bench_dig(again, 5, 0, 1.0);
    assert_false(again->fit.track.match.forces);
    free(b);
    free(again);
}

TEST(a_file_that_cannot_be_written_is_said_and_the_match_stands)
{
    struct bench *const b = bench_create();
    (void)strcpy(b->config.match_state.text, "/dev/full");
    bench_dig(b, 6, 0, 1.0);
    struct dig_log_line note = { "" };
    assert_true(b->fit.track.valid);
    assert_true(dig_latest_take(&b->wires.handoffs.fit_log, &note));
    assert_non_null(strstr(note.text, "/dev/full"));
    free(b);
}

TESTS_WITH(scratch_setup, scratch_teardown)

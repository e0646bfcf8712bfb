// Tests for firmware_host/fit.c: which digs identify, and what becomes of those that cannot.

#include "firmware_host/fit.h"

#include "files/identity_json.h"
#include "tests/approach_table.h"
#include "tests/cube_table.h"
#include "tests/scratch.h"
#include "tests/wires.h"

#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>

#define GRAVELS      CUBE_GRAVELS
#define TRAJECTORIES 2

// Gravels at the corners of a cube, whose curves differ by a factor; only simpleA has curves.
struct bench {
    struct dig_config config;
    struct cube_table cube;
    struct wires      wires;
    struct dig_fit    fit;
};

static double moment_Nm(const int gravel, const int point)
{
    const double p = point / (double)(DIG_CURVE_POINTS - 1);
    return p * (1.0 - p) * (1.0 + (gravel / 4) + 0.5 * (gravel / 2 % 2) * p + 0.25 * (gravel % 2));
}

static struct bench *bench_create(void)
{
    struct bench *const b = calloc(1, sizeof *b);
    assert_non_null(b);
    struct dig_curve_set *const set = &b->cube.set;
    set->tooth_m                    = 0.09;
    set->bucket_width_m             = 0.07;
    set->smooth_half_s              = DIG_SMOOTH_HALF_s;
    set->trajectories               = TRAJECTORIES;
    (void)strcpy(set->trajectory[0].name, "simpleA");
    (void)strcpy(set->trajectory[1].name, "actual");
    for (int t = 0; t < TRAJECTORIES; t++) {
        set->trajectory[t].phases   = 1;
        set->trajectory[t].phase[0] = (struct dig_phase){ .duration_s = 2.0, .vx_mps = 0.05 };
    }
    cube_table_init(&b->cube);
    for (int g = 0; g < GRAVELS; g++) {
        b->cube.packings[g * TRAJECTORIES] = 3;
        for (int p = 0; p < DIG_CURVE_POINTS; p++) {
            b->cube.curve[g * TRAJECTORIES].mean[DIG_CHANNEL_MY_Nm][p] = (float)moment_Nm(g, p);
            b->cube.curve[g * TRAJECTORIES].sd[DIG_CHANNEL_MY_Nm][p]   = 0.01F;
        }
    }
    b->config.estimator         = dig_estimator_settings_default();
    b->config.match_evaluations = 300;
    b->config.match_least_path  = 0.6;
    b->config.match_expires_s   = 3600.0;
    b->config.drift_floors      = 3.0;
    wires_init(&b->wires);
    wires_init_fit(&b->wires, &b->config, set, &b->fit);
    return b;
}

// A dig in one of the gravels, its moment times a factor.
static void dig_in(struct bench *const b, const int gravel, const int trajectory,
                   const double factor)
{
    struct dig_observation dig = {
        .dig_count = 5, .trajectory = trajectory, .first = 0.0, .last = 1.0
    };
    for (int p = 0; p < DIG_CURVE_POINTS; p++) {
        dig.moment_Nm[p] = factor * moment_Nm(gravel, p);
        dig.sigma_Nm[p]  = 0.005;
    }
    dig_fit_take(&b->fit, &dig);
}

static void a_simple_dig_identifies_the_gravel_it_was_made_of(void **state)
{
    (void)state;
    struct bench *const b = bench_create();
    for (int gravel = 0; gravel < GRAVELS; gravel++) {
        struct dig_fit_result result;
        b->fit.known = (struct dig_known){ .any = false };
        dig_in(b, gravel, 0, 1.0);
        const struct dig_offer *const offer = dig_latest_look(&b->wires.offer);
        assert_non_null(offer);
        assert_true(offer->known && offer->set == &b->cube.set && offer->generation == 1);
        assert_int_equal(offer->dig_count, 5);
        assert_true(offer->forecast.along[0].valid);
        assert_false(offer->forecast.along[1].valid); // the table has no such curve
        assert_true(dig_ring_pop(&b->wires.results, &result));
        assert_true(result.known.valid && !result.known.restored);
        assert_int_equal(result.known.match.nearest, gravel);
        assert_string_equal(result.known.trajectory, "simpleA");
        assert_int_equal(result.known.match.digs, 1);
        assert_close(result.known.path_measured, 1.0, 0.0);
        assert_string_equal(result.hint_trajectory, ""); // nor says it what a bucket carries
    }
    assert_int_equal(atomic_load(&b->fit.matches), GRAVELS);
    assert_false(dig_fit_once(&b->fit));
    free(b);
}

static void a_dig_that_does_not_identify_is_passed_over(void **state)
{
    (void)state;
    struct bench *const b = bench_create();
    struct dig_note     note;
    dig_in(b, 0, 1, 1.0);
    assert_null(dig_latest_look(&b->wires.offer));
    assert_false(dig_latest_take(&b->wires.notes, &note));
    assert_int_equal(atomic_load(&b->fit.matches), 0);
    free(b);
}

static void a_dig_the_table_has_no_curve_for_is_said_and_matches_nothing(void **state)
{
    (void)state;
    struct bench *const b = bench_create();
    struct dig_note     note;
    (void)strcpy(b->config.identify_trajectory[0], "actual");
    b->config.identify_trajectories = 1;
    dig_in(b, 0, 1, 1.0);
    assert_null(dig_latest_look(&b->wires.offer));
    assert_true(dig_latest_take(&b->wires.notes, &note));
    assert_non_null(strstr(note.text, "dig 5 (actual): no match"));
    free(b);
}

// Digs that identify nothing watch the ground: as predicted it is the same; two in a row that are
// not, and it counts as another.
static void a_dig_broken_off_leaves_what_is_known(void **state)
{
    (void)state;
    struct bench *const    b   = bench_create();
    struct dig_observation dig = { .dig_count = 6, .trajectory = 0, .first = 0.0 };
    for (int p = 0; p < DIG_CURVE_POINTS; p++) {
        dig.moment_Nm[p] = moment_Nm(7, p);
        dig.sigma_Nm[p]  = 0.005;
    }
    dig_in(b, 3, 0, 1.0);
    dig.last = 0.59;
    dig_fit_take(&b->fit, &dig);
    assert_int_equal(b->fit.known.match.dig_count, 5);
    struct dig_note note;
    assert_true(dig_latest_take(&b->wires.notes, &note));
    assert_non_null(strstr(note.text, "59 % of its path was measured, expected at least 60 %"));

    dig.last = 0.61;
    dig_fit_take(&b->fit, &dig);
    assert_int_equal(b->fit.known.match.dig_count, 6);
    free(b);
}

static void ground_that_changed_is_no_longer_known(void **state)
{
    (void)state;
    struct bench *const b = bench_create();
    for (int g = 0; g < GRAVELS; g++) {
        b->cube.packings[g * TRAJECTORIES + 1] = 3;
        b->cube.curve[g * TRAJECTORIES + 1]    = b->cube.curve[g * TRAJECTORIES];
    }
    dig_in(b, 3, 0, 1.0);
    assert_true(b->fit.known.valid);
    for (int i = 0; i < 5; i++) {
        dig_in(b, 3, 1, 1.0);
        assert_true(b->fit.known.valid);
        assert_true(b->fit.known.drift < 1.0);
    }
    const double factor[] = { 1.5, 1.0, 1.5, 1.5 };
    for (int i = 0; i < 4; i++) {
        dig_in(b, 3, 1, factor[i]);
        assert_true((b->fit.known.drift > 3.0) == (factor[i] > 1.0));
        assert_true(b->fit.known.valid == (i < 3));
    }
    const struct dig_offer *const offer = dig_latest_look(&b->wires.offer);
    assert_non_null(offer);
    assert_false(offer->known);
    assert_true(offer->expires_ns > 0);
    struct dig_fit_result result;
    while (dig_ring_pop(&b->wires.results, &result)) {
    }
    assert_false(result.known.valid);
    assert_string_equal(result.known.wanted, "the ground has changed: dig a simple dig");

    // A simple dig, and it is known again.
    dig_in(b, 5, 0, 1.0);
    assert_true(b->fit.known.valid);
    assert_int_equal(b->fit.known.match.nearest, 5);
    free(b);
}

static double friction_width(const struct dig_match *const m)
{
    return m->high.value[DIG_AXIS_FRICTION] - m->low.value[DIG_AXIS_FRICTION];
}

// How far factor times a gravel is from what is predicted of it, in floors.
static double drift_of(struct bench *const b, const int gravel, const double factor)
{
    const struct dig_known before = b->fit.known;
    dig_in(b, gravel, 1, factor);
    const double          drift = b->fit.known.drift;
    struct dig_fit_result result;
    b->fit.known = before;
    while (dig_ring_pop(&b->wires.results, &result)) {
    }
    return drift;
}

static struct bench *bench_of_two_digs(void)
{
    struct bench *const b = bench_create();
    for (int g = 0; g < GRAVELS; g++) {
        b->cube.packings[g * TRAJECTORIES + 1] = 3;
        b->cube.curve[g * TRAJECTORIES + 1]    = b->cube.curve[g * TRAJECTORIES];
    }
    return b;
}

static void simple_digs_of_one_ground_are_matched_together(void **state)
{
    (void)state;
    struct bench *const b      = bench_create();
    double              before = INFINITY;
    for (int i = 1; i <= 10; i++) {
        dig_in(b, 5, 0, i % 2 == 0 ? 1.01 : 0.99);
        const struct dig_match *const m    = &b->fit.known.match;
        const size_t                  digs = i < DIG_POOL_MAX ? (size_t)i : DIG_POOL_MAX;
        assert_int_equal(m->digs, digs);
        assert_int_equal(m->nearest, 5);
        assert_true(i > 4 || friction_width(m) < before);
        assert_true(isnan(b->fit.known.drift) == (i == 1));
        before = friction_width(m);
    }
    assert_int_equal(atomic_load(&b->fit.matches), 10);
    free(b);
}

// Of several that agreed, one that differs is doubted; the second, or one far off, begins anew.
static void a_simple_dig_that_differs_is_doubted_first(void **state)
{
    (void)state;
    struct bench *const b = bench_of_two_digs();
    for (int i = 0; i < 3; i++) {
        dig_in(b, 5, 0, 1.0);
    }
    double factor = 1.0;
    while (drift_of(b, 5, factor) < 4.0) {
        factor += 0.01;
    }
    assert_true(drift_of(b, 5, factor) < 6.0);
    struct dig_fit_result result;
    dig_in(b, 5, 0, factor);
    while (dig_ring_pop(&b->wires.results, &result)) {
    }
    assert_true(result.known.valid);
    assert_int_equal(result.known.match.digs, 3);
    assert_true(result.known.drift > 3.0);
    assert_string_equal(result.known.wanted,
                        "a simple dig differed from those before: dig another");
    dig_in(b, 5, 0, 1.0);
    assert_int_equal(b->fit.known.match.digs, 4);
    assert_string_equal(b->fit.known.wanted, "");

    dig_in(b, 5, 0, factor);
    assert_int_equal(b->fit.known.match.digs, 4);
    dig_in(b, 5, 0, factor);
    assert_int_equal(b->fit.known.match.digs, 1);
    assert_true(isnan(b->fit.known.drift));
    assert_int_equal(b->fit.pool.digs, 1);
    assert_close(b->fit.pool.dig[0].moment_Nm[100], factor * moment_Nm(5, 100), 1e-12);

    // Of one against one the younger counts; and so does one that is far off.
    dig_in(b, 5, 0, 1.0);
    dig_in(b, 5, 0, 1.0);
    dig_in(b, 5, 0, 1.0);
    assert_true(b->fit.known.match.digs >= 2);
    dig_in(b, 0, 0, 0.5);
    assert_int_equal(b->fit.known.match.digs, 1);
    free(b);
}

static void a_ground_given_up_is_not_matched_with_the_next(void **state)
{
    (void)state;
    struct bench *const b = bench_of_two_digs();
    dig_in(b, 5, 0, 1.0);
    dig_in(b, 5, 0, 1.0);
    dig_in(b, 5, 1, 2.0);
    dig_in(b, 5, 1, 2.0);
    assert_false(b->fit.known.valid);
    dig_in(b, 5, 0, 1.0);
    assert_true(b->fit.known.valid);
    assert_int_equal(b->fit.known.match.digs, 1);
    free(b);
}

static void a_gravel_that_is_too_old_is_no_longer_known(void **state)
{
    (void)state;
    struct bench *const b           = bench_create();
    b->fit.known_settings.expires_s = 0.05;
    dig_in(b, 3, 0, 1.0);
    assert_false(dig_fit_once(&b->fit));
    assert_true(b->fit.known.valid);
    (void)dig_latest_look(&b->wires.offer);
    const struct timespec pause = { .tv_nsec = 60000000L };
    (void)nanosleep(&pause, NULL);
    assert_false(dig_fit_once(&b->fit));
    assert_false(b->fit.known.valid);
    const struct dig_offer *const offer = dig_latest_look(&b->wires.offer);
    assert_non_null(offer);
    assert_false(offer->known);
    free(b);
}

// A file of a match comes back as that match; another table's, an old one or a damaged one does
// not.
static void what_is_known_survives_in_its_file(void **state)
{
    (void)state;
    struct bench *const b = bench_create();
    (void)snprintf(b->config.match_state.text, sizeof b->config.match_state.text, "%s",
                   scratch_path("match.json"));
    (void)strcpy(b->cube.set.scene_hash,
                 "9a66b75d3dbf255ea79c13c1c43a401f089ead1b9d22f68b09cfd554af26f411");
    dig_in(b, 6, 0, 1.0);
    const struct dig_known before = b->fit.known;

    struct bench *const again = bench_create();
    again->config.match_state = b->config.match_state;
    memcpy(again->cube.set.scene_hash, b->cube.set.scene_hash, sizeof b->cube.set.scene_hash);
    dig_fit_restore(&again->fit);
    const struct dig_known *const k = &again->fit.known;
    assert_true(k->valid && k->restored);
    assert_int_equal(k->match.nearest, 6);
    assert_int_equal(k->match.samples, before.match.samples);
    for (int a = 0; a < DIG_AXES; a++) {
        assert_close(k->match.gravel.value[a], before.match.gravel.value[a],
                     1e-8 * before.match.gravel.value[a]);
    }
    const struct dig_offer *const offer = dig_latest_look(&again->wires.offer);
    assert_non_null(offer);
    assert_true(offer->known && offer->forecast.along[0].valid);

    static const struct {
        const char *what, *expected;
    } bad[] = { { "table", "expected one of the table's" },
                { "old", "h old, expected at most" },
                { "future", "h old, expected at most" },
                { "damaged", "match.json" } };
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        struct bench *const other = bench_create();
        other->config.match_state = b->config.match_state;
        memcpy(other->cube.set.scene_hash, b->cube.set.scene_hash, sizeof b->cube.set.scene_hash);
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
        struct dig_note note = { "" };
        assert_false(other->fit.known.any);
        assert_null(dig_latest_look(&other->wires.offer));
        assert_true(dig_latest_take(&other->wires.notes, &note));
        assert_non_null(strstr(note.text, bad[i].expected));
        free(other);
    }
    free(b);
    free(again);
}

// After a restart the digs before still count; from a file without them the next begins anew.
static void the_digs_of_a_ground_survive_too(void **state)
{
    (void)state;
    struct bench *const b = bench_create();
    (void)snprintf(b->config.match_state.text, sizeof b->config.match_state.text, "%s",
                   scratch_path("pool.json"));
    (void)strcpy(b->cube.set.scene_hash,
                 "9a66b75d3dbf255ea79c13c1c43a401f089ead1b9d22f68b09cfd554af26f411");
    for (int i = 0; i < 9; i++) {
        dig_in(b, 5, 0, 1.0 + 0.001 * i);
    }
    for (int bare = 0; bare < 2; bare++) {
        struct bench *const again = bench_create();
        again->config.match_state = b->config.match_state;
        memcpy(again->cube.set.scene_hash, b->cube.set.scene_hash, sizeof b->cube.set.scene_hash);
        if (bare == 1) {
            struct dig_identity id;
            assert_int_equal(dig_identity_read(scratch_path("pool.json"), &id, NULL), DIG_OK);
            id.recorded      = 0;
            FILE *const file = fopen(scratch_path("pool.json"), "w");
            dig_identity_write(file, &id);
            (void)fclose(file);
        }
        dig_fit_restore(&again->fit);
        assert_true(again->fit.known.restored && again->fit.known.match.digs == DIG_POOL_MAX);
        assert_int_equal(again->fit.pool.digs, bare == 1 ? 0 : DIG_POOL_MAX);
        if (bare == 0) {
            for (int k = 0; k < DIG_CURVE_POINTS; k++) {
                assert_close(again->fit.pool.dig[7].moment_Nm[k], b->fit.pool.dig[7].moment_Nm[k],
                             1e-6);
            }
        }
        dig_in(again, 5, 0, 1.0);
        assert_int_equal(again->fit.known.match.digs, bare == 1 ? 1 : DIG_POOL_MAX);
        assert_false(again->fit.known.restored);
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
                curve->mean[1 + c][p] = (float)((c == 0 ? -3.0 : 2.0) * moment_Nm(GRAVELS - g, p));
                curve->sd[1 + c][p]   = 0.03F;
            }
        }
    }
}

// A dig in one of the gravels, with its forces.
static void dig_with_forces_in(struct bench *const b, const int gravel, const double factor)
{
    struct dig_observation dig = { .dig_count = 5, .last = 1.0, .forces = true };
    for (int p = 0; p < DIG_CURVE_POINTS; p++) {
        dig.moment_Nm[p] = factor * moment_Nm(gravel, p);
        dig.sigma_Nm[p]  = 0.005;
        for (int c = 0; c < 2; c++) {
            dig.force_N[c][p]       = (double)b->cube.curve[gravel * TRAJECTORIES].mean[1 + c][p];
            dig.force_sigma_N[c][p] = 0.02 + 0.001 * c;
        }
    }
    dig_fit_take(&b->fit, &dig);
}

// What comes after a restart is matched with the forces of what was before it.
static void the_forces_of_a_ground_survive_too(void **state)
{
    (void)state;
    struct bench *const b = bench_create(), *const again = bench_create();
    for (int i = 0; i < 2; i++) {
        struct bench *const one = i == 0 ? b : again;
        give_forces(one);
        (void)snprintf(one->config.match_state.text, sizeof one->config.match_state.text, "%s",
                       scratch_path("forces.json"));
        (void)strcpy(one->cube.set.scene_hash,
                     "9a66b75d3dbf255ea79c13c1c43a401f089ead1b9d22f68b09cfd554af26f411");
    }
    for (int i = 0; i < 8; i++) {
        dig_with_forces_in(b, 5, 1.0 + 0.001 * i);
    }
    assert_true(b->fit.known.match.forces);
    dig_fit_restore(&again->fit);
    assert_true(again->fit.known.restored && again->fit.known.match.forces);
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
    assert_true(again->fit.known.match.forces && again->fit.known.match.digs == 8);
    for (int a = 0; a < DIG_AXES; a++) {
        assert_close(again->fit.known.match.low.value[a], b->fit.known.match.low.value[a],
                     1e-5 * b->fit.known.match.low.value[a]);
        assert_close(again->fit.known.match.high.value[a], b->fit.known.match.high.value[a],
                     1e-5 * b->fit.known.match.high.value[a]);
    }

    // A dig that lacks them leaves the moment to the pool.
    dig_in(again, 5, 0, 1.0);
    assert_false(again->fit.known.match.forces);
    free(b);
    free(again);
}

static void a_file_that_cannot_be_written_is_said_and_the_match_stands(void **state)
{
    (void)state;
    struct bench *const b = bench_create();
    (void)strcpy(b->config.match_state.text, "/dev/full");
    dig_in(b, 6, 0, 1.0);
    struct dig_note note = { "" };
    assert_true(b->fit.known.valid);
    assert_true(dig_latest_take(&b->wires.notes, &note));
    assert_non_null(strstr(note.text, "/dev/full"));
    free(b);
}

// Energy per kilogram: the bucket that is filled with less work wins, unless it carries too little.
static void the_hint_is_the_dig_that_carries_for_the_least_energy(void **state)
{
    (void)state;
    struct bench *const  b          = bench_create();
    struct dig_forecast *f          = calloc(1, sizeof *f);
    double               J_per_kg   = -1.0;
    const double         energy_J[] = { 900.0, 500.0 }, carried_kg[] = { 2.0, 1.5 };
    for (int t = 0; t < TRAJECTORIES; t++) {
        f->along[t].valid                                                    = true;
        f->along[t].energy_J                                                 = energy_J[t];
        f->along[t].curve.mean[DIG_CHANNEL_CARRIED_kg][DIG_CURVE_POINTS - 1] = (float)carried_kg[t];
    }
    assert_int_equal(dig_known_hint(&b->cube.set, f, 10.0, &J_per_kg), 1);
    assert_close(J_per_kg, 500.0 / 1500.0, 1e-9);
    f->along[1].curve.mean[DIG_CHANNEL_CARRIED_kg][DIG_CURVE_POINTS - 1] = 0.9F;
    assert_int_equal(dig_known_hint(&b->cube.set, f, 10.0, &J_per_kg), 0);
    for (int t = 0; t < TRAJECTORIES; t++) {
        f->along[t].curve.mean[DIG_CHANNEL_CARRIED_kg][DIG_CURVE_POINTS - 1] = NAN;
    }
    assert_int_equal(dig_known_hint(&b->cube.set, f, 10.0, &J_per_kg), -1);
    free(f);
    free(b);
}

// A table dug at several depths, on a bench of its own.
struct deep_bench {
    struct dig_config     config;
    struct approach_table table;
    struct wires          wires;
    struct dig_fit        fit;
};

static double growing(const double depth, const double attack_rad)
{
    return depth * depth - 1.5 * attack_rad;
}

static struct deep_bench *deep_bench_create(void)
{
    static const struct dig_approach way[] = { { 0.8, 0.0 }, { 1.0, 0.1 }, { 1.2, 0.0 } };
    struct deep_bench *const         b     = calloc(1, sizeof *b);
    assert_non_null(b);
    approach_table_init(&b->table, CUBE_GRAVELS, 3, way, growing, 0.05, 3);
    b->config.estimator         = dig_estimator_settings_default();
    b->config.match_evaluations = 300;
    b->config.match_least_path  = 0.6;
    b->config.match_expires_s   = 3600.0;
    b->config.drift_floors      = 3.0;
    wires_init(&b->wires);
    wires_init_fit(&b->wires, &b->config, &b->table.cube.set, &b->fit);
    dig_matcher_take_up(&b->fit.matcher, &b->table.cube.set);
    return b;
}

static void deep_bench_destroy(struct deep_bench *const b)
{
    dig_matcher_finish(&b->fit.matcher);
    free(b);
}

static void dig_deep(struct deep_bench *const b, const size_t gravel, const size_t t,
                     const double depth, const double told)
{
    static uint32_t             count;
    const struct dig_trajectory dug = approach_dug(t, (struct dig_approach){ depth, 0.0 });
    struct dig_curve            curve;
    approach_curve(gravel, t, &dug, growing(depth, 0.0), 0.05, &curve);
    struct dig_observation dig = { .dig_count  = ++count,
                                   .trajectory = (int)t,
                                   .approach   = { told, 0.0 },
                                   .first      = 0.0,
                                   .last       = 1.0 };
    for (int p = 0; p < DIG_CURVE_POINTS; p++) {
        dig.moment_Nm[p] = (double)curve.mean[DIG_CHANNEL_MY_Nm][p];
        dig.sigma_Nm[p]  = 0.005;
    }
    dig_fit_take(&b->fit, &dig);
}

static void digs_of_different_depths_are_matched_together(void **state)
{
    (void)state;
    struct deep_bench *const b = deep_bench_create();
    dig_deep(b, 5, 0, 0.9, 0.9);
    dig_deep(b, 5, 0, 1.15, 1.15);
    dig_deep(b, 5, 0, 1.0, 1.0);
    assert_true(b->fit.known.valid);
    assert_int_equal(b->fit.pool.digs, 3); // none was a stranger to what the others let expect
    assert_int_equal(b->fit.known.match.digs, 3);
    assert_int_equal(b->fit.known.match.nearest, 5);
    assert_true(b->fit.known.match.distance < 0.02);
    assert_int_equal(b->fit.known.differed, 0);

    // The same digs taken for plain ones contradict each other.
    b->fit.known = (struct dig_known){ .any = false };
    dig_deep(b, 5, 0, 0.8, 1.0);
    dig_deep(b, 5, 0, 1.2, 1.0);
    assert_true(b->fit.pool.digs < 2 || b->fit.known.match.distance > 0.1);
    deep_bench_destroy(b);
}

static void a_deep_dig_is_no_sign_of_other_ground(void **state)
{
    (void)state;
    struct deep_bench *const b = deep_bench_create();
    dig_deep(b, 2, 0, 1.0, 1.0);
    assert_true(b->fit.known.valid);
    for (int i = 0; i < 3; i++) {
        dig_deep(b, 2, 1, 1.2, 1.2);
        assert_true(b->fit.known.valid);
        assert_true(b->fit.known.drift < 1.0);
    }
    dig_deep(b, 2, 1, 1.2, 1.0); // taken for a plain one it is
    assert_true(b->fit.known.drift > 1.5);
    deep_bench_destroy(b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(digs_of_different_depths_are_matched_together),
        cmocka_unit_test(a_deep_dig_is_no_sign_of_other_ground),
        cmocka_unit_test(a_simple_dig_identifies_the_gravel_it_was_made_of),
        cmocka_unit_test(a_dig_that_does_not_identify_is_passed_over),
        cmocka_unit_test(a_dig_the_table_has_no_curve_for_is_said_and_matches_nothing),
        cmocka_unit_test(a_dig_broken_off_leaves_what_is_known),
        cmocka_unit_test(ground_that_changed_is_no_longer_known),
        cmocka_unit_test(simple_digs_of_one_ground_are_matched_together),
        cmocka_unit_test(a_simple_dig_that_differs_is_doubted_first),
        cmocka_unit_test(a_ground_given_up_is_not_matched_with_the_next),
        cmocka_unit_test(a_gravel_that_is_too_old_is_no_longer_known),
        cmocka_unit_test(what_is_known_survives_in_its_file),
        cmocka_unit_test(the_digs_of_a_ground_survive_too),
        cmocka_unit_test(the_forces_of_a_ground_survive_too),
        cmocka_unit_test(a_file_that_cannot_be_written_is_said_and_the_match_stands),
        cmocka_unit_test(the_hint_is_the_dig_that_carries_for_the_least_energy),
    };
    return cmocka_run_group_tests_name("fit", tests, scratch_setup, scratch_teardown);
}

// A tick with a real estimator and a table of formulas, whose other ends the test holds.

#ifndef DIG_TESTS_LOOP_BENCH_H
#define DIG_TESTS_LOOP_BENCH_H

#include "firmware_host/tick/loop.h"

#include "files/machine_yaml.h"
#include "files/scene_yaml.h"
#include "tests/cube_table.h"
#include "tests/testlib.h"
#include "tests/wires.h"

#include <stdlib.h>
#include <string.h>

#define MS              1000000LL // in ns
#define BENCH_ESTIMATES 8         // that wait at most

// Everything a loop needs, and the other ends of its handoffs.
struct bench {
    struct dig_machine            machine;
    struct dig_scene              scene;
    struct cube_table             cube;
    struct dig_estimator_settings estimator_settings;
    struct dig_estimator         *estimator;
    struct wires                  wires;
    struct dig_recorded_dig      *buffer[2];
    struct dig_loop               loop;
};

static inline void bench_fill_table(struct bench *const b)
{
    struct dig_curve_set *const set = &b->cube.set;
    set->tooth_m                    = dig_scene_tooth_m(&b->scene);
    set->bucket_width_m             = b->scene.bucket.width_m;
    set->young_Pa                   = b->scene.material.young_Pa;
    set->smooth_half_s              = DIG_SMOOTH_HALF_s;
    set->trajectories               = b->scene.trajectories;
    memcpy(set->trajectory, b->scene.trajectory, sizeof set->trajectory);
    cube_table_init(&b->cube);
    for (int g = 0; g < CUBE_GRAVELS; g++) {
        for (size_t t = 0; t < set->trajectories; t++) {
            const size_t at      = (size_t)g * set->trajectories + t;
            b->cube.packings[at] = 3;
            for (int p = 0; p < DIG_CURVE_POINTS; p++) {
                b->cube.curve[at].mean[DIG_CHANNEL_MY_Nm][p] = 0.1F * (float)(1 + g);
                b->cube.curve[at].sd[DIG_CHANNEL_MY_Nm][p]   = 0.01F;
            }
        }
    }
}

static inline struct bench *bench_create(void)
{
    struct bench *const b = calloc(1, sizeof *b);
    assert_non_null(b);
    assert_int_equal(dig_machine_read("config/machines/zx200_trench.yaml", &b->machine, NULL),
                     DIG_OK);
    assert_int_equal(dig_scene_read("config/scenes/rig.yaml", &b->scene, NULL), DIG_OK);
    bench_fill_table(b);
    b->estimator_settings = dig_estimator_settings_default();
    b->estimator          = calloc(1, dig_estimator_size());
    assert_non_null(b->estimator);
    assert_int_equal(
        dig_estimator_init(b->estimator, &b->machine, &b->cube.set, &b->estimator_settings),
        DIG_OK);
    wires_init(&b->wires);
    dig_ring_init(&b->wires.handoffs.estimates, sizeof b->wires.memory.estimates[0],
                  BENCH_ESTIMATES, b->wires.memory.estimates);
    for (int i = 0; i < 2; i++) {
        b->buffer[i] = calloc(1, dig_recorded_dig_size());
        assert_non_null(b->buffer[i]);
        (void)dig_ring_push(&b->wires.handoffs.spares, &b->buffer[i]);
    }
    const struct dig_loop_settings settings = wires_loop_settings(&b->cube.set);
    dig_loop_init(&b->loop, &settings, &b->wires.handoffs, b->estimator);
    return b;
}

static inline void bench_destroy(struct bench *const b)
{
    free(b->estimator);
    free(b->buffer[0]);
    free(b->buffer[1]);
    free(b);
}

// What the matcher says of a gravel of the table.
static inline void bench_set_basis(struct bench *const b, struct dig_latest *const to,
                                   const int gravel, const int64_t generation,
                                   const int64_t expires_ns)
{
    const struct dig_match             match = { .valid   = true,
                                                 .gravel  = b->cube.gravel[gravel],
                                                 .nearest = gravel };
    struct dig_prediction_basis *const made  = calloc(1, sizeof *made);
    assert_non_null(made);
    made->set        = &b->cube.set;
    made->generation = generation;
    made->known      = true;
    made->dig_count  = 7;
    made->expires_ns = expires_ns;
    dig_forecast_make(&b->cube.set, 10.0, &match, &made->forecast);
    dig_latest_put(to, made);
    free(made);
}

// The bucket held still in the air.
static inline struct dig_reading bench_still(const int64_t time_ns)
{
    static const double value[DIG_SIGNALS] = { 0.2852, -1.046, -0.8984, 8.4e6, 1e6, 1e6,
                                               4.2e6,  1e6,    2e6,     0,     45 };
    struct dig_reading  r                  = { .time_ns = time_ns };
    for (int i = 0; i < DIG_SIGNALS; i++) {
        r.value[i] = value[i];
        r.state[i] = DIG_READING_OK;
    }
    return r;
}

static inline struct dig_tick_status bench_tick_status(struct bench *const b)
{
    struct dig_tick_status tick_status = { 0 };
    assert_true(dig_latest_take(&b->wires.handoffs.tick_status, &tick_status));
    return tick_status;
}

// The bucket held in the air for two seconds; counts the outlooks, the valid ones by trajectory.
static inline int outlooks_in_the_air(struct bench *const b, const int64_t from_ms,
                                      bool seen[DIG_TRAJECTORY_MAX])
{
    int                          outlooks = 0;
    struct dig_prediction_record predictions;
    for (int64_t i = 0; i < 400; i++) {
        const struct dig_reading r = bench_still((from_ms + i * 5) * MS);
        assert_true(dig_ring_push(&b->wires.handoffs.readings, &r));
        dig_loop_tick(&b->loop, (from_ms + 1 + i * 5) * MS);
        if (dig_latest_take(&b->wires.handoffs.predictions, &predictions)) {
            outlooks++;
            assert_true(predictions.prediction.valid);
            assert_int_equal(predictions.state, DIG_PREDICTION_VALID);
            assert_close(predictions.prediction.from_progress, 0.0, 0.0);
            assert_close(predictions.prediction.to_progress, 1.0, 0.0);
            assert_true(predictions.time_ns == (from_ms + i * 5) * MS);
            assert_true(predictions.expires_ns > predictions.time_ns);
            assert_int_equal(predictions.dig_count, 7);
            seen[predictions.prediction.trajectory] = true;
        }
    }
    return outlooks;
}

#endif // DIG_TESTS_LOOP_BENCH_H

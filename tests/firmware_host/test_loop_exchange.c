// Tests for firmware_host/tick/loop.c: a table or a machine exchanged while it runs

#include "firmware_host/tick/loop.h"

#include "tests/firmware_host/loop_bench.h"

#include <math.h>
#include <stdlib.h>

// Along the trajectory predicted last, of a gravel of the table.
static double peak_told_of(const struct bench *const b, const int gravel)
{
    static struct dig_forecast forecast;
    const struct dig_match     match = { .valid   = true,
                                         .gravel  = b->cube.gravel[gravel],
                                         .nearest = gravel };
    dig_forecast_make(&b->cube.set, 10.0, &match, &forecast);
    return forecast.expected[b->loop.published.prediction.trajectory].peak_Nm;
}

// Another table: what belongs to the one before is not used with it, and the other way round.
TEST(a_table_is_exchanged_with_the_forecast_that_belongs_to_it)
{
    struct bench *const b                        = bench_create();
    bool                seen[DIG_TRAJECTORY_MAX] = { false };
    bench_set_basis(b, &b->wires.handoffs.basis, 3, 1, INT64_MAX);
    assert_in_range(outlooks_in_the_air(b, 1000, seen), 3, 5);
    assert_int_equal(atomic_load(&b->loop.generation), 1);
    bench_set_basis(b, &b->wires.handoffs.table, 5, 2, INT64_MAX);
    assert_in_range(outlooks_in_the_air(b, 3000, seen), 3, 5);
    assert_int_equal(atomic_load(&b->loop.generation), 2);
    assert_int_equal(bench_tick_status(b).generation, 2);
    assert_close(b->loop.published.prediction.peak_Nm, peak_told_of(b, 5), 1e-9);
    bench_set_basis(b, &b->wires.handoffs.basis, 3, 1, INT64_MAX); // late: of the table before
    assert_in_range(outlooks_in_the_air(b, 5000, seen), 3, 5);
    assert_close(b->loop.published.prediction.peak_Nm, peak_told_of(b, 5), 1e-9);
    assert_true(fabs(peak_told_of(b, 3) / peak_told_of(b, 5) - 1.0) > 0.1);
    bench_destroy(b);
}

// The moment that an estimator of the file's machine tells of a bucket held still, with a
// correction from the start or without, after so many samples.
static double moment_of_Nm(const struct bench *const b, const struct dig_correction *const by,
                           const int samples)
{
    struct dig_estimator *const  e = calloc(1, dig_estimator_size());
    struct dig_corrected_machine corrected;
    struct dig_estimate          estimate;
    assert_non_null(e);
    assert_int_equal(dig_estimator_init(e, &b->machine, &b->cube.set, &b->estimator_settings),
                     DIG_OK);
    assert_int_equal(dig_correction_apply(&b->machine, by, &corrected), DIG_OK);
    dig_estimator_set_machine(e, &corrected);
    for (int64_t i = 0; i < samples; i++) {
        const struct dig_reading r      = bench_still((1000 + i * 5) * MS);
        struct dig_sample        sample = { .time_ns = r.time_ns };
        for (size_t s = 0; s < DIG_SIGNALS; s++) {
            sample.value[s] = r.value[s];
            sample.valid[s] = true;
        }
        assert_int_equal(dig_estimator_step(e, &sample, &estimate), DIG_OK);
    }
    free(e);
    return estimate.wrench.My_Nm;
}

// So many ticks with the bucket in the air, or in soil that pushes; the moment of the last.
static double moment_after_Nm(struct bench *const b, int64_t *const at_ms, const int ticks,
                              const double push_Pa)
{
    for (int i = 0; i < ticks; i++) {
        struct dig_reading r = bench_still(*at_ms * MS);
        r.value[DIG_SIGNAL_BUCKET_HEAD_Pa] += push_Pa;
        assert_true(dig_ring_push(&b->wires.handoffs.readings, &r));
        dig_loop_tick(&b->loop, (*at_ms + 1) * MS);
        *at_ms += 5;
    }
    return b->loop.estimate.wrench.My_Nm;
}

// What a reload brings: a machine that a model corrects, with the table it comes with.
static void offer_machine(struct bench *const b, const struct dig_correction *const by,
                          const int64_t generation)
{
    struct dig_prediction_basis *const made = calloc(1, sizeof *made);
    assert_non_null(made);
    made->set        = &b->cube.set;
    made->generation = generation;
    assert_int_equal(dig_correction_apply(&b->machine, by, &made->machine), DIG_OK);
    dig_latest_put(&b->wires.handoffs.table, made);
    free(made);
}

TEST(a_corrected_machine_is_taken_up_between_two_digs_as_if_from_the_start)
{
    struct bench *const         b     = bench_create();
    const struct dig_correction heavy = { .link[DIG_JOINT_BUCKET] = { .mass_kg = 250.0 } };
    const struct dig_correction none  = { .delay_s = 0.0 };
    int64_t                     at_ms = 1000;

    // In a dig the machine stays as it is; push_Pa makes the moment of another sample.
    (void)moment_after_Nm(b, &at_ms, 200, 0.0);
    const double digging_Nm = moment_after_Nm(b, &at_ms, 100, 15e6);
    assert_int_not_equal(b->loop.estimate.phase, DIG_PHASE_AIR);
    offer_machine(b, &heavy, 2);
    assert_close(moment_after_Nm(b, &at_ms, 100, 15e6), digging_Nm, 1e-9);
    assert_int_equal(b->loop.tick_status.generation, 1);

    // In the air the new one is used, as by an estimator that has had it from the start.
    int waited = 0;
    while (b->loop.tick_status.generation == 1 && waited++ < 1000) {
        (void)moment_after_Nm(b, &at_ms, 1, 0.0);
    }
    assert_int_equal(b->loop.tick_status.generation, 2);
    assert_true(fabs(moment_of_Nm(b, &heavy, 100) - moment_of_Nm(b, &none, 100)) > 100.0);
    assert_close(moment_after_Nm(b, &at_ms, 99, 0.0), moment_of_Nm(b, &heavy, 100), 1e-6);

    // The same again is nothing new: what free air taught stays learnt.
    offer_machine(b, &heavy, 3);
    assert_close(moment_after_Nm(b, &at_ms, 100, 0.0), moment_of_Nm(b, &heavy, 200), 1e-6);
    assert_int_equal(b->loop.tick_status.generation, 3);

    // And taken off again.
    offer_machine(b, &none, 4);
    assert_close(moment_after_Nm(b, &at_ms, 100, 0.0), moment_of_Nm(b, &none, 100), 1e-6);
    bench_destroy(b);
}

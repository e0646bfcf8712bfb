// Tests for tables/queue.c

#include "tables/queue.h"

#include "tests/tables_fixture.h"

// Two frictions by three rolling frictions.
static struct dig_plan plan_of(const size_t packings)
{
    static struct dig_plan_point point[6];
    static const double          rolling[] = { .1, .2, .4 };
    for (size_t i = 0; i < 6; i++) {
        point[i] = (struct dig_plan_point){ .gravel = { { i < 3 ? .3 : .5, rolling[i % 3], 2500 } },
                                            .packings = packings };
    }
    return (struct dig_plan){
        .points       = 6,
        .point        = point,
        .trajectories = 2,
        .trajectory   = { 1, 0 },
    };
}

static struct dig_queue queue_of(struct dig_store *const store, const struct dig_plan *const plan)
{
    struct dig_queue queue = { 0 };
    assert_int_equal(dig_queue_make(store, plan, &queue, NULL), DIG_OK);
    return queue;
}

TEST(every_point_has_a_first_bed_before_any_has_a_second)
{
    struct dig_store *const store = fixture_create("order.sqlite");
    const struct dig_plan   plan  = plan_of(3);
    struct dig_queue        queue = queue_of(store, &plan);
    assert_int_equal(queue.jobs, 18);
    assert_int_equal(queue.digs_total, 36);
    assert_int_equal(queue.digs_done, 0);
    for (size_t i = 0; i < queue.jobs; i++) {
        assert_int_equal(queue.job[i].origin.packing, i / 6);
        assert_int_equal(queue.job[i].digs, 2);
        assert_int_equal(queue.job[i].trajectory[0], 1);
        assert_int_equal(queue.job[i].trajectory[1], 0);
        for (size_t k = 0; k < i; k++) {
            assert_true(memcmp(&queue.job[i].origin.gravel, &queue.job[k].origin.gravel,
                               sizeof queue.job[i].origin.gravel) != 0 ||
                        queue.job[i].origin.packing != queue.job[k].origin.packing);
            assert_true(queue.job[i].origin.seed != queue.job[k].origin.seed);
        }
    }
    dig_queue_finish(&queue);
    dig_store_close(store);
}

TEST(what_the_table_holds_is_not_dug_again)
{
    struct dig_store *const store = fixture_create("resume.sqlite");
    const struct dig_plan   plan  = plan_of(2);
    fixture_put(store, .3, .2, 0, 0, 1.0);
    fixture_put(store, .3, .2, 0, 1, 1.0);
    fixture_put(store, .5, .4, 1, 1, 1.0);
    fixture_put(store, .7, .4, 0, 1, 1.0); // not of this plan
    fixture_put(store, .5, .4, 2, 1, 1.0); // nor this
    struct dig_queue queue = queue_of(store, &plan);
    assert_int_equal(queue.digs_total, 24);
    assert_int_equal(queue.digs_done, 3);
    assert_int_equal(queue.jobs, 11);
    size_t digs = 0;
    for (size_t i = 0; i < queue.jobs; i++) {
        const struct dig_job *const job = &queue.job[i];
        digs += job->digs;
        assert_false(job->origin.gravel.value[0] < .4 && job->origin.gravel.value[1] > .15 &&
                     job->origin.gravel.value[1] < .3 && job->origin.packing == 0);
        if (job->origin.gravel.value[0] > .4 && job->origin.gravel.value[1] > .3 &&
            job->origin.packing == 1) {
            assert_int_equal(job->digs, 1);
            assert_int_equal(job->trajectory[0], 0);
        }
    }
    assert_int_equal(digs, 21);
    dig_queue_finish(&queue);

    const struct dig_plan more = plan_of(3);
    queue                      = queue_of(store, &more);
    assert_int_equal(queue.digs_done, 4);
    dig_queue_finish(&queue);
    dig_queue_finish(&queue);
    dig_store_close(store);
}

// What one point lacks says nothing of another with an effect, and some points have more beds.
TEST(points_differ_in_effect_magnitude_and_packings)
{
    struct dig_store *const     store    = fixture_create("effects.sqlite");
    const struct dig_plan_point points[] = {
        { .gravel = { { .3, .2, 2500 } }, .packings = 1 },
        { .gravel = { { .3, .2, 2500 } }, .effect = "cohesion", .magnitude = 10, .packings = 3 },
        { .gravel = { { .3, .2, 2500 } }, .effect = "cohesion", .magnitude = 20, .packings = 1 },
    };
    const struct dig_plan       plan = { .points = 3, .point = points, .trajectories = 1 };
    const struct dig_run_origin there =
        fixture_varied(fixture_origin(.3, .2, 2500, 1, 0), "cohesion", 10);
    const struct dig_recording recording = fixture_recording(400, 1.0);
    assert_int_equal(dig_store_put(store, &there, &recording, NULL), DIG_OK);
    fixture_put(store, .3, .2, 0, 0, 1.0);

    struct dig_queue queue = queue_of(store, &plan);
    assert_int_equal(queue.digs_total, 5);
    assert_int_equal(queue.digs_done, 2);
    assert_int_equal(queue.jobs, 3);
    assert_string_equal(queue.job[0].origin.effect, "cohesion");
    assert_close(queue.job[0].origin.magnitude, 10.0, 0.0);
    assert_int_equal(queue.job[0].origin.packing, 0);
    assert_close(queue.job[1].origin.magnitude, 20.0, 0.0);
    assert_int_equal(queue.job[1].origin.packing, 0);
    assert_close(queue.job[2].origin.magnitude, 10.0, 0.0);
    assert_int_equal(queue.job[2].origin.packing, 2);
    assert_true(queue.job[0].origin.seed == dig_bed_seed(&points[0].gravel, 0)); // the plain bed's
    dig_queue_finish(&queue);
    dig_store_close(store);
}

TEST(the_shards_of_a_plan_are_all_of_it_once)
{
    struct dig_store *const store = fixture_create("shards.sqlite");
    struct dig_plan         plan  = plan_of(3);
    struct dig_queue        whole = queue_of(store, &plan);
    size_t                  seen = 0, digs = 0;
    plan.shards = 5;
    for (plan.shard = 0; plan.shard < plan.shards; plan.shard++) {
        struct dig_queue part = queue_of(store, &plan);
        digs += part.digs_total;
        assert_true(part.jobs == 3 || part.jobs == 4);
        for (size_t i = 0; i < part.jobs; i++) {
            size_t times = 0;
            for (size_t k = 0; k < whole.jobs; k++) {
                times += part.job[i].origin.seed == whole.job[k].origin.seed ? 1 : 0;
            }
            assert_int_equal(times, 1);
            seen++;
        }
        // What a shard holds does not depend on what is done.
        if (plan.shard == 2) {
            const struct dig_run_origin *const first = &part.job[0].origin;
            fixture_put(store, first->gravel.value[0], first->gravel.value[1], first->packing, 0,
                        1);
            fixture_put(store, first->gravel.value[0], first->gravel.value[1], first->packing, 1,
                        1);
            struct dig_queue later = queue_of(store, &plan);
            assert_int_equal(later.jobs, part.jobs - 1);
            assert_true(later.job[0].origin.seed == part.job[1].origin.seed);
            dig_queue_finish(&later);
        }
        dig_queue_finish(&part);
    }
    assert_int_equal(seen, whole.jobs);
    assert_int_equal(digs, whole.digs_total);
    dig_queue_finish(&whole);
    dig_store_close(store);
}

// sha256sum of the documented text, first 16 hex digits, halved.
TEST(the_seed_is_the_documented_hash)
{
    const struct dig_gravel gravel = { { 0.5, 0.25, 2500.0 } };
    assert_true(dig_bed_seed(&gravel, 3) == UINT64_C(0x81be28b15b965613) >> 1);
    assert_true(dig_bed_seed(&gravel, 3) < UINT64_C(1) << 63);
    const struct dig_gravel other = { { 0.25, 0.5, 2500.0 } };
    assert_true(dig_bed_seed(&other, 3) != dig_bed_seed(&gravel, 3));
}

TESTS_WITH(scratch_setup, scratch_teardown)

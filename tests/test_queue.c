// Tests for tables/queue.c

#include "tables/queue.h"

#include "tests/tables_fixture.h"

static const double frictions[] = { .3, .5 }, rollings[] = { .1, .2, .4 }, densities[] = { 2500 };
static struct dig_plan plan_of(const size_t packings)
{
    return (struct dig_plan){
        .count        = { 2, 3, 1 },
        .value        = { frictions, rollings, densities },
        .packings     = packings,
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

static void every_point_has_a_first_bed_before_any_has_a_second(void **state)
{
    (void)state;
    struct dig_store *const store = fixture_create("order.sqlite");
    const struct dig_plan   plan  = plan_of(3);
    struct dig_queue        queue = queue_of(store, &plan);
    assert_int_equal(queue.jobs, 18);
    assert_int_equal(queue.digs_total, 36);
    assert_int_equal(queue.digs_done, 0);
    for (size_t i = 0; i < queue.jobs; i++) {
        assert_int_equal(queue.job[i].packing, i / 6);
        assert_int_equal(queue.job[i].digs, 2);
        assert_int_equal(queue.job[i].trajectory[0], 1);
        assert_int_equal(queue.job[i].trajectory[1], 0);
        for (size_t k = 0; k < i; k++) {
            assert_true(memcmp(&queue.job[i].gravel, &queue.job[k].gravel,
                               sizeof queue.job[i].gravel) != 0 ||
                        queue.job[i].packing != queue.job[k].packing);
            assert_true(queue.job[i].seed != queue.job[k].seed);
        }
    }
    dig_queue_finish(&queue);
    dig_store_close(store);
}

static void what_the_table_holds_is_not_dug_again(void **state)
{
    (void)state;
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
        assert_false(job->gravel.value[0] < .4 && job->gravel.value[1] > .15 &&
                     job->gravel.value[1] < .3 && job->packing == 0);
        if (job->gravel.value[0] > .4 && job->gravel.value[1] > .3 && job->packing == 1) {
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

// sha256sum of the documented text, first 16 hex digits, halved.
static void the_seed_is_the_documented_hash(void **state)
{
    (void)state;
    const struct dig_gravel gravel = { { 0.5, 0.25, 2500.0 } };
    assert_true(dig_bed_seed(&gravel, 3) == UINT64_C(0x81be28b15b965613) >> 1);
    assert_true(dig_bed_seed(&gravel, 3) < UINT64_C(1) << 63);
    const struct dig_gravel other = { { 0.25, 0.5, 2500.0 } };
    assert_true(dig_bed_seed(&other, 3) != dig_bed_seed(&gravel, 3));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_point_has_a_first_bed_before_any_has_a_second),
        cmocka_unit_test(what_the_table_holds_is_not_dug_again),
        cmocka_unit_test(the_seed_is_the_documented_hash),
    };
    return cmocka_run_group_tests_name("queue", tests, scratch_setup, scratch_teardown);
}

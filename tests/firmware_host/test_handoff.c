// Tests for firmware_host/threads/handoff.c. The threaded ones are what ThreadSanitizer is run on.

#include "firmware_host/threads/handoff.h"

#include "tests/testlib.h"

#include <pthread.h>
#include <sched.h>
#include <stdlib.h>

// Large enough to be torn if two threads ever touched it at once.
struct record {
    uint64_t number;
    uint64_t copy[31];
};

static struct record record_of(const uint64_t number)
{
    struct record r = { .number = number };
    for (size_t i = 0; i < 31; i++) {
        r.copy[i] = number * 2654435761U + i;
    }
    return r;
}

static bool is_whole(const struct record *const r)
{
    const struct record whole = record_of(r->number);
    for (size_t i = 0; i < 31; i++) {
        if (r->copy[i] != whole.copy[i]) {
            return false;
        }
    }
    return true;
}

TEST(a_ring_gives_back_in_order_and_says_full_and_empty)
{
    int             memory[4];
    struct dig_ring ring;
    dig_ring_init(&ring, sizeof memory[0], 4, memory);
    int out = 42;
    assert_false(dig_ring_pop(&ring, &out));
    assert_int_equal(out, 42);
    for (int round = 0; round < 10; round++) {
        for (int i = 0; i < 4; i++) {
            assert_true(dig_ring_push(&ring, &i));
        }
        const int more = 9;
        assert_false(dig_ring_push(&ring, &more));
        for (int i = 0; i < 4; i++) {
            assert_true(dig_ring_pop(&ring, &out));
            assert_int_equal(out, i);
        }
        assert_false(dig_ring_pop(&ring, &out));
    }
}

TEST(a_ring_survives_its_counters_running_over)
{
    int             memory[4];
    struct dig_ring ring;
    dig_ring_init(&ring, sizeof memory[0], 4, memory);
    atomic_store(&ring.written, SIZE_MAX - 1);
    atomic_store(&ring.read, SIZE_MAX - 1);
    for (int i = 0; i < 4; i++) {
        assert_true(dig_ring_push(&ring, &i));
    }
    const int more = 9;
    assert_false(dig_ring_push(&ring, &more));
    for (int i = 0; i < 4; i++) {
        int out = -1;
        assert_true(dig_ring_pop(&ring, &out));
        assert_int_equal(out, i);
    }
}

TEST(a_slot_gives_the_latest_once)
{
    int               memory[3];
    struct dig_latest latest;
    dig_latest_init(&latest, sizeof memory[0], memory);
    int out = 42;
    assert_false(dig_latest_take(&latest, &out));
    assert_int_equal(out, 42);
    for (int i = 0; i < 7; i++) {
        dig_latest_put(&latest, &i);
    }
    assert_true(dig_latest_take(&latest, &out));
    assert_int_equal(out, 6);
    assert_false(dig_latest_take(&latest, &out));
    const int again = 7;
    dig_latest_put(&latest, &again);
    assert_true(dig_latest_take(&latest, &out));
    assert_int_equal(out, 7);
}

static uint64_t rounds(void)
{
    return test_is_quick() ? 50000 : 400000;
}

static void *push_all(void *const context)
{
    struct dig_ring *const ring = context;
    for (uint64_t i = 1; i <= rounds();) {
        const struct record r = record_of(i);
        if (dig_ring_push(ring, &r)) {
            i++;
        } else {
            (void)sched_yield();
        }
    }
    return NULL;
}

TEST(between_threads_a_ring_loses_repeats_and_tears_nothing)
{
    static struct record memory[8];
    struct dig_ring      ring;
    dig_ring_init(&ring, sizeof memory[0], 8, memory);
    pthread_t producer;
    assert_int_equal(pthread_create(&producer, NULL, push_all, &ring), 0);
    for (uint64_t expected = 1; expected <= rounds();) {
        struct record r;
        if (dig_ring_pop(&ring, &r)) {
            assert_true(r.number == expected && is_whole(&r));
            expected++;
        } else {
            (void)sched_yield();
        }
    }
    assert_int_equal(pthread_join(producer, NULL), 0);
}

static void *put_all(void *const context)
{
    struct dig_latest *const latest = context;
    for (uint64_t i = 1; i <= rounds(); i++) {
        const struct record r = record_of(i);
        dig_latest_put(latest, &r);
        if (i % 64 == 0) {
            (void)sched_yield();
        }
    }
    return NULL;
}

TEST(between_threads_a_slot_only_moves_on_and_tears_nothing)
{
    static struct record memory[3];
    struct dig_latest    latest;
    dig_latest_init(&latest, sizeof memory[0], memory);
    pthread_t producer;
    assert_int_equal(pthread_create(&producer, NULL, put_all, &latest), 0);
    for (uint64_t before = 0; before < rounds();) {
        struct record r;
        if (dig_latest_take(&latest, &r)) {
            assert_true(r.number > before && is_whole(&r));
            before = r.number;
        } else {
            (void)sched_yield();
        }
    }
    assert_int_equal(pthread_join(producer, NULL), 0);
}

TEST(what_is_looked_at_stays_until_the_next_look)
{
    int               memory[3];
    struct dig_latest latest;
    dig_latest_init(&latest, sizeof memory[0], memory);
    assert_null(dig_latest_look(&latest));
    for (int i = 1; i < 20; i += 3) {
        dig_latest_put(&latest, &i);
        const int *const seen = dig_latest_look(&latest);
        assert_non_null(seen);
        for (int newer = i + 1; newer < i + 3; newer++) {
            dig_latest_put(&latest, &newer);
            assert_int_equal(*seen, i);
        }
        const int *const next = dig_latest_look(&latest);
        assert_non_null(next);
        assert_int_equal(*next, i + 2);
        assert_null(dig_latest_look(&latest));
    }
}

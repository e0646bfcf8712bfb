// Tests for tools/digwatch/model.c

#include "tests/digwatch/said.h"

#include <limits.h>
#include <string.h>

static struct digwatch_model model;

static int fresh(void **state)
{
    (void)state;
    digwatch_model_init(&model);
    return 0;
}

TEST_WITH(a_prediction_is_read_where_the_bucket_is, fresh, NULL)
{
    digsight_estimate_t e = estimate_at(1000000000, 0.25, 3000.0);
    say_estimate(&model, &e);
    assert_true(isnan(model.estimate.predicted_Nm)); // nothing was predicted yet
    say_rising_prediction(&model);
    say_estimate(&model, &e);
    assert_close(model.estimate.predicted_Nm, 2500.0, 1e-9);
    assert_close(model.estimate.predicted_sigma_Nm, 1000.0, 1e-9);
    assert_close(model.estimate.sigma_Nm, 500.0, 1e-9); // noise 300 and tolerances 400

    char other[] = "simpleA";
    e.trajectory = other;
    say_estimate(&model, &e);
    assert_true(isnan(model.estimate.predicted_Nm));
    e = estimate_at(60000000001, 0.25, 3000.0); // it has expired
    say_estimate(&model, &e);
    assert_true(isnan(model.estimate.predicted_Nm));
    // It has not where HEALTH tells that the controller's clock is at 30 s: that of a recording
    // which is played fast runs ahead.
    const digsight_health_t before = health_at(30000000000, running_state);
    say_health(&model, &before);
    say_estimate(&model, &e);
    assert_close(model.estimate.predicted_Nm, 2500.0, 1e-9);
    const digsight_health_t behind = health_at(60000000001, running_state);
    say_health(&model, &behind);
    say_estimate(&model, &e);
    assert_true(isnan(model.estimate.predicted_Nm));
}

TEST_WITH(the_error_of_a_dig_is_relative_and_stands_until_the_next, fresh, NULL)
{
    say_rising_prediction(&model);
    // Measured 3000 and 6000 where 2500 and 5000 are predicted: sqrt((500^2 + 1000^2) / (3000^2 +
    // 6000^2)).
    digsight_estimate_t e = estimate_at(1000000000, 0.25, 3000.0);
    say_estimate(&model, &e);
    e = estimate_at(1010000000, 0.5, 6000.0);
    say_estimate(&model, &e);
    assert_close(digwatch_error(&model.now), 1.0 / 6.0, 1e-9);
    assert_true(isnan(digwatch_error(&model.before)));
    e       = estimate_at(1020000000, 0.75, 0.0);
    e.phase = 3;
    say_estimate(&model, &e);
    assert_close(digwatch_error(&model.before), 1.0 / 6.0, 1e-9);
    assert_true(isnan(digwatch_error(&model.now)));
}

TEST_WITH(the_moment_scrolls_in_slots_of_an_eighth_of_a_second, fresh, NULL)
{
    for (int i = 0; i < 4; i++) { // at 0, 50, 100, 150 ms: three in the first slot, one in the next
        const digsight_estimate_t e = estimate_at(INT64_C(50000000) * i, 0.0, 100.0 * i);
        say_estimate(&model, &e);
    }
    assert_close(digwatch_model_slot(&model, 0).measured_Nm, 300.0, 1e-9);
    assert_close(digwatch_model_slot(&model, 1).measured_Nm, 100.0, 1e-9);
    assert_true(isnan(digwatch_model_slot(&model, 2).measured_Nm));
    // Half a second of nothing.
    const digsight_estimate_t later = estimate_at(650000000, 0.0, 7.0);
    say_estimate(&model, &later);
    assert_close(digwatch_model_slot(&model, 0).measured_Nm, 7.0, 1e-9);
    assert_true(isnan(digwatch_model_slot(&model, 1).measured_Nm));
    assert_close(digwatch_model_slot(&model, 4).measured_Nm, 300.0, 1e-9);
    // A clock that jumps clears it, however far and whichever way.
    static const int64_t jumps[] = { INT64_C(1) << 62, 5, INT64_C(1) << 40 };
    for (size_t i = 0; i < 3; i++) {
        const digsight_estimate_t e = estimate_at(jumps[i], 0.0, 1.0);
        say_estimate(&model, &e);
        assert_close(digwatch_model_slot(&model, 0).measured_Nm, 1.0, 1e-9);
        assert_true(isnan(digwatch_model_slot(&model, 1).measured_Nm));
    }
    assert_true(isnan(digwatch_model_slot(&model, DIGWATCH_SLOTS).measured_Nm));
}

TEST_WITH(a_slot_that_never_ends_counts_no_further_than_it_can, fresh, NULL)
{
    digsight_estimate_t e = estimate_at(1000000000, 0.25, 100.0);
    say_estimate(&model, &e);
    model.slot_rows = INT_MAX - 1; // 100 of them a millisecond, for six hours
    e.moment_Nm     = 300.0;
    for (int i = 0; i < 3; i++) {
        say_estimate(&model, &e);
    }
    assert_int_equal(model.slot_rows, INT_MAX);
    assert_close(digwatch_model_slot(&model, 0).measured_Nm, 100.0, 1e-3);
}

TEST_WITH(a_counter_has_grown_only_since_we_listen, fresh, NULL)
{
    digsight_health_t h = health_at(1000000000, running_state);
    h.timeouts          = 40;
    say_health(&model, &h);
    size_t timeouts = 0;
    while (strcmp(dig_health_counter_text(timeouts)->name, "timeouts") != 0) {
        timeouts++;
    }
    assert_int_equal(model.health.count[timeouts], 40);
    assert_int_equal(model.health.grew_ns[timeouts], 0);
    h.time_ns  = 2000000000;
    h.timeouts = 41;
    say_health(&model, &h);
    assert_int_equal(model.health.grew_ns[timeouts], 2000000000);
    // A daemon that was started anew counts from zero.
    h.time_ns  = 3000000000;
    h.timeouts = 0;
    say_health(&model, &h);
    assert_int_equal(model.health.grew_ns[timeouts], 2000000000);
}

TEST_WITH(what_is_no_message_is_counted_and_changes_nothing, fresh, NULL)
{
    const uint8_t     rubbish[64] = { 1, 2, 3 };
    const char *const ours[]      = { "DIGSIGHT_ESTIMATE", "DIGSIGHT_MATCH", "DIGSIGHT_PREDICTION",
                                      "DIGSIGHT_HEALTH" };
    for (size_t i = 0; i < 4; i++) {
        for (size_t size = 0; size <= sizeof rubbish; size++) {
            const struct dig_lcm_event event = { .channel = ours[i],
                                                 .size    = size,
                                                 .data    = rubbish };
            digwatch_model_take(&model, &event);
        }
    }
    assert_int_equal(model.misread, 4 * 65);
    assert_false(model.any_estimate || model.match.known || model.prediction.valid ||
                 model.any_health);
}

// Its own lengths are not believed: one byte too many or too few, or any byte of it another.
TEST_WITH(a_message_that_is_damaged_is_counted_or_taken_and_no_more, fresh, NULL)
{
    const digsight_health_t h    = health_at(1000000000, running_state);
    const size_t            size = (size_t)digsight_health_t_encoded_size(&h);
    for (size_t length = 0; length <= size + 1; length++) {
        uint8_t *const bytes = calloc(size + 1, 1);
        assert_int_equal(digsight_health_t_encode(bytes, 0, (int)size, &h), size);
        uint8_t *const exact = malloc(length == 0 ? 1 : length);
        memcpy(exact, bytes, length);
        const struct dig_lcm_event event = { .channel = "DIGSIGHT_HEALTH",
                                             .size    = length,
                                             .data    = exact };
        digwatch_model_take(&model, &event);
        assert_int_equal(model.messages, length >= size ? 1 : 0);
        free(exact);
        free(bytes);
    }
    assert_int_equal(model.misread, size + 1);
    for (size_t i = 0; i < size; i++) {
        uint8_t *const bytes = malloc(size);
        assert_int_equal(digsight_health_t_encode(bytes, 0, (int)size, &h), size);
        bytes[i] ^= 0xff;
        const struct dig_lcm_event event = { .channel = "DIGSIGHT_HEALTH",
                                             .size    = size,
                                             .data    = bytes };
        digwatch_model_take(&model, &event);
        free(bytes);
    }
    assert_int_equal(model.messages + model.misread, 1 + size + 1 + size);
}

TEST_WITH(numbers_that_are_none_and_names_that_are_none_are_not_taken, fresh, NULL)
{
    digsight_estimate_t e      = estimate_at(1000, (double)NAN, (double)INFINITY);
    char                name[] = "\033[2Jactual";
    e.trajectory               = name;
    say_estimate(&model, &e);
    assert_false(model.estimate.moment_valid);
    assert_true(isnan(model.estimate.progress));
    assert_string_equal(model.estimate.trajectory, "");
    static const int64_t absurd[] = { -1, INT64_MIN, INT64_MAX };
    for (size_t i = 0; i < 3; i++) {
        e = estimate_at(absurd[i], 0.5, 1.0);
        say_estimate(&model, &e);
        assert_int_equal(model.estimate.time_ns, 1000);
    }

    digsight_match_t m = match_of((double)NAN);
    say_match(&model, &m);
    assert_false(model.match.known);
    char command[] = "\033]0;owned\007dig";
    m              = match_of(0.46);
    m.wanted       = command;
    say_match(&model, &m);
    assert_string_equal(model.match.wanted, "?]0;owned?dig");

    double                moment[DIG_PREDICTED_POINTS];
    double                sigma[DIG_PREDICTED_POINTS];
    digsight_prediction_t p = blank_prediction(actual, 0.0, 0.0, 0.0, moment, sigma);
    for (p.points = 0; p.points < DIG_PREDICTED_POINTS; p.points++) {
        say_prediction(&model, &p);
    }
    moment[63] = 1e12; // N·m
    say_prediction(&model, &p);
    moment[63]      = 0.0;
    p.from_progress = 1.0;
    say_prediction(&model, &p);
    assert_false(model.prediction.valid);
    p.from_progress = 0.5;
    say_prediction(&model, &p);
    assert_true(model.prediction.valid);
}

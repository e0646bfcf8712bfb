// Tests for closed_loop/machine_digs/machine_dig.c: where in a recording its dig is.

#include "closed_loop/machine_digs/machine_dig.h"

#include "tests/closed_loop/machine_campaign.h"

// Part of a recording, from a share of its dig (before it: from its beginning) to another (beyond
// it: to its end).
static struct dig_machine_recording part_of(const int kind, const double from, const double to)
{
    const struct fault           none  = { .dry_N = 0.0 };
    struct dig_machine_recording r     = record(kind, 0, &none, 1);
    struct dig_error             error = { "" };
    struct dig_machine_dig       dig;
    assert_ok(dig_machine_dig_make(&machine, set, &r, kind == 0 ? MADE_SIMPLE_A : MADE_ACTUAL, &dig,
                                   &error),
              error);
    const double dug   = (double)(dig.end - dig.contact);
    const size_t first = from < 0.0 ? 0 : dig.contact + (size_t)(from * dug);
    const size_t end   = to > 1.0 ? r.rows : dig.contact + (size_t)(to * dug);
    r.rows             = end - first;
    memmove(r.row, r.row + first, r.rows * sizeof *r.row);
    dig_machine_dig_finish(&dig);
    return r;
}

// The status of laying it along its trajectory; measured on success.
static enum dig_status lay(const int kind, const double from, const double to,
                           struct dig_measured *const measured, struct dig_error *const error)
{
    struct dig_machine_recording r    = part_of(kind, from, to);
    struct dig_machine_side     *side = NULL;
    *measured = (struct dig_measured){ .trajectory = kind == 0 ? MADE_SIMPLE_A : MADE_ACTUAL };
    const enum dig_status status =
        dig_machine_side_create(&machine, set, 1, &r, measured, &side, error);
    dig_machine_side_destroy(side);
    dig_machine_recording_finish(&r);
    return status;
}

TEST(a_recording_that_ends_or_begins_in_its_dig_tells_what_it_has)
{
    struct dig_measured *const whole = calloc(2, sizeof *whole);
    struct dig_measured *const part  = &whole[1];
    struct dig_error           error = { "" };
    for (int kind = 0; kind < KINDS; kind++) {
        assert_ok(lay(kind, -1.0, 2.0, whole, &error), error);
        for (int which = 0; which < 2; which++) {
            assert_ok(lay(kind, which == 0 ? -1.0 : 0.05, which == 0 ? 0.85 : 2.0, part, &error),
                      error);
            print_message("from %.3f to %.3f, pace %.3f\n", part->first, part->last, part->pace);
            assert_close(part->pace, whole->pace, 0.03);
            assert_true(which == 0 ? part->last > 0.7 && part->last < 0.95 && part->first < 0.02
                                   : part->last > 0.95 && part->first < 0.15);
            for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
                double off    = 0.0;
                double square = 0.0;
                for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
                    const double at = (double)k / (DIG_CURVE_POINTS - 1);
                    if (at > part->first + 0.02 && at < part->last - 0.02) {
                        off += pow(part->value[c][k] - whole->value[c][k], 2.0);
                        square += pow(whole->value[c][k], 2.0);
                    }
                }
                print_message("   %zu off by %.4f\n", c, sqrt(off / square));
                assert_true(sqrt(off / square) < 0.05);
            }
        }
    }
    free(whole);
}

TEST(a_recording_that_lacks_too_much_of_its_dig_is_refused_as_that)
{
    struct dig_measured *const m     = calloc(1, sizeof *m);
    struct dig_error           error = { "" };
    assert_int_equal(lay(1, -1.0, 0.5, m, &error), DIG_ENOMATCH);
    assert_contains(error.text, "it ends");
    assert_contains(error.text, "along actual, expected at least 70 %");
    assert_int_equal(lay(1, 0.25, 2.0, m, &error), DIG_ENOMATCH);
    assert_contains(error.text, "it begins");
    assert_contains(error.text, "along actual, expected at most 10 %");
    free(m);
}

TEST(a_recording_without_its_dig_is_refused_by_name)
{
    const struct fault           none  = { .dry_N = 0.0 };
    struct dig_machine_recording r     = record(0, 0, &none, 1);
    struct dig_measured *const   m     = calloc(1, sizeof *m);
    struct dig_machine_side     *side  = NULL;
    struct dig_error             error = { "" };
    (void)snprintf(m->name, sizeof m->name, "north.csv");
    m->trajectory = MADE_ACTUAL; // it is simpleA
    assert_int_equal(dig_machine_side_create(&machine, set, 1, &r, m, &side, &error), DIG_ENOMATCH);
    assert_contains(error.text, "north.csv");
    assert_contains(error.text, "actual");
    assert_null(side);
    r.rows = 30;
    assert_int_equal(dig_machine_side_create(&machine, set, 1, &r, m, &side, &error), DIG_EINVAL);
    dig_machine_recording_finish(&r);
    free(m);
}

// Where the dig is, its pace and its curves are those of fine angles.
TEST(steps_and_noise_of_the_angles_move_no_dig)
{
    static const double rough_deg[][2] = {
        { 0.0, 0.2 }, { 0.0, 0.35 }, { 0.0, 0.5 }, { 0.15, 0.0 }, { 0.15, 0.5 }
    };
    static const struct fault  none   = { .dry_N = 0.0 };
    struct dig_measured *const fine   = calloc(2, sizeof *fine);
    struct dig_measured *const coarse = &fine[1];
    for (int kind = 0; kind < KINDS; kind++) {
        const int t = kind == 0 ? MADE_SIMPLE_A : MADE_ACTUAL;
        for (size_t k = 0; k <= sizeof rough_deg / sizeof rough_deg[0]; k++) {
            const struct dig_machine as_filed = machine;
            if (k > 0) {
                machine.angle_sigma_rad = rough_deg[k - 1][0] * DIG_RAD_PER_DEG;
                machine.angle_step_rad  = rough_deg[k - 1][1] * DIG_RAD_PER_DEG;
            }
            struct dig_machine_recording r     = record(kind, 0, &none, 40 + k);
            struct dig_machine_side     *side  = NULL;
            struct dig_error             error = { "" };
            struct dig_measured *const   m     = k == 0 ? fine : coarse;
            m->trajectory                      = t;
            assert_ok(dig_machine_side_create(&machine, set, 1, &r, m, &side, &error), error);
            print_message("%.3f to %.3f, pace %.3f\n", m->first, m->last, m->pace);
            assert_close(m->pace, fine->pace, 0.03 * fine->pace);
            double off = 0.0, square = 0.0;
            for (size_t i = 5; i + 5 < DIG_CURVE_POINTS; i++) {
                off += pow(m->value[DIG_CHANNEL_MY_Nm][i] - fine->value[DIG_CHANNEL_MY_Nm][i], 2.0);
                square += pow(fine->value[DIG_CHANNEL_MY_Nm][i], 2.0);
            }
            print_message("   moment off by %.4f\n", sqrt(off / square));
            assert_true(sqrt(off / square) < 0.05);
            dig_machine_side_destroy(side);
            dig_machine_recording_finish(&r);
            machine = as_filed;
        }
    }
    free(fine);
}

TEST(a_pitched_machine_digs_level_ground_as_a_level_one_does)
{
    static const struct fault  none        = { .dry_N = 0.0 };
    static const double        pitch_deg[] = { 0.0, 3.0, -3.0 };
    struct dig_measured *const level       = calloc(2, sizeof *level);
    for (int kind = 0; kind < KINDS; kind++) {
        for (size_t k = 0; k < 3; k++) {
            struct dig_machine_recording r     = record(kind, 0, &none, 1);
            struct dig_measured *const   m     = k == 0 ? level : &level[1];
            struct dig_machine_side     *side  = NULL;
            struct dig_error             error = { "" };
            m->trajectory                      = kind == 0 ? MADE_SIMPLE_A : MADE_ACTUAL;
            stand_pitched(&machine, pitch_deg[k] * DIG_RAD_PER_DEG, &r);
            assert_ok(dig_machine_side_create(&machine, set, 1, &r, m, &side, &error), error);
            for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
                double off = 0.0, square = 0.0;
                for (size_t i = 0; i < DIG_CURVE_POINTS; i++) {
                    off += pow(m->value[c][i] - level->value[c][i], 2.0);
                    square += pow(level->value[c][i], 2.0);
                }
                print_message("%g deg: %zu off by %.4f\n", pitch_deg[k], c, sqrt(off / square));
                assert_true(sqrt(off / square) < 0.02);
            }
            dig_machine_side_destroy(side);
            dig_machine_recording_finish(&r);
        }
    }
    free(level);
}

// Then the path lies along its trajectory in the machine's frame.
TEST(a_machine_pitched_as_its_ground_digs_along_its_own_frame)
{
    static const struct fault    none  = { .dry_N = 0.0 };
    struct dig_machine_recording r     = record(1, 0, &none, 1);
    struct dig_error             error = { "" };
    for (int way = -1; way <= 1; way += 2) {
        struct dig_machine_dig dig;
        for (size_t i = 0; i < r.rows; i++) {
            r.row[i].value[DIG_SIGNAL_PITCH_rad] = 3.0 * DIG_RAD_PER_DEG * way;
            r.row[i].valid[DIG_SIGNAL_PITCH_rad] = true;
        }
        assert_ok(dig_machine_dig_make(&machine, set, &r, MADE_ACTUAL, &dig, &error), error);
        assert_close(dig.frame_rad, 0.0, 0.0);
        dig_machine_dig_finish(&dig);
    }
    dig_machine_recording_finish(&r);
}

TESTS_WITH(build, tear_down)

// Tests for closed_loop/check/machine_check.c, machine_check_recording.c, machine_reading.c and
// machine_causes.c: the rig's machines by virtual work, broken in one way at a time.
// DIG_TEST_ALL=1: every break of every machine. DIG_TEST_QUICK=1: two.

#include "tests/broken_air.h"
#include "tests/read.h"

static struct machine {
    struct dig_machine   machine;
    struct dig_rig_track track;
} machines[AIR_MACHINES];

static int build(void **state)
{
    (void)state;
    for (size_t m = 0; m < AIR_MACHINES; m++) {
        struct dig_error error = { "" };
        if (!air_move(air_machines[m], &machines[m].machine, &machines[m].track, &error)) {
            print_error("%s\n", error.text);
            return -1;
        }
    }
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    for (size_t m = 0; m < AIR_MACHINES; m++) {
        dig_rig_track_finish(&machines[m].track);
    }
    return 0;
}

static struct dig_machine_air_check run(const struct dig_machine *const           file,
                                        const struct dig_machine_recording *const recording)
{
    struct dig_machine_air_check check;
    struct dig_error             error = { "" };
    assert_ok(dig_machine_air_check_run(file, recording, &check, &error), error);
    return check;
}

static struct dig_machine_air_check check_of(const size_t m, const struct air_break *const broken,
                                             const uint64_t seed)
{
    struct dig_machine_recording recording =
        air_record(&machines[m].machine, &machines[m].track, broken, seed);
    const struct dig_machine           file  = air_file(&machines[m].machine, broken);
    const struct dig_machine_air_check check = run(&file, &recording);
    dig_machine_recording_finish(&recording);
    return check;
}

static const struct dig_check_item *line(const struct dig_machine_air_check *const check,
                                         const enum dig_check_question question, const int of)
{
    for (size_t i = 0; i < check->items; i++) {
        if (check->item[i].question == question && check->item[i].of == of) {
            return &check->item[i];
        }
    }
    fail_msg("no line of question %d, %d", (int)question, of);
    return NULL;
}

static bool tests_all(void)
{
    return getenv("DIG_TEST_ALL") != NULL;
}

TEST(the_file_that_is_right_is_called_right_in_every_line)
{
    for (size_t m = 0; m < AIR_MACHINES; m += test_is_quick() ? AIR_MACHINES : 1) {
        for (uint64_t seed = 1; seed <= (tests_all() ? 5U : 1U); seed++) {
            struct dig_machine_air_check check = check_of(m, NULL, seed);
            for (size_t i = 0; i < check.items; i++) {
                if (check.item[i].verdict != DIG_CHECK_OK) {
                    fail_msg("%s: question %d of %d: %.4g +-%.3g", air_machines[m],
                             (int)check.item[i].question, check.item[i].of, check.item[i].value,
                             check.item[i].sigma);
                }
            }
            assert_int_equal(check.verdict, DIG_CHECK_OK);
            dig_machine_air_check_finish(&check);
        }
    }
}

// A break of all three joints is tried on one of them, another in every run of three.
static bool is_tried(const size_t b, const size_t m)
{
    if (tests_all()) {
        return true;
    }
    if (test_is_quick() && b % 24 != 0) {
        return false;
    }
    const struct air_break *const broken = &air_breaks[b];
    const bool                    first  = b == 0 || air_breaks[b - 1].kind != broken->kind ||
                       fabs(air_breaks[b - 1].amount - broken->amount) > 0.0;
    size_t begin = b;
    while (begin > 0 && !first && air_breaks[begin - 1].kind == broken->kind &&
           !(fabs(air_breaks[begin - 1].amount - broken->amount) > 0.0)) {
        begin--;
    }
    const bool one = begin + 1 < AIR_BREAKS && air_breaks[begin + 1].kind == broken->kind &&
                     !(fabs(air_breaks[begin + 1].amount - broken->amount) > 0.0);
    return m == b % AIR_MACHINES && (!one || (b - begin) == begin % 3);
}

TEST(what_is_broken_is_named_and_nothing_is_named_beside_it)
{
    for (size_t b = 0; b < AIR_BREAKS; b++) {
        for (size_t m = 0; m < AIR_MACHINES; m++) {
            if (!is_tried(b, m)) {
                continue;
            }
            struct dig_machine_air_check check = check_of(m, &air_breaks[b], 1);
            if (!air_is_named(&check, &air_breaks[b])) {
                fail_msg("%s, %s: not named", air_machines[m], air_breaks[b].name);
            }
            if (air_says_more(&check, &air_breaks[b])) {
                fail_msg("%s, %s: more is named", air_machines[m], air_breaks[b].name);
            }
            dig_machine_air_check_finish(&check);
        }
    }
}

TEST(two_breaks_at_once_are_both_named_with_their_values)
{
    static const struct air_break turned = { .kind = AIR_TURNED, .of = DIG_JOINT_BOOM };
    const struct machine *const   m      = &machines[2];
    struct dig_machine_recording  r      = air_record(&m->machine, &m->track, &turned, 1);
    for (size_t i = 0; i < r.rows; i++) {
        r.row[i].value[DIG_SIGNAL_ARM_HEAD_Pa] += 2e6;
        r.row[i].value[DIG_SIGNAL_BUCKET_rad] += 0.1;
    }
    struct dig_machine_air_check check = run(&m->machine, &r);
    assert_int_equal(line(&check, DIG_CHECK_DIRECTION, DIG_JOINT_BOOM)->verdict, DIG_CHECK_WRONG);
    const struct dig_check_item *const offset = line(&check, DIG_CHECK_OFFSET, DIG_JOINT_ARM);
    assert_int_equal(offset->verdict, DIG_CHECK_WRONG);
    assert_true(offset->sigma < 1e5);
    assert_close(offset->value, 2e6, 4.0 * offset->sigma);
    const struct dig_check_item *const zero = line(&check, DIG_CHECK_ZERO, DIG_JOINT_BUCKET);
    assert_int_equal(zero->verdict, DIG_CHECK_WRONG);
    assert_true(zero->sigma < 0.02);
    assert_close(zero->value, 0.1, 4.0 * zero->sigma);
    assert_int_equal(check.verdict, DIG_CHECK_WRONG);
    dig_machine_air_check_finish(&check);
    dig_machine_recording_finish(&r);
}

TEST(a_joint_that_does_not_move_is_not_judged)
{
    static const struct air_break still = { .kind = AIR_STILL, .of = DIG_JOINT_ARM };
    struct dig_machine_air_check  check = check_of(4, &still, 1);
    assert_int_equal(line(&check, DIG_CHECK_MOVES, DIG_JOINT_ARM)->verdict, DIG_CHECK_UNTOLD);
    static const enum dig_check_question open[] = { DIG_CHECK_DIRECTION, DIG_CHECK_CYLINDER,
                                                    DIG_CHECK_SIDES,     DIG_CHECK_UNIT,
                                                    DIG_CHECK_ZERO,      DIG_CHECK_FACTOR,
                                                    DIG_CHECK_OFFSET,    DIG_CHECK_WEIGHT };
    for (size_t q = 0; q < sizeof open / sizeof open[0]; q++) {
        assert_int_equal(line(&check, open[q], DIG_JOINT_ARM)->verdict, DIG_CHECK_UNTOLD);
    }
    assert_int_equal(line(&check, DIG_CHECK_DIRECTION, DIG_JOINT_BUCKET)->verdict, DIG_CHECK_OK);
    assert_int_equal(check.verdict, DIG_CHECK_OK);
    dig_machine_air_check_finish(&check);
}

TEST(of_a_machine_with_the_bucket_s_pressures_alone_the_bucket_is_judged)
{
    const struct machine *const  m = &machines[4];
    struct dig_machine_recording r = air_record(&m->machine, &m->track, NULL, 1);
    for (size_t i = 0; i < r.rows; i++) {
        for (int s = DIG_SIGNAL_BOOM_HEAD_Pa; s <= DIG_SIGNAL_ARM_ROD_Pa; s++) {
            r.row[i].valid[s] = false;
            r.row[i].value[s] = 0.0;
        }
    }
    struct dig_machine_air_check check = run(&m->machine, &r);
    assert_int_equal(line(&check, DIG_CHECK_REST, DIG_JOINT_BUCKET)->verdict, DIG_CHECK_OK);
    assert_int_equal(line(&check, DIG_CHECK_OFFSET, DIG_JOINT_BUCKET)->verdict, DIG_CHECK_OK);
    assert_int_equal(line(&check, DIG_CHECK_REST, DIG_JOINT_BOOM)->verdict, DIG_CHECK_UNTOLD);
    assert_int_equal(line(&check, DIG_CHECK_WEIGHT, DIG_JOINT_ARM)->verdict, DIG_CHECK_UNTOLD);
    assert_int_equal(check.verdict, DIG_CHECK_OK);
    dig_machine_air_check_finish(&check);
    dig_machine_recording_finish(&r);
}

// What no line asks for: the ground, which the bucket leans on for five seconds.
TEST(what_no_cause_explains_is_left_over)
{
    const struct machine *const  m = &machines[4];
    struct dig_machine_recording r = air_record(&m->machine, &m->track, NULL, 1);
    for (size_t i = 0; i < r.rows; i++) {
        const double t_s = m->track.step_s * (double)i;
        r.row[i].value[DIG_SIGNAL_BOOM_HEAD_Pa] -=
            t_s > 20.0 && t_s < 25.0 ? 4e6 * sin(3.14159265 * (t_s - 20.0) / 5.0) : 0.0;
    }
    struct dig_machine_air_check check = run(&m->machine, &r);
    assert_int_equal(line(&check, DIG_CHECK_REST, DIG_JOINT_BOOM)->verdict, DIG_CHECK_WRONG);
    assert_true(check.unexplained);
    assert_int_equal(check.verdict, DIG_CHECK_WRONG);
    for (size_t i = 0; i < check.items; i++) {
        assert_true(check.item[i].question == DIG_CHECK_REST ||
                    check.item[i].verdict != DIG_CHECK_WRONG);
    }
    dig_machine_air_check_finish(&check);
    dig_machine_recording_finish(&r);
}

// A working dig, for which a person may take the wrong file.
TEST(a_recording_with_a_dig_in_it_is_explained_by_nothing)
{
    const struct machine *const  m   = &machines[5];
    struct dig_rig_track_options how = dig_rig_track_options_default();
    struct dig_recording         dug =
        read_recording("tests/data/reference/mu0.5_mur0.5_rho2500__actual.csv");
    struct machine   digs  = { .machine = m->machine };
    struct dig_error error = { "" };
    how.placed             = true;
    how.pin_X_m            = 7.43;
    how.pin_Z_m            = -0.62;
    assert_ok(dig_rig_track_build(&m->machine, &how, 1, &dug, &digs.track, &error), error);
    struct dig_machine_recording r     = air_record(&m->machine, &digs.track, NULL, 1);
    struct dig_machine_air_check check = run(&m->machine, &r);
    assert_true(check.unexplained);
    assert_int_equal(check.verdict, DIG_CHECK_WRONG);
    dig_machine_air_check_finish(&check);
    dig_machine_recording_finish(&r);
    dig_rig_track_finish(&digs.track);
    dig_recording_finish(&dug);
}

static void assert_right_where_seals_rub(const size_t m, const double share, const bool stand)
{
    struct machine   rubs  = { .machine = machines[m].machine };
    struct dig_error error = { "" };
    assert_true(air_move(air_machines[m], &rubs.machine, &rubs.track, &error));
    air_rub(&rubs.machine, &rubs.track, share, stand);
    struct dig_machine_recording r     = air_record(&rubs.machine, &rubs.track, NULL, 1);
    struct dig_machine_air_check check = run(&rubs.machine, &r);
    if (check.verdict != DIG_CHECK_OK) {
        fail_msg("%s: does not fit", air_machines[m]);
    }
    dig_machine_air_check_finish(&check);
    dig_machine_recording_finish(&r);
    dig_rig_track_finish(&rubs.track);
}

// A hundredth of what its cylinder can push is 1 sigma of a seal's friction: in a bucket's cylinder
// as much as the load.
TEST(a_right_file_is_called_right_where_every_seal_rubs)
{
    for (size_t m = 0; m < AIR_MACHINES; m += test_is_quick() ? AIR_MACHINES : 1) {
        assert_right_where_seals_rub(m, 0.01, false);
    }
}

TEST(a_right_file_is_called_right_where_every_seal_holds_a_rod_that_stands)
{
    for (size_t m = 0; m < AIR_MACHINES; m += test_is_quick() ? AIR_MACHINES : 1) {
        assert_right_where_seals_rub(m, 0.01, true);
    }
}

// Of such seals the coarse reading takes ten degrees off three angles.
TEST(a_zero_that_the_fit_gives_back_is_not_wrong)
{
    assert_right_where_seals_rub(5, 0.02, true);
}

// Allowances are 1 sigma of what may be off: half of each is no fault.
TEST(what_is_within_its_tolerance_is_no_fault)
{
    const struct machine *const  m    = &machines[5];
    struct dig_machine_recording r    = air_record(&m->machine, &m->track, NULL, 1);
    struct dig_machine           file = m->machine;
    file.link[DIG_JOINT_BUCKET].mass_kg *= 1.03;
    file.cylinder[DIG_JOINT_BUCKET].base_m.x += 0.001;
    for (size_t i = 0; i < r.rows; i++) {
        r.row[i].value[DIG_SIGNAL_ARM_rad] += 0.004;
        r.row[i].value[DIG_SIGNAL_BOOM_HEAD_Pa] += 8e4;
    }
    struct dig_machine_air_check check = run(&file, &r);
    assert_int_equal(check.verdict, DIG_CHECK_OK);
    dig_machine_air_check_finish(&check);
    dig_machine_recording_finish(&r);
}

TEST(the_pushes_that_are_drawn_are_those_of_the_machine)
{
    static const struct air_break swapped = { .kind = AIR_SIDES, .of = DIG_JOINT_ARM };
    struct dig_machine_air_check  check   = check_of(4, &swapped, 1);
    double                        before = 0.0, after = 0.0, whole = 0.0;
    assert_true(check.curves.points > 1000);
    for (size_t p = 0; p < check.curves.points; p++) {
        const size_t i = DIG_JOINTS * p + DIG_JOINT_ARM;
        before += pow(check.curves.drive_N[i] - check.curves.load_N[i], 2.0);
        after += pow(check.curves.mended_drive_N[i] - check.curves.mended_load_N[i], 2.0);
        whole += pow(check.curves.mended_load_N[i], 2.0);
    }
    assert_true(before > 0.5 * whole);
    assert_true(after < 1e-3 * whole);
    dig_machine_air_check_finish(&check);
}

TEST(what_cannot_be_checked_is_refused_and_writes_nothing)
{
    const struct machine *const  m     = &machines[4];
    struct dig_machine_recording r     = air_record(&m->machine, &m->track, NULL, 1);
    struct dig_machine           file  = m->machine;
    struct dig_machine_air_check check = { .items = 42 };
    struct dig_error             error = { "" };
    file.sensor.fitted                 = true;
    assert_int_equal(dig_machine_air_check_run(&file, &r, &check, &error), DIG_EINVAL);
    assert_contains(error.text, "force sensor");
    const size_t rows = r.rows;
    for (size_t few = 0; few < 50; few += 7) {
        r.rows = few;
        assert_int_equal(dig_machine_air_check_run(&m->machine, &r, &check, &error), DIG_EINVAL);
    }
    r.rows = rows;
    for (size_t i = 0; i < r.rows; i++) {
        r.row[i].valid[DIG_SIGNAL_BUCKET_ROD_Pa] = false;
    }
    assert_int_equal(dig_machine_air_check_run(&m->machine, &r, &check, &error), DIG_EINVAL);
    assert_int_equal(check.items, 42);
    dig_machine_recording_finish(&r);
    dig_machine_air_check_finish(NULL);
}

TESTS_WITH(build, tear_down)

// Tests for closed_loop/machine/machine_side.c and its parts.

#include "closed_loop/machine/machine_fit.h"
#include "tests/closed_loop/machine_campaign.h"

TEST(a_machine_as_its_file_says_raises_no_alarm)
{
    for (uint64_t seed = 1; seed <= most(1, 3); seed++) {
        const struct fault     none = { .dry_N = 0.0 };
        struct campaign *const c    = trace(&none, seed);
        assert_false(c->finding.significant);
        assert_false(c->finding.unexplained);
        assert_int_equal(c->finding.effects, 0);
        assert_close(c->finding.residual_air, 0.9, 0.15);
        double squares = 0.0;
        double digs    = 0.0;
        for (int d = 0; d < DIGS; d++) {
            const bool traced = c->measured[d].use != DIG_USE_HOLDOUT;
            assert_true(isnan(c->finding.residual_air_of[d]) == !traced);
            squares += traced ? pow(c->finding.residual_air_of[d], 2.0) : 0.0;
            digs += traced ? 1.0 : 0.0;
        }
        // Digs have nearly as much air each.
        assert_close(sqrt(squares / digs) / c->finding.residual_air, 1.0, 0.02);
        assert_true(isnan(c->finding.residual_air_of[DIGS]));
        for (int d = 0; d < DIGS; d++) {
            assert_close(c->measured[d].pace, 1.0, 0.01);
            assert_true(c->measured[d].measured[DIG_CHANNEL_FX_N]);
            assert_true(c->measured[d].first < 0.05 && c->measured[d].last > 0.99);
        }
        end(c);
    }
}

// Leaves in the digs what was found, and what the file has wrong (NULL: nothing).
static void take_off_with(struct campaign *const c, const double file[DIG_FILE_ERRORS])
{
    double added[DIGS][DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
    assert_int_equal(dig_machine_side_apply(c->side, c->finding.effects, c->finding.effect, file,
                                            DIG_APPLY_TO_ALL, c->measured, added),
                     DIG_OK);
    for (size_t d = 0; d < DIGS; d++) {
        memcpy(c->measured[d].machine, added[d], sizeof added[d]);
    }
}

static void take_off(struct campaign *const c)
{
    take_off_with(c, NULL);
}

// rms over digs of a channel by two tellings of it, rig scale.
static double apart_in(const enum dig_channel channel, const struct campaign *const a,
                       const struct campaign *const b, const bool corrected)
{
    double sum = 0.0, whole = 0.0;
    for (int d = 0; d < DIGS; d++) {
        for (int k = 0; k < DIG_CURVE_POINTS; k++) {
            const double of = a->measured[d].value[channel][k] -
                              (corrected ? a->measured[d].machine[channel][k] : 0.0);
            sum += pow(of - b->measured[d].value[channel][k], 2.0);
            whole += pow(b->measured[d].value[channel][k], 2.0);
        }
    }
    return sqrt(sum / whole);
}

static double apart(const struct campaign *const a, const struct campaign *const b,
                    const bool corrected)
{
    return apart_in(DIG_CHANNEL_MY_Nm, a, b, corrected);
}

TEST(each_effect_is_named_and_taken_off_the_digs)
{
    const struct {
        struct fault       fault;
        enum dig_effect_id effect;
        const char        *parameter;
        double             value;
    } cases[] = {
        { { .dry_N = 4000.0 }, DIG_EFFECT_CYLINDER_FRICTION, "coulomb_N", 4000.0 },
        { { .held_N = 2000.0 }, DIG_EFFECT_CYLINDER_FRICTION, "coulomb_N", 2000.0 },
        { { .rod_Pa = 4e5 }, DIG_EFFECT_PRESSURE_OFFSET, NULL, 0.0 },
        { { .late_s = 0.2 }, DIG_EFFECT_SENSOR_DELAY, "delay_s", 0.2 },
        { { .payload_kg = 90.0 }, DIG_EFFECT_PAYLOAD, "payload_kg", 90.0 },
        { { .angle_rad = { 0.0, 0.08, 0.0 } }, DIG_EFFECT_ANGLE_OFFSET, "arm_rad", 0.08 },
    };
    const struct fault     none  = { .dry_N = 0.0 };
    struct campaign *const clean = measure(&none, 9);
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i += most(3, 1)) {
        struct campaign *const c = trace(&cases[i].fault, 20 + i);
        expect_found(c, cases[i].effect, cases[i].parameter, cases[i].value);
        const double before = apart(c, clean, false);
        take_off(c);
        const double after = apart(c, clean, true);
        print_message("%s: %.4f of the moment before, %.4f after\n",
                      dig_effect_name(cases[i].effect), before, after);
        assert_true(after < 0.5 * before + 0.004);
        end(c);
    }
    end(clean);
}

// Boom and arm as much heavier as their file allows: nothing to name, but the digs' forces are told
// with it.
TEST(a_machine_within_its_files_tolerance_is_no_effect)
{
    const struct fault none  = { .dry_N = 0.0 };
    const struct fault heavy = {
        .heavier_kg = { 1.5 * machine.tolerance.mass_share * machine.link[0].mass_kg,
                        machine.tolerance.mass_share * machine.link[1].mass_kg, 0.0 }
    };
    struct campaign *const clean = measure(&none, 9);
    struct campaign *const c     = trace(&heavy, 9);
    assert_false(c->finding.significant);
    assert_int_equal(c->finding.effects, 0);
    const double before = apart_in(DIG_CHANNEL_FZ_N, c, clean, false);
    take_off_with(c, c->finding.none.file);
    const double after = apart_in(DIG_CHANNEL_FZ_N, c, clean, true);
    print_message("Fz: %.4f off before, %.4f after\n", before, after);
    assert_true(before > 0.1 && after < 0.05 * before);
    end(c);
    end(clean);
}

// Half a degree is allowed for. A machine that leans farther is not the one of its file, and the
// digs are told with what it leans.
TEST(a_machine_that_leans_more_than_is_allowed_for_is_unlike_its_file)
{
    const struct fault     none    = { .dry_N = 0.0 };
    const struct fault     leans   = { .pitched_rad = 0.5 * DIG_RAD_PER_DEG };
    struct campaign *const clean   = measure(&none, 9);
    struct campaign *const allowed = trace(&leans, 9);
    assert_false(allowed->finding.significant || allowed->finding.unlike.is);
    end(allowed);
    for (int way = test_is_quick() ? 1 : -1; way <= 1; way += 2) {
        const double       rad = way * 4.0 * DIG_RAD_PER_DEG;
        const struct fault far = { .pitched_rad = rad };

        struct campaign *const                      c      = trace(&far, 9);
        const struct dig_machine_unlike_file *const unlike = &c->finding.unlike;
        assert_true(c->finding.significant && c->finding.unexplained);
        assert_int_equal(c->finding.effects, 0);
        assert_true(unlike->is && unlike->error == DIG_FILE_LEVEL_rad);
        assert_close(unlike->value, rad, 0.012);
        assert_close(unlike->value, c->finding.none.file[DIG_FILE_LEVEL_rad], 1e-12);
        assert_string_equal(c->finding.follows, "the machine's pitch");
        const double before = apart_in(DIG_CHANNEL_FZ_N, c, clean, false);
        take_off_with(c, c->finding.none.file);
        const double after = apart_in(DIG_CHANNEL_FZ_N, c, clean, true);
        print_message("pitched by %.4f rad, said %.4f; Fz: %.4f off before, %.4f after\n", rad,
                      unlike->value, before, after);
        assert_true(after < 0.2 * before);
        end(c);
    }
    end(clean);
}

static bool is_reported(const struct dig_machine_finding *const finding,
                        const enum dig_effect_id                effect)
{
    bool found = false;
    for (size_t e = 0; e < finding->effects; e++) {
        found = found || finding->effect[e].effect == effect;
    }
    for (size_t i = 0; i < finding->sets; i++) {
        for (size_t e = 0; e < finding->set[i].effects; e++) {
            found = found || finding->set[i].effect[e] == effect;
        }
    }
    return found;
}

// Friction takes an offset for its own where it is refined alone.
TEST(friction_and_a_strong_offset_are_both_named)
{
    const struct fault     none  = { .dry_N = 0.0 };
    const struct fault     both  = { .dry_N = 2000.0, .rod_Pa = 15e5 };
    struct campaign *const clean = measure(&none, 9);
    struct campaign *const c     = trace(&both, 31);
    assert_int_equal(c->finding.effects, 2);
    assert_true(is_reported(&c->finding, DIG_EFFECT_CYLINDER_FRICTION));
    assert_true(is_reported(&c->finding, DIG_EFFECT_PRESSURE_OFFSET));
    const double before = apart(c, clean, false);
    take_off(c);
    const double after = apart(c, clean, true);
    print_message("%.4f of the moment before, %.4f after\n", before, after);
    assert_true(after < 0.2 * before);
    end(c);
    end(clean);
}

// Begun with the friction alone, which explains most, the search stays with a friction that took
// the offset for its own, beside another bucket or nothing (machine_select.c).
TEST(a_strong_friction_does_not_keep_the_offset_beside_it)
{
    const struct fault both[] = { { .dry_N = 6000.0, .rod_Pa = 8e5 },
                                  { .dry_N = 6000.0, .rod_Pa = 12e5 } };
    for (size_t i = 0; i < most(1, 2); i++) {
        struct campaign *const c = trace(&both[i], 37 + i);
        assert_int_equal(c->finding.effects, 2);
        assert_true(is_reported(&c->finding, DIG_EFFECT_CYLINDER_FRICTION));
        assert_true(is_reported(&c->finding, DIG_EFFECT_PRESSURE_OFFSET));
        end(c);
    }
}

// A strong effect whose formula is right hides little beside it.
TEST(a_form_that_the_air_shows_to_be_right_is_trusted)
{
    const struct fault     seal = { .dry_N = 4000.0 };
    struct campaign *const c    = trace(&seal, 41);
    expect_found(c, DIG_EFFECT_CYLINDER_FRICTION, "coulomb_N", seal.dry_N);
    const struct dig_model_parameter *const dry = &c->finding.effect[0].parameter[0];
    print_message("%.0f N (%.0f to %.0f)\n", dry->value, dry->low, dry->high);
    assert_string_equal(dry->name, "coulomb_N");
    assert_true(dry->low < seal.dry_N && seal.dry_N < dry->high);
    assert_true(dry->high - dry->low < 0.1 * seal.dry_N);
    end(c);
}

// rms over one dig of what was taken off its moment less what is wrong with it, and of the latter.
static void taken_off(const struct campaign *const c, const struct campaign *const clean,
                      const size_t d, double *const left, double *const wrong)
{
    *left  = 0.0;
    *wrong = 0.0;
    for (int k = 0; k < DIG_CURVE_POINTS; k++) {
        const double more = c->measured[d].value[0][k] - clean->measured[d].value[0][k];
        *left += pow(c->measured[d].machine[0][k] - more, 2.0) / DIG_CURVE_POINTS;
        *wrong += pow(more, 2.0) / DIG_CURVE_POINTS;
    }
    *left  = sqrt(*left);
    *wrong = sqrt(*wrong);
}

// The first dig of a campaign need not be the machine's first.
TEST(a_payload_may_have_been_there_before_the_first_dig)
{
    const struct fault     none  = { .dry_N = 0.0 };
    const struct fault     laden = { .payload_kg = 70.0, .was_there = true };
    struct campaign *const clean = measure(&none, 16);
    struct campaign *const c     = trace(&laden, 16);
    double                 left, wrong;
    expect_found(c, DIG_EFFECT_PAYLOAD, NULL, 0.0);
    take_off(c);
    taken_off(c, clean, 0, &left, &wrong);
    print_message("%.3f Nm wrong, %.3f left\n", wrong, left);
    assert_true(wrong > 0.02 && left < 0.4 * wrong);
    end(c);
    end(clean);
}

// A payload that fell out before the second dig and stuck before the third.
TEST(each_dig_is_rid_of_the_payload_that_it_carried)
{
    const struct fault     none  = { .dry_N = 0.0 };
    const struct fault     some  = { .payload_kg = 120.0, .falls_out = true };
    struct campaign *const clean = measure(&none, 15);
    struct campaign *const c     = trace(&some, 15);
    double                 left[DIGS];
    double                 wrong[DIGS];
    assert_true(is_reported(&c->finding, DIG_EFFECT_PAYLOAD));
    take_off(c);
    for (size_t d = 0; d < DIGS; d++) {
        taken_off(c, clean, d, &left[d], &wrong[d]);
        print_message("dig %zu: %.3f Nm wrong, %.3f left\n", d, wrong[d], left[d]);
    }
    assert_true(wrong[2] > 0.02 && left[2] < 0.4 * wrong[2]);
    assert_true(wrong[1] < 0.1 * wrong[2] && left[1] < 0.4 * wrong[2]);
    end(c);
    end(clean);
}

// Soil lies in a bucket where soil has lain before; a hair of it tells nothing of where.
TEST(a_payload_of_ones_own_lies_where_the_common_one_does)
{
    const double          common[] = { 60.0, 6.0, -12.0 };
    const double          hair[]   = { 0.01, 0.5, -0.5 };
    struct dig_added_mass payload  = { 0.0, { 0.0, 0.0 }, 0.0 };
    dig_lines_carry(common, true, 80.0, &payload);
    assert_close(payload.mass_kg, 140.0, 1e-12);
    assert_close(payload.moment_kgm.x / payload.mass_kg, 0.1, 0.01);
    assert_close(payload.moment_kgm.y / payload.mass_kg, -0.2, 0.02);
    dig_lines_carry(common, false, 80.0, &payload); // in the first dig, say
    assert_close(payload.mass_kg, 80.0, 1e-12);
    assert_close(payload.moment_kgm.y / payload.mass_kg, -0.2, 0.02);
    dig_lines_carry(hair, false, 100.0, &payload);
    assert_close(payload.moment_kgm.x / payload.mass_kg, 0.0, 0.11);
    dig_lines_carry(common, true, -60.0, &payload); // fell out
    assert_close(payload.mass_kg, 0.0, 1e-12);
    assert_close(payload.moment_kgm.x, 0.0, 0.6);
}

// An effect of many parameters may be weak, too: it is not given to one of fewer.
TEST(a_weak_effect_is_reported_among_what_it_may_be)
{
    for (uint64_t seed = 61; seed <= most(61, 63); seed++) {
        const struct fault     weak = { .rod_Pa = 3e4 };
        struct campaign *const c    = trace(&weak, seed);
        for (size_t i = 0; i < c->finding.candidates; i++) {
            print_message("%s %.1f, ", dig_effect_name(c->finding.candidate[i].as.effect),
                          c->finding.candidate[i].log_evidence);
        }
        print_message("\n");
        assert_true(c->finding.significant && !c->finding.unexplained);
        assert_true(is_reported(&c->finding, DIG_EFFECT_PRESSURE_OFFSET));
        end(c);
    }
}

TEST(what_the_catalogue_lacks_gets_no_name)
{
    const struct fault     fault = { .wandering_N = 3000.0 };
    struct campaign *const c     = trace(&fault, 5);
    assert_true(c->finding.significant && c->finding.unexplained);
    assert_int_equal(c->finding.effects, 0);
    end(c);
}

// A payload of its own for every dig, say, would do for a gain that grows with the oil's
// temperature.
TEST(pressures_that_drift_get_no_name_and_say_what_they_follow)
{
    for (uint64_t seed = 7; seed <= most(7, 9); seed++) {
        const struct fault     drifts = { .warm_perK = 1.2e-3, .warms = true };
        struct campaign *const c      = trace(&drifts, seed);
        assert_true(c->finding.significant && c->finding.unexplained);
        assert_int_equal(c->finding.effects, 0);
        assert_non_null(c->finding.follows);
        assert_string_equal(c->finding.follows, "the oil's temperature");
        end(c);

        // Oil that warms hides no effect that has a name.
        const struct fault     carries = { .payload_kg = 60.0, .warms = true };
        struct campaign *const d       = trace(&carries, seed);
        assert_null(d->finding.follows);
        expect_found(d, DIG_EFFECT_PAYLOAD, "payload_kg", 60.0);
        end(d);
    }
}

TEST(pressures_at_the_bucket_alone_tell_the_moment_and_its_seal)
{
    const struct fault     whole = { .dry_N = 0.0 };
    const struct fault     bare  = { .bare = true };
    struct campaign *const all   = measure(&whole, 51);
    struct campaign *const c     = trace(&bare, 51);
    assert_false(c->finding.significant || c->finding.unexplained);
    for (int d = 0; d < DIGS; d++) {
        assert_true(c->measured[d].measured[DIG_CHANNEL_MY_Nm]);
        assert_false(c->measured[d].measured[DIG_CHANNEL_FX_N]);
        assert_false(c->measured[d].measured[DIG_CHANNEL_FZ_N]);
    }
    assert_close(apart(c, all, false), 0.0, 1e-9);
    end(all);
    end(c);
    const struct fault     seal = { .bare = true, .dry_N = 4000.0 };
    struct campaign *const d    = trace(&seal, 52);
    expect_found(d, DIG_EFFECT_CYLINDER_FRICTION, "coulomb_N", 4000.0);
    end(d);
}

TEST(recordings_without_free_air_say_so_and_name_nothing)
{
    const struct fault     seal = { .dry_N = 4000.0, .airless = true };
    struct campaign *const c    = trace(&seal, 71);
    assert_true(c->finding.no_air);
    assert_false(c->finding.significant || c->finding.unexplained);
    assert_int_equal(c->finding.effects, 0);
    assert_true(isnan(c->finding.residual_air));
    end(c);
    const struct fault     none = { .dry_N = 0.0 };
    struct campaign *const d    = trace(&none, 72);
    assert_false(d->finding.no_air);
    end(d);
}

TEST(how_the_machine_stands_is_told_where_it_was_recorded)
{
    const struct fault           none = { .dry_N = 0.0 };
    struct dig_machine_recording r    = record(0, 0, &none, 1);
    struct dig_measured *const   m    = calloc(1, sizeof *m);
    for (int known = 0; known < 2; known++) {
        struct dig_machine_side *side  = NULL;
        struct dig_error         error = { "" };
        for (size_t i = 0; i < r.rows; i++) {
            // Before the dig and after it the machine stood otherwise.
            const bool digs = i > r.rows / 20 && i + r.rows / 20 < r.rows;

            r.row[i].valid[DIG_SIGNAL_PITCH_rad] = known > 0;
            r.row[i].value[DIG_SIGNAL_PITCH_rad] = digs ? 0.04 : 0.2;
        }
        m->trajectory = MADE_SIMPLE_A;
        assert_int_equal(dig_machine_side_create(&machine, set, 1, &r, m, &side, &error), DIG_OK);
        assert_int_equal(m->pitch_known, known > 0);
        assert_close(m->pitch_rad, known > 0 ? 0.04 : 0.0, 1e-9);
        dig_machine_side_destroy(side);
    }
    dig_machine_recording_finish(&r);
    free(m);
}

TESTS_WITH(build, tear_down)

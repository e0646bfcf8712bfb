// Tests of what stands in free air and is no effect: closed_loop/air/row_sigma.c,
// closed_loop/machine_digs/free_air.c, closed_loop/machine/machine_slew.c and machine_noise.c.

#include "tests/closed_loop/machine_campaign.h"

// All readings of a pose are rounded alike where noise does not move them over the step.
TEST(quiet_sensors_of_a_machine_that_stands_raise_no_alarm_and_hide_no_seal)
{
    const struct dig_machine as_filed = machine;
    for (int j = 0; j < DIG_JOINTS; j++) {
        machine.cylinder[j].pressure_sigma_Pa *= 0.1;
    }
    for (uint64_t seed = 91; seed <= most(90, 93); seed++) {
        const struct fault     stands = { .stands = 12000 }; // a minute
        struct campaign *const c      = trace(&stands, seed);
        assert_nothing_found(c);
        end(c);
    }
    const struct fault     both = { .stands = 3000, .dry_N = 4000.0 };
    struct campaign *const c    = trace(&both, 94);
    expect_found(c, DIG_EFFECT_CYLINDER_FRICTION, "coulomb_N", 4000.0);
    end(c);
    machine = as_filed;
}

// Steps of the angles, and noise of which a load is as full: closed_loop/recordings/alignment.c.
TEST(coarse_angles_raise_no_alarm_and_hide_no_seal)
{
    static const double      rough_deg[][2] = { { 0.0, 0.35 }, { 0.15, 0.0 }, { 0.15, 0.5 } };
    const struct dig_machine as_filed       = machine;
    for (size_t k = most(2, 0); k < sizeof rough_deg / sizeof rough_deg[0]; k++) {
        static const struct fault none = { .dry_N = 0.0 };
        static const struct fault seal = { .dry_N = 4000.0 };
        machine.angle_sigma_rad        = rough_deg[k][0] * DIG_RAD_PER_DEG;
        machine.angle_step_rad         = rough_deg[k][1] * DIG_RAD_PER_DEG;
        struct campaign *c             = trace(&none, 95 + k);
        assert_nothing_found(c);
        end(c);
        c = trace(&seal, 98 + k);
        expect_found(c, DIG_EFFECT_CYLINDER_FRICTION, "coulomb_N", 4000.0);
        end(c);
    }
    machine = as_filed;
}

// No recording tells of it; what it pulls is left out, whatever else there is.
TEST(a_machine_that_slews_raises_no_alarm_and_hides_no_seal)
{
    for (uint64_t seed = 101; seed <= most(100, 102); seed++) {
        const struct fault     slews = { .stands = 1200, .slews_radps = 0.6 };
        struct campaign *const c     = trace(&slews, seed);
        assert_nothing_found(c);
        end(c);
    }
    const struct fault     both = { .stands = 1200, .slews_radps = 0.6, .dry_N = 4000.0 };
    struct campaign *const c    = trace(&both, 103);
    expect_found(c, DIG_EFFECT_CYLINDER_FRICTION, "coulomb_N", 4000.0);
    end(c);
}

// All effects together stand in for it there: it goes with the same motion in every dig.
TEST(a_machine_that_slews_as_it_closes_its_bucket_hides_no_seal)
{
    const struct fault     both = { .slews_radps = 1.0, .slews_after = true, .dry_N = 4000.0 };
    struct campaign *const c    = trace(&both, 104);
    expect_found(c, DIG_EFFECT_CYLINDER_FRICTION, "coulomb_N", 4000.0);
    end(c);
}

// Before it digs, a bucket often rests where it will go in; what the ground carries there is not of
// the machine.
TEST(a_bucket_that_rests_on_the_ground_raises_no_alarm_and_hides_no_seal)
{
    const struct fault rests = { .rests = 300, .ground_kg = 400.0 };
    struct campaign   *c     = trace(&rests, 106);
    assert_false(c->finding.significant);
    assert_close(c->finding.residual_air, 0.95, 0.15);
    end(c);
    const struct fault both = { .rests = 300, .ground_kg = 400.0, .dry_N = 4000.0 };
    c                       = trace(&both, 107);
    expect_found(c, DIG_EFFECT_CYLINDER_FRICTION, "coulomb_N", 4000.0);
    end(c);
}

// Or on a heap, higher than the ground it digs: closed_loop/machine/machine_slew.c.
TEST(a_bucket_that_rests_high_up_raises_no_alarm_and_hides_no_seal)
{
    for (uint64_t seed = 171; seed <= most(170, 172); seed++) {
        const struct fault     rests = { .stands = 700, .stands_kg = seed == 171 ? 900.0 : 250.0 };
        struct campaign *const c     = trace(&rests, seed);
        assert_nothing_found(c);
        assert_close(c->finding.residual_air, 0.95, 0.15);
        end(c);
    }
    const struct fault     both = { .stands = 700, .stands_kg = 400.0, .dry_N = 4000.0 };
    struct campaign *const c    = trace(&both, 173);
    expect_found(c, DIG_EFFECT_CYLINDER_FRICTION, "coulomb_N", 4000.0);
    end(c);
}

// Or touches it for less than a second where the recording begins.
TEST(a_bucket_that_touches_the_ground_raises_no_alarm_and_hides_no_seal)
{
    for (uint64_t seed = 174; seed <= most(174, 176); seed++) {
        const double           kg[]    = { 800.0, 2500.0, 300.0 };
        const struct fault     touches = { .stands = 120, .stands_kg = kg[seed - 174] };
        struct campaign *const c       = trace(&touches, seed);
        assert_nothing_found(c);
        end(c);
    }
    const struct fault     both = { .stands = 120, .stands_kg = 800.0, .dry_N = 4000.0 };
    struct campaign *const c    = trace(&both, 177);
    expect_found(c, DIG_EFFECT_CYLINDER_FRICTION, "coulomb_N", 4000.0);
    end(c);
}

// Noise that blocks do not average away is no effect; one that stands out of it is still found.
TEST(valves_that_hunt_raise_no_alarm_and_hide_no_seal)
{
    for (uint64_t seed = 31; seed <= most(30, 32); seed++) {
        const struct fault     hunting = { .hunting_Pa = 9e4 };
        struct campaign *const c       = trace(&hunting, seed);
        assert_false(c->finding.significant);
        assert_close(c->finding.residual_air, 1.0, 0.3);
        end(c);
    }
    const struct fault     both = { .hunting_Pa = 9e4, .dry_N = 4000.0 };
    struct campaign *const c    = trace(&both, 33);
    expect_found(c, DIG_EFFECT_CYLINDER_FRICTION, "coulomb_N", 4000.0);
    end(c);
}

// Noise of half a second hardly averages: it is as large in the means of a segment as effects are.
TEST(noise_that_lasts_raises_no_alarm_and_hides_no_seal)
{
    for (uint64_t seed = 111; seed <= most(111, 113); seed++) {
        const struct fault     hunting = { .hunting_Pa = 2e5, .hunting_s = 0.5 };
        struct campaign *const c       = trace(&hunting, seed);
        assert_nothing_found(c);
        assert_close(c->finding.residual_air, 1.0, 0.3);
        end(c);
    }
    const struct fault     both = { .hunting_Pa = 2e5, .hunting_s = 0.5, .dry_N = 4000.0 };
    struct campaign *const c    = trace(&both, 114);
    expect_found(c, DIG_EFFECT_CYLINDER_FRICTION, "coulomb_N", 4000.0);
    end(c);
}

// What every drive's noise does to the moment of a dig: the bucket's push, about its pin.
static double lasting_Nm(const int kind, const double each_Pa)
{
    const struct dig_rig_track *const t = &track[kind];

    const double push_sigma_N = hypot(push_N(&machine, DIG_JOINT_BUCKET, each_Pa, 0.0),
                                      push_N(&machine, DIG_JOINT_BUCKET, 0.0, each_Pa));
    double       square       = 0.0;
    double       count        = 0.0;
    for (size_t i = 0; i < t->rows; i++) {
        double lever_m;
        if (fabs(t->row[i].soil.M_Nm) > 0.0 &&
            dig_rig_lever_m(&machine, DIG_JOINT_BUCKET, t->row[i].joints.rad[DIG_JOINT_BUCKET],
                            &lever_m) == DIG_OK) {
            square += pow(push_sigma_N * lever_m, 2.0);
            count += 1.0;
        }
    }
    return sqrt(square / count);
}

TEST(free_air_tells_how_large_noise_is_in_a_dig_and_how_long_it_lasts)
{
    const double lambda = machine.link[DIG_JOINT_BUCKET].length_m / set->tooth_m;
    for (int k = (int)most(2, 0); k < 3; k++) {
        static const double    lasts_s[] = { 0.1, 0.2, 0.4 };
        const struct fault     hunting   = { .hunting_Pa = 2e5, .hunting_s = lasts_s[k] };
        struct campaign *const c         = measure(&hunting, 121 + (uint64_t)k);
        assert_int_equal(dig_machine_side_tell_noise(c->side, c->measured), DIG_OK);
        for (int d = 0; d < DIGS; d++) {
            const struct dig_lasting *const noise = &c->measured[d].lasting;

            const double seen_s  = noise->memory_s * sqrt(lambda);
            const double seen_Nm = noise->sigma[DIG_CHANNEL_MY_Nm] * pow(lambda, 4.0);
            print_message("%.2f s for %.2f, %.0f Nm for %.0f\n", seen_s, lasts_s[k], seen_Nm,
                          lasting_Nm(d % KINDS, 2e5));
            assert_true(seen_s > 0.45 * lasts_s[k] && seen_s < 2.2 * lasts_s[k]);
            assert_close(seen_Nm / lasting_Nm(d % KINDS, 2e5), 1.0, 0.4);
            assert_true(noise->sigma[DIG_CHANNEL_FX_N] > 0.0);
            assert_true(noise->sigma[DIG_CHANNEL_FZ_N] > 0.0);
        }
        end(c);
    }
    // Neither a machine without noise nor one that goes slowly up and down.
    static const struct fault quiet[] = { { .dry_N = 0.0 }, { .wandering_N = 3000.0 } };
    for (size_t k = 0; k < sizeof quiet / sizeof quiet[0]; k++) {
        struct campaign *const c = measure(&quiet[k], 131 + k);
        assert_int_equal(dig_machine_side_tell_noise(c->side, c->measured), DIG_OK);
        for (int d = 0; d < DIGS; d++) {
            assert_close(c->measured[d].lasting.sigma[DIG_CHANNEL_FX_N], 0.0, 0.0);
        }
        end(c);
    }
}

TEST(air_is_traced_alike_whether_its_noise_was_asked_for_before_or_not)
{
    const struct fault                hunting = { .hunting_Pa = 2e5, .hunting_s = 0.2 };
    struct campaign *const            c       = trace(&hunting, 122);
    struct dig_machine_finding *const again   = calloc(1, sizeof *again);
    assert_non_null(again);
    assert_int_equal(dig_machine_side_tell_noise(c->side, c->measured), DIG_OK);
    assert_int_equal(dig_machine_side_trace(c->side, 0.01, 122, again), DIG_OK);
    assert_false(again->no_air);
    assert_close(again->residual_air, c->finding.residual_air, 0.0);
    assert_close(again->p_complete, c->finding.p_complete, 0.0);
    assert_memory_equal(again->none.value, c->finding.none.value, sizeof again->none.value);
    assert_close(again->candidate[0].log_evidence, c->finding.candidate[0].log_evidence, 0.0);
    free(again);
    end(c);
}

// Missing is not zero: neither noise nor an effect is made of it.
TEST(readings_that_do_not_arrive_raise_no_alarm_and_hide_no_seal)
{
    const struct fault     lossy = { .lost = 2.0 }; // one of 22
    struct campaign *const c     = trace(&lossy, 41);
    assert_false(c->finding.significant);
    assert_close(c->finding.residual_air, 0.9, 0.15);
    assert_true(c->measured[0].measured[DIG_CHANNEL_FX_N]);
    end(c);
    const struct fault     both = { .lost = 2.0, .dry_N = 4000.0 };
    struct campaign *const d    = trace(&both, 42);
    expect_found(d, DIG_EFFECT_CYLINDER_FRICTION, "coulomb_N", 4000.0);
    end(d);
}

// Points of the air lie between the samples of a slow recorder: rates of the sample before them
// would look like a delay. Sensors are quiet enough to show it.
TEST(a_slow_recorder_is_no_delay)
{
    static const double      quiet    = 0.05;
    const struct dig_machine as_filed = machine;
    machine.pressure_step_Pa *= quiet;
    machine.angle_step_rad *= quiet;
    machine.angle_sigma_rad *= quiet;
    for (int j = 0; j < DIG_JOINTS; j++) {
        machine.cylinder[j].pressure_sigma_Pa *= quiet;
    }
    for (uint64_t seed = 81; seed <= most(81, 83); seed++) {
        const struct fault     slow = { .every = 4 }; // 50 Hz
        struct campaign *const c    = trace(&slow, seed);
        assert_false(c->finding.significant);
        for (size_t i = 0; i < c->finding.candidates; i++) {
            if (c->finding.candidate[i].as.effect == DIG_EFFECT_SENSOR_DELAY) {
                assert_close(c->finding.candidate[i].as.parameter[0].value, 0.0, 0.001);
            }
        }
        end(c);
    }
    machine = as_filed;
}

TESTS_WITH(build, tear_down)

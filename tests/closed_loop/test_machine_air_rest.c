// Tests for closed_loop/air/machine_air_rest.c

#include "closed_loop/air/machine_air.h"
#include "tests/read.h"

#include <math.h>
#include <stdlib.h>

enum { SAMPLES = 600, NUMBERS = sizeof(struct dig_correction) / sizeof(double) };

static struct dig_machine     machine;
static struct dig_machine_dig air_dig;

// All joints swing, each at its own pace; pressures that no machine would have will do.
static int record(void **state)
{
    (void)state;
    static struct dig_sample     row[SAMPLES];
    struct dig_machine_recording recording = { .rows = SAMPLES, .row = row };
    struct dig_error             error     = { "" };
    machine                                = read_machine("zx200_trench");
    for (size_t i = 0; i < SAMPLES; i++) {
        const double t_s = 0.01 * (double)i;
        row[i].time_ns   = (int64_t)(1e7 * (double)i);
        for (int s = 0; s < DIG_SIGNALS_NEEDED; s++) {
            row[i].valid[s] = true;
        }
        for (int j = 0; j < DIG_JOINTS; j++) {
            const struct dig_link *const link = &machine.link[j];
            const double                 part = 0.5 + 0.2 * sin((1.0 + 0.7 * j) * t_s);

            row[i].value[DIG_SIGNAL_BOOM_rad + j] =
                link->min_rad + part * (link->max_rad - link->min_rad);
            row[i].value[DIG_SIGNAL_BOOM_HEAD_Pa + 2 * j] = 6e6 + 2e6 * cos(t_s + j);
            row[i].value[DIG_SIGNAL_BOOM_ROD_Pa + 2 * j]  = 1e6 + 2e5 * sin(3.0 * t_s);
        }
    }
    assert_ok(dig_machine_dig_make_air(&machine, &recording, &air_dig, &error), error);
    return 0;
}

static int forget(void **state)
{
    (void)state;
    dig_machine_dig_finish(&air_dig);
    return 0;
}

static struct dig_air make(void)
{
    struct dig_air air;
    assert_int_equal(dig_air_make(&machine, 1, &air_dig, NULL, &air), DIG_OK);
    return air;
}

enum way { READ, CALM, HELD, WAYS };

static void ask(struct dig_air *const air, const struct dig_correction *const correction,
                const enum way way, double rest[])
{
    if (way == HELD) {
        dig_air_held(air, correction, rest);
    } else {
        dig_air_rest(air, correction, way == CALM, rest);
    }
}

// As one that was never asked before.
static void assert_as_new(struct dig_air *const air, const struct dig_correction *const calm_at,
                          const struct dig_correction *const correction, const enum way way)
{
    struct dig_air anew  = make();
    double *const  rest  = malloc(air->rows * sizeof *rest);
    double *const  again = malloc(air->rows * sizeof *again);
    assert_true(air->rows > 20);
    dig_air_calm(&anew, calm_at);
    ask(&anew, correction, way, rest);
    ask(air, correction, way, again);
    assert_memory_equal(rest, again, air->rows * sizeof *rest);
    free(rest);
    free(again);
    dig_air_finish(&anew);
}

TEST(air_asked_again_with_any_number_of_a_correction_changed_answers_as_new_air)
{
    static const struct dig_correction none = { .delay_s = 0.0 };
    struct dig_correction correction        = { .friction = { { 1000.0, 1e4, 500.0, 0.05, 0.01 },
                                                              { 800.0, 0.0, 0.0, 0.0, 0.02 } } };
    struct dig_air        air               = make();
    dig_air_calm(&air, &none);
    for (size_t n = 0; n < NUMBERS; n++) {
        double *const number = (double *)(void *)&correction + n;
        assert_as_new(&air, &none, &correction, (enum way)(n % WAYS));
        *number += 1e-3 * (1.0 + fabs(*number));
        assert_as_new(&air, &none, &correction, (enum way)(n % WAYS));
    }
    dig_air_finish(&air);
}

// By the pressures that are read the made-up machine is far from balance.
TEST(calm_pressures_balance_the_machine_they_were_made_for)
{
    const struct dig_correction none  = { .delay_s = 0.0 };
    const struct dig_correction heavy = { .link[DIG_JOINT_BUCKET] = { .mass_kg = 100.0 } };
    struct dig_air              air   = make();
    double *const               read  = malloc(3 * air.rows * sizeof *read);
    double *const               calm  = read + air.rows;
    double *const               other = calm + air.rows;
    dig_air_calm(&air, &heavy);
    dig_air_rest(&air, &heavy, false, read);
    dig_air_rest(&air, &heavy, true, calm);
    dig_air_rest(&air, &none, true, other);
    double of_read = 0.0, of_other = 0.0;
    for (size_t r = 0; r < air.rows; r++) {
        assert_close(calm[r], 0.0, 1e-6);
        of_read += read[r] * read[r] / (double)air.rows;
        of_other += other[r] * other[r] / (double)air.rows;
    }
    print_message("%.3g sigmas as read, %.3g without the mass\n", sqrt(of_read), sqrt(of_other));
    assert_true(of_read > 1.0 && of_other > 1.0);
    free(read);
    dig_air_finish(&air);
}

TEST(air_calmed_again_forgets_the_pressures_before)
{
    const struct dig_correction none  = { .delay_s = 0.0 };
    const struct dig_correction heavy = { .link[DIG_JOINT_BUCKET] = { .mass_kg = 100.0 } };
    struct dig_air              air   = make();
    double *const               rest  = malloc(air.rows * sizeof *rest);
    dig_air_calm(&air, &none);
    dig_air_rest(&air, &none, true, rest);
    dig_air_calm(&air, &heavy);
    assert_as_new(&air, &heavy, &heavy, CALM);
    assert_as_new(&air, &heavy, &none, CALM);
    free(rest);
    dig_air_finish(&air);
}

// Where a reading is no number all joints of a point have none, and have one again when it is.
TEST(a_correction_that_is_no_number_leaves_nothing_behind)
{
    const struct dig_correction none                  = { .delay_s = 0.0 };
    struct dig_correction       broken                = { .delay_s = 0.0 };
    struct dig_air              air                   = make();
    broken.offset_Pa[DIG_JOINT_ARM][DIG_CHAMBER_HEAD] = (double)NAN;
    dig_air_calm(&air, &none);
    assert_as_new(&air, &none, &none, READ);
    assert_as_new(&air, &none, &broken, READ);
    assert_as_new(&air, &none, &none, READ);
    dig_air_finish(&air);
}

TESTS_WITH(record, forget)

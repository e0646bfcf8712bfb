// Tests for closed_loop/recordings/force_check.c

#include "closed_loop/recordings/force_check.h"

#include "tests/made_table.h"
#include "tests/testlib.h"

#include <stdlib.h>

// The dig of the table's entry at such a size of moment and forces.
static struct dig_measured *dig_of(const struct dig_curve_set *const set, const size_t entry,
                                   const double moment, const double forces)
{
    struct dig_measured *const    dig   = calloc(1, sizeof *dig);
    const struct dig_curve *const curve = &set->curve[entry * set->trajectories + MADE_ACTUAL];
    dig->trajectory                     = MADE_ACTUAL;
    dig->first                          = 0.05;
    dig->last                           = 0.9;
    for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
        dig->measured[c] = true;
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            dig->value[c][k] =
                (c == DIG_CHANNEL_MY_Nm ? moment : forces) * (double)curve->mean[c][k];
        }
    }
    return dig;
}

TEST(forces_in_another_unit_or_direction_are_refused_and_ground_far_off_the_table_is_not)
{
    const struct made_options   options = { .relative_sd = 0.1, .packings = 3 };
    struct dig_curve_set *const set     = made_table(&options);
    static const struct {
        double      moment, forces;
        const char *says; // NULL: it passes
    } digs[] = {
        { 1.0, 1.0, NULL },
        { 0.1, 0.1, NULL },
        { 10.0, 10.0, NULL },
        { 1.0, 1e-3, "Fx_N, Fz_N" },
        { 1e-3, 1.0, "My_Nm" },
        { 1e-3, 1e-3, "weakest gravel" },
        { 1e3, 1e3, "strongest gravel" },
        { 1.0, 1e3, "Fx_N, Fz_N" },
        { -1.0, -1.0, "My_Nm: against" },
        { 1.0, -1.0, "Fx_N, Fz_N: against" },
    };
    for (size_t e = 0; e < set->entries; e += set->entries - 1) {
        for (size_t k = 0; k < sizeof digs / sizeof digs[0]; k++) {
            struct dig_error           error = { "" };
            struct dig_measured *const dig   = dig_of(set, e, digs[k].moment, digs[k].forces);
            const enum dig_status      is    = dig_force_check(set, dig, &error);
            assert_int_equal(is, digs[k].says == NULL ? DIG_OK : DIG_EINVAL);
            if (digs[k].says != NULL) {
                assert_contains(error.text, digs[k].says);
                assert_contains(error.text, ", expected ");
            }
            free(dig);
        }
    }
    made_table_destroy(set);
}

// By the moment alone, as where no forces are measured.
TEST(forces_that_are_not_measured_are_not_asked)
{
    const struct made_options   options = { .relative_sd = 0.1, .packings = 3 };
    struct dig_curve_set *const set     = made_table(&options);
    struct dig_error            error   = { "" };
    struct dig_measured *const  dig     = dig_of(set, 0, 1.0, 0.0);
    dig->measured[DIG_CHANNEL_FX_N] = dig->measured[DIG_CHANNEL_FZ_N] = false;
    assert_ok(dig_force_check(set, dig, &error), error);
    free(dig);
    made_table_destroy(set);
}

TEST(a_sensor_that_stands_still_is_refused)
{
    const struct made_options   options = { .relative_sd = 0.1, .packings = 3 };
    struct dig_curve_set *const set     = made_table(&options);
    struct dig_measured *const  dig     = dig_of(set, 0, 1.0, 1.0);
    struct dig_error            error   = { "" };
    static const struct dig_move {
        size_t first, end;
    } stuck[] = { { 1, 3 }, { 0, 3 } };
    for (size_t i = 0; i < 2; i++) {
        for (size_t c = stuck[i].first; c < stuck[i].end; c++) {
            for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
                dig->value[c][k] = 5.0;
            }
        }
        assert_int_equal(dig_force_check(set, dig, &error), DIG_EINVAL);
        assert_contains(error.text, i == 0 ? "Fx_N, Fz_N: one value" : "My_Nm: one value");
    }
    free(dig);
    made_table_destroy(set);
}

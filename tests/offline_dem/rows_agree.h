// Two engines' recordings of one dig, held against each other before chaos parts them.

#ifndef DIG_TESTS_OFFLINE_DEM_ROWS_AGREE_H
#define DIG_TESTS_OFFLINE_DEM_ROWS_AGREE_H

#include "core/recording.h"
#include "tests/dem_fixture.h"

#include <math.h>

/// Every window, to 1e-9 of the largest force, in a dig that weighs 20 grains and more.
static inline void rows_agree(const struct dig_recording *const a,
                              const struct dig_recording *const b)
{
    assert_int_equal(a->rows, b->rows);
    double most_N = 0.0;
    for (size_t k = 0; k < a->rows; k++) {
        most_N = fmax(most_N, hypot(a->row[k].Fx_N, a->row[k].Fz_N));
    }
    assert_true(most_N > 20.0 * GRAIN_kg * GRAVITY);
    for (size_t k = 0; k < a->rows; k++) {
        const struct dig_force_row *const x = &a->row[k];
        const struct dig_force_row *const y = &b->row[k];
        assert_close(y->t_s, x->t_s, 0.0);
        assert_close(y->theta_deg, x->theta_deg, 0.0);
        assert_close(y->Fx_N, x->Fx_N, 1e-9 * most_N);
        assert_close(y->Fy_N, x->Fy_N, 1e-9 * most_N);
        assert_close(y->Fz_N, x->Fz_N, 1e-9 * most_N);
        assert_close(y->Mx_Nm, x->Mx_Nm, 1e-9 * most_N * 0.04);
        assert_close(y->My_Nm, x->My_Nm, 1e-9 * most_N * 0.04);
        assert_close(y->carried_kg, x->carried_kg, 1e-12);
    }
}

#endif // DIG_TESTS_OFFLINE_DEM_ROWS_AGREE_H

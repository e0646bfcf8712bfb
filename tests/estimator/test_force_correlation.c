// Tests for estimator/match/entry_scatter.h: how errors of moment and forces go together in
// packings

#include "estimator/match/entry_scatter.h"

#include "tables/derive.h"
#include "tables/load.h"
#include "tables/store.h"
#include "tests/testlib.h"

#include <stdlib.h>
#include <string.h>

enum { CHANNELS = DIG_FORCE_CHANNELS, MANY = 8, MOST = 16 };

// Runs of one gravel along one trajectory after the other, and what they say of correlation.
struct beds {
    const struct dig_curve_set *set;
    struct dig_run_origin       origin;
    size_t                      digs;
    double                      curve[MOST][DIG_CHANNELS][DIG_CURVE_POINTS];
    double                      sum[CHANNELS][CHANNELS], points;
};

// Mean over points of the correlation of what digs are off their mean.
static void close_gravel(struct beds *const b)
{
    for (int k = 0; b->digs >= MANY && k < DIG_CURVE_POINTS; k++) {
        double product[CHANNELS][CHANNELS] = { { 0.0 } }, mean[CHANNELS] = { 0.0 };
        for (size_t d = 0; d < b->digs; d++) {
            for (int c = 0; c < CHANNELS; c++) {
                mean[c] += b->curve[d][c][k] / (double)b->digs;
            }
        }
        for (size_t d = 0; d < b->digs; d++) {
            for (int c = 0; c < CHANNELS; c++) {
                for (int o = 0; o < CHANNELS; o++) {
                    product[c][o] += (b->curve[d][c][k] - mean[c]) * (b->curve[d][o][k] - mean[o]);
                }
            }
        }
        if (product[0][0] > 1e-12 && product[1][1] > 1e-9 && product[2][2] > 1e-9) {
            for (int c = 0; c < CHANNELS; c++) {
                for (int o = 0; o < CHANNELS; o++) {
                    b->sum[c][o] += product[c][o] / sqrt(product[c][c] * product[o][o]);
                }
            }
            b->points += 1.0;
        }
    }
    b->digs = 0;
}

static enum dig_status take_run(void *const context, const struct dig_run *const run,
                                struct dig_error *const error)
{
    (void)error;
    struct beds *const b = context;
    if (run->origin.trajectory != b->origin.trajectory ||
        memcmp(&run->origin.gravel, &b->origin.gravel, sizeof run->origin.gravel) != 0) {
        close_gravel(b);
        b->origin = run->origin;
    }
    if (b->digs < MOST && run->origin.effect[0] == '\0') {
        assert_int_equal(dig_derive_run(&b->set->trajectory[run->origin.trajectory],
                                        b->set->tooth_m, b->set->smooth_half_s, run->windows,
                                        run->first_s, run->step_s, run->value, b->curve[b->digs]),
                         DIG_OK);
        b->digs++;
    }
    return DIG_OK;
}

TEST(errors_of_moment_and_forces_go_together_as_packings_show)
{
    static const char     table[] = "tables/reference_rig.sqlite";
    struct dig_store     *store   = NULL;
    struct dig_curve_set *set     = NULL;
    struct beds *const    b       = calloc(1, sizeof *b);
    assert_int_equal(dig_table_load(table, &set, NULL), DIG_OK);
    assert_int_equal(dig_store_open(table, &store, NULL), DIG_OK);
    b->set                               = set;
    const struct dig_run_visitor visitor = { take_run, b };
    assert_int_equal(dig_store_walk(store, &visitor, NULL), DIG_OK);
    close_gravel(b);
    const double My_Fx = b->sum[0][1] / b->points;
    const double My_Fz = b->sum[0][2] / b->points;
    const double Fx_Fz = b->sum[1][2] / b->points;
    print_message("over %.0f points: My, Fx %.3f; My, Fz %.3f; Fx, Fz %.3f\n", b->points, My_Fx,
                  My_Fz, Fx_Fz);
    assert_close(My_Fx, DIG_ENTRY_SCATTER_MY_FX, 0.03);
    assert_close(My_Fz, DIG_ENTRY_SCATTER_MY_FZ, 0.06);
    assert_close(Fx_Fz, DIG_ENTRY_SCATTER_FX_FZ, 0.06);
    dig_store_close(store);
    dig_curve_set_destroy(set);
    free(b);
}

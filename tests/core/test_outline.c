// Tests for core/outline.c: what an outline holds, and the spread that is pooled

#include "core/outline.h"

#include "tests/made_table.h"
#include "tests/testlib.h"

enum { POINTS = DIG_CURVE_POINTS, MISSING = 4 * MADE_TRAJECTORIES + 1 };

TEST(outlines_have_the_means_of_blocks_and_the_table_the_spread_of_what_was_dug)
{
    const struct made_options   options   = { .relative_sd = 0.15, .packings = 3 };
    struct dig_curve_set *const set       = made_table(&options);
    set->packings[MISSING]                = 0;
    set->curve[MISSING].sd[0][POINTS / 2] = 1e3F;
    dig_outlines_draw(set);
    for (size_t slot = 0; slot < set->entries * set->trajectories; slot++) {
        for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
            for (int b = 0; b < DIG_OUTLINE_BLOCKS; b++) {
                double mean = 0.0;
                for (int k = 0; k < POINTS; k++) {
                    const bool inside = k * DIG_OUTLINE_BLOCKS / POINTS == b;
                    mean += inside ? (double)set->curve[slot].mean[c][k] : 0.0;
                }
                const double mean_told = (double)dig_outline_mean(set, c, slot)[b];
                assert_close(mean_told * 16.0, mean, 1e-5 * (1.0 + fabs(mean)));
            }
        }
    }
    for (size_t t = 0; t < MADE_TRAJECTORIES; t++) {
        for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
            double sum = 0.0;
            for (size_t b = 0; b < DIG_COVARIANCE_BLOCKS; b++) {
                sum += set->relative2[t][c * DIG_COVARIANCE_BLOCKS + b];
            }
            assert_close(sum / DIG_COVARIANCE_BLOCKS, 0.15 * 0.15, 1e-7);
        }
    }
    made_table_destroy(set);
}

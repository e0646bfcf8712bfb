// A pressure sensor reads offset + (1 + gain) times the pressure. Offsets of both chambers of a
// drive act alike, a constant force; in free air only the return side's back pressure separates
// them.

#include "estimator/effects/list.h"

// Chamber by chamber as in a sample: boom head, boom rod, arm head, …
enum { OFFSETS = DIG_JOINTS * DIG_CHAMBERS, PARAMETERS = 2 * OFFSETS };

static void correct(const double value[], struct dig_correction *const correction)
{
    for (int j = 0; j < DIG_JOINTS; j++) {
        for (int c = 0; c < DIG_CHAMBERS; c++) {
            correction->offset_Pa[j][c] = value[DIG_CHAMBERS * j + c];
            correction->gain[j][c]      = value[OFFSETS + DIG_CHAMBERS * j + c];
        }
    }
}

const struct dig_effect dig_effect_pressure_offset = {
    .id         = DIG_EFFECT_PRESSURE_OFFSET,
    .summary    = "a pressure sensor that reads too much or too little",
    .parameters = PARAMETERS,
    .parameter  = {
        { "boom_head_Pa", 0.0, -1e7, 1e7, 3e5 },    { "boom_rod_Pa", 0.0, -1e7, 1e7, 3e5 },
        { "arm_head_Pa", 0.0, -1e7, 1e7, 3e5 },     { "arm_rod_Pa", 0.0, -1e7, 1e7, 3e5 },
        { "bucket_head_Pa", 0.0, -1e7, 1e7, 3e5 },  { "bucket_rod_Pa", 0.0, -1e7, 1e7, 3e5 },
        { "boom_head_gain", 0.0, -0.5, 0.5, 0.05 }, { "boom_rod_gain", 0.0, -0.5, 0.5, 0.05 },
        { "arm_head_gain", 0.0, -0.5, 0.5, 0.05 },  { "arm_rod_gain", 0.0, -0.5, 0.5, 0.05 },
        { "bucket_head_gain", 0.0, -0.5, 0.5, 0.05 }, { "bucket_rod_gain", 0.0, -0.5, 0.5, 0.05 },
    },
    .wrong_share = 0.02, .wrong_step = 0.02,
    .correct = correct,
};

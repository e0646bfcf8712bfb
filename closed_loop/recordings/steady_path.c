#include "closed_loop/recordings/steady_path.h"

#include "core/units.h"
#include "estimator/track/steady.h"

#include <assert.h>

// Of the tooth's length: what the path's sensors may scatter by.
static const double vertex_share = 0.01;

void dig_steady_path(struct dig_recording *const recording, const double tooth_m, double number[])
{
    assert(recording != NULL && recording->rows > 0 && number != NULL);
    const size_t                 rows   = recording->rows;
    const size_t                 stride = sizeof recording->row[0] / sizeof(double);
    struct dig_force_row *const  row    = recording->row;
    const struct dig_steady_axis axis[] = { { &row->pin_x_m, stride, 1.0 },
                                            { &row->pin_z_m, stride, 1.0 },
                                            { &row->theta_deg, stride,
                                              tooth_m * DIG_RAD_PER_DEG } };
    double *const                room[] = { number, number + rows, number + 2 * rows };
    for (int a = 0; a < DIG_STEADY_AXES; a++) {
        for (size_t i = 0; i < rows; i++) {
            number[i] = axis[a].value[i * stride];
        }
        dig_steady_readings(rows, 0.0, number);
        for (size_t i = 0; i < rows; i++) {
            axis[a].value[i * stride] = number[i];
        }
    }
    (void)dig_steady_smooth(rows, axis, vertex_share * tooth_m, room, number + 3 * rows);
}

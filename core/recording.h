// A recording of one dig, in memory. files/recording_csv.h reads and writes it.

#ifndef DIG_CORE_RECORDING_H
#define DIG_CORE_RECORDING_H

#include "core/sample.h"

#include <stdbool.h>
#include <stddef.h>

/// One line of a force recording: a rig with a force sensor, or a DEM. Frames of core/curve.h:
/// force and moment of the soil on the bucket, moments about the moving pin, means over the window
/// around t; NaN where one was not measured. carried_kg is the mass of the grains whose centre lies
/// inside the bucket's closed profile and width, at the window's end; NaN where nobody can know it.
/// Its members are the columns of files/recording_csv.c, in this order.
struct dig_force_row {
    double t_s, pin_x_m, pin_z_m, theta_deg;
    double Fx_N, Fy_N, Fz_N, Mx_Nm, My_Nm, Mz_Nm;
    double carried_kg;
};

/// Owned by the caller; t_s ascends strictly. A zeroed struct is an empty recording.
struct dig_recording {
    size_t                rows;
    struct dig_force_row *row; // [rows], malloc
};

/// A machine recording: one sample a line.
struct dig_machine_recording {
    size_t             rows;
    struct dig_sample *row; // [rows], malloc; time_ns counts from the recording's own zero
};

/// True when every row has a carried mass.
bool dig_recording_knows_carried(const struct dig_recording *recording);

/// Free what the rows hold and zero the struct. NULL and a zeroed struct are allowed.
void dig_recording_finish(struct dig_recording *recording);
void dig_machine_recording_finish(struct dig_machine_recording *recording);

#endif // DIG_CORE_RECORDING_H

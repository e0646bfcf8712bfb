#include "tools/rig/truth.h"

#include "files/text/whole.h"

#include <stdio.h>

enum dig_status dig_rig_truth_write(const char *const path, const struct dig_rig_track *const track,
                                    struct dig_error *const error)
{
    struct dig_out        out;
    const enum dig_status status = dig_out_open(&out, path, error);
    if (status != DIG_OK) {
        return status;
    }
    struct dig_c_locale locale = dig_c_locale_enter();
    (void)fputs("t_s,X_m,Z_m,phi_rad,Fx_N,Fz_N,My_Nm\n", out.file);
    for (size_t i = 0; i < track->rows; i++) {
        const struct dig_rig_row *const row = &track->row[i];
        (void)fprintf(out.file, "%.6f,%.12g,%.12g,%.12g,%.12g,%.12g,%.12g\n",
                      (double)i * track->step_s, row->pose.X_m, row->pose.Z_m, row->pose.phi_rad,
                      0.0 - row->soil.FX_N, row->soil.FZ_N, row->soil.M_Nm);
    }
    dig_c_locale_leave(&locale);
    return dig_out_commit(&out, error);
}

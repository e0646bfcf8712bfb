#include "estimator/track/recorded_dig.h"

#include "core/units.h"
#include "estimator/track/frame.h"
#include "estimator/track/steady.h"

#include <assert.h>
#include <math.h>

// Spacing of vertices, rig scale: several times the pin's step by one step of a bus's angles.
static double vertex_spacing_m(const struct dig_curve_set *const set)
{
    return 0.025 * set->tooth_m;
}

void dig_recorded_dig_clear(struct dig_recorded_dig *const    recording,
                            const struct dig_curve_set *const set)
{
    assert(recording != NULL && set != NULL);
    dig_window_close(&recording->window);
    recording->missing = false;
    recording->path    = (struct dig_path){ .spacing_m = vertex_spacing_m(set) };
}

void dig_recorded_dig_contact(struct dig_recorded_dig *const     recording,
                              const struct dig_path_point *const point)
{
    assert(recording != NULL && point != NULL);
    dig_window_open(&recording->window);
    recording->contact_s = recording->newest_s;
    recording->soil_s    = recording->newest_s;
    recording->pitch_rad = 0.0;
    recording->pitched   = 0.0;
    for (size_t i = 0; i < recording->window.count; i++) {
        (void)dig_path_add(&recording->path, &recording->window.sample[i].pose, false);
    }
    dig_path_add_contact(&recording->path, point);
}

void dig_recorded_dig_follow(struct dig_recorded_dig *const     recording,
                             const struct dig_path_point *const point, const bool in_soil)
{
    assert(recording != NULL && point != NULL);
    (void)dig_path_add(&recording->path, point, in_soil);
    recording->soil_s = in_soil ? recording->newest_s : recording->soil_s;
}

// The path as the samples' poses have it.
static void lay(struct dig_recorded_dig *const recording, const struct dig_curve_set *const set)
{
    const struct dig_window *const window = &recording->window;
    bool                           dug    = false;
    recording->path                       = (struct dig_path){ .spacing_m = vertex_spacing_m(set) };
    for (size_t i = 0; i < window->count; i++) {
        const struct dig_window_sample *const s = &window->sample[i];
        if (!dug && s->time_s >= recording->contact_s) {
            dig_path_add_contact(&recording->path, &s->pose);
            dug = true;
        } else {
            (void)dig_path_add(&recording->path, &s->pose, dug && s->time_s <= recording->soil_s);
        }
    }
}

void dig_recorded_dig_steady(struct dig_recorded_dig *const    recording,
                             const struct dig_curve_set *const set)
{
    assert(recording != NULL && set != NULL);
    struct dig_window *const window = &recording->window;
    const size_t             stride = sizeof window->sample[0] / sizeof(double);
    struct dig_path_point   *pose   = &window->sample[0].pose;

    const struct dig_steady_axis axis[] = { { &pose->x_m, stride, 1.0 },
                                            { &pose->z_m, stride, 1.0 },
                                            { &pose->turn_m, stride, 1.0 } };
    double *const                room[] = { window->progress, window->table_s, window->value };
    dig_window_sort(window);
    if (window->count > 0 &&
        dig_steady_smooth(window->count, axis, vertex_spacing_m(set), room, window->smooth) > 0) {
        lay(recording, set);
    }
}

struct dig_path_point dig_recorded_dig_point(const struct dig_curve_set *const set,
                                             const double lambda, const double pin_X_m,
                                             const double pin_Z_m, const double phi_rad)
{
    assert(set != NULL);
    const double theta_rad = remainder(-0.5 * DIG_PI - phi_rad, 2.0 * DIG_PI);
    return (struct dig_path_point){
        .x_m    = -pin_X_m / lambda,
        .z_m    = pin_Z_m / lambda,
        .turn_m = set->tooth_m * theta_rad,
    };
}

void dig_recorded_dig_add(struct dig_recorded_dig *const    recording,
                          const struct dig_curve_set *const set, const double lambda,
                          const int64_t time_ns, const struct dig_wrench *const wrench,
                          const double bias_Nm, const double pitch_rad,
                          const struct dig_path_point *const point,
                          const double                       joint_rad[const DIG_JOINTS])
{
    assert(recording != NULL && set != NULL && wrench != NULL && point != NULL);
    assert(joint_rad != NULL);
    const double step_s = 1e-9 * (double)(time_ns - recording->last_ns);
    const double hole_s = sqrt(lambda) * dig_window_hole_s(set->smooth_half_s);
    recording->missing |= recording->window.open && step_s > hole_s;
    recording->last_ns  = time_ns;
    recording->newest_s = 1e-9 * (double)time_ns / sqrt(lambda);
    recording->pitch_rad += pitch_rad;
    recording->pitched += 1.0;

    const double                   lambda3 = lambda * lambda * lambda;
    const double                   lambda4 = lambda * lambda3;
    const struct dig_window_sample sample  = {
         .time_s     = recording->newest_s,
         .pose       = *point,
         .joint_rad  = { joint_rad[0], joint_rad[1], joint_rad[2] },
         .has_forces = wrench->force_valid,
         .value      = { (wrench->My_Nm - bias_Nm) / lambda4, wrench->Fx_N / lambda3,
                         wrench->Fz_N / lambda3 },
         .sigma = { (float)(wrench->sigma_My_Nm / lambda4), (float)(wrench->sigma_Fx_N / lambda3),
                    (float)(wrench->sigma_Fz_N / lambda3) },
         .slow  = { (float)(wrench->slow_sigma_My_Nm / lambda4),
                    (float)(wrench->slow_sigma_Fx_N / lambda3),
                    (float)(wrench->slow_sigma_Fz_N / lambda3) },
    };
    dig_window_add(&recording->window, &sample);
}

double dig_recorded_dig_pitch_rad(const struct dig_recorded_dig *const recording)
{
    assert(recording != NULL);
    return recording->pitched > 0.0 ? recording->pitch_rad / recording->pitched : 0.0;
}

void dig_recorded_dig_turn(struct dig_recorded_dig *const    recording,
                           const struct dig_curve_set *const set, const double pitch_rad)
{
    assert(recording != NULL && set != NULL);
    struct dig_path *const path = &recording->path;
    for (size_t i = 0; i < path->vertices; i++) {
        path->vertex[i] = dig_frame_turned(&path->vertex[i], pitch_rad, set->tooth_m);
    }
    for (size_t i = 0; i < recording->window.count; i++) {
        struct dig_window_sample *const sample = &recording->window.sample[i];
        sample->pose = dig_frame_turned(&sample->pose, pitch_rad, set->tooth_m);
        dig_frame_turn_forces(pitch_rad, sample);
    }
}

size_t dig_recorded_dig_size(void)
{
    return sizeof(struct dig_recorded_dig);
}

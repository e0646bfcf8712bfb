// The frame in which a dig lies. A machine that says how it is pitched digs level ground, along its
// trajectory in the world's frame, or ground that is pitched as it is, in its own: the path tells.
// Rig scale and axes: nose up turns x and z towards each other, and theta back.

#ifndef DIG_ESTIMATOR_TRACK_FRAME_H
#define DIG_ESTIMATOR_TRACK_FRAME_H

#include "estimator/track/route.h"
#include "estimator/track/window.h"

/// A point of a machine pitched by so much, in the world's frame.
struct dig_path_point dig_frame_turned(const struct dig_path_point *point, double pitch_rad,
                                       double tooth_m);

/// A route of the world as such a machine's own frame has it: the same path, turned back.
struct dig_route dig_frame_route(const struct dig_route *route, double pitch_rad, double tooth_m);

/// Turns the forces of a sample and their sigmas into the world's frame; its pose stays.
void dig_frame_turn_forces(double pitch_rad, struct dig_window_sample *sample);

#endif // DIG_ESTIMATOR_TRACK_FRAME_H

// A rigid body under loads, stepped like the grains: velocities stand half a step behind positions.
// Momentum and angular momentum change by the loads only. The rotation over a step uses the angular
// velocity in its middle, found by half a step forward at constant angular momentum.

#ifndef DIG_OFFLINE_DEM_LAW_RIGID_H
#define DIG_OFFLINE_DEM_LAW_RIGID_H

#include "offline_dem/law/both.h"

#include <math.h>

struct dig_rigid {
    double x_m[3]; // centre of mass
    double v_mps[3];
    double l_Nms[3];   // angular momentum, world axes
    double w_radps[3]; // in the middle of the last step
    double q[4];       // body to world; real part first
    double mass_kg;
    double inverse_pkgm2[3][3]; // of the inertia, body axes
};

DIG_BOTH static inline void dig_rigid_rotate(const double q[4], const double body[3],
                                             double world[3])
{
    const double u  = q[0];
    const double x  = q[1];
    const double y  = q[2];
    const double z  = q[3];
    const double tx = 2.0 * (y * body[2] - z * body[1]);
    const double ty = 2.0 * (z * body[0] - x * body[2]);
    const double tz = 2.0 * (x * body[1] - y * body[0]);
    const double wx = body[0] + u * tx + y * tz - z * ty;
    const double wy = body[1] + u * ty + z * tx - x * tz;
    const double wz = body[2] + u * tz + x * ty - y * tx;
    world[0]        = wx;
    world[1]        = wy;
    world[2]        = wz;
}

/// World to body.
DIG_BOTH static inline void dig_rigid_rotate_back(const double q[4], const double world[3],
                                                  double body[3])
{
    const double back[4] = { q[0], -q[1], -q[2], -q[3] };
    dig_rigid_rotate(back, world, body);
}

/// The rotation matrix as a unit quaternion.
DIG_BOTH static inline void dig_rigid_quaternion(const double r[3][3], double q[4])
{
    const double t[4] = { 1.0 + r[0][0] + r[1][1] + r[2][2], 1.0 + r[0][0] - r[1][1] - r[2][2],
                          1.0 - r[0][0] + r[1][1] - r[2][2], 1.0 - r[0][0] - r[1][1] + r[2][2] };
    const double d[3] = { r[2][1] - r[1][2], r[0][2] - r[2][0], r[1][0] - r[0][1] };
    int          k    = 0;
    for (int i = 1; i < 4; i++) {
        k = t[i] > t[k] ? i : k;
    }
    const double root  = sqrt(t[k]);
    const double share = 0.5 / root;
    q[k]               = 0.5 * root;
    for (int i = 0; i < 4; i++) {
        if (i == k) {
            continue;
        }
        if (k == 0 || i == 0) {
            q[i] = share * d[k == 0 ? i - 1 : k - 1];
        } else {
            q[i] = share * (r[i - 1][k - 1] + r[k - 1][i - 1]);
        }
    }
}

/// Angular velocity of the angular momentum at this orientation.
DIG_BOTH static inline void dig_rigid_angular_velocity(const struct dig_rigid *const body,
                                                       const double q[4], double w_radps[3])
{
    double l[3];
    double w[3];
    dig_rigid_rotate_back(q, body->l_Nms, l);
    for (int r = 0; r < 3; r++) {
        w[r] = body->inverse_pkgm2[r][0] * l[0] + body->inverse_pkgm2[r][1] * l[1] +
               body->inverse_pkgm2[r][2] * l[2];
    }
    dig_rigid_rotate(q, w, w_radps);
}

/// q rotated by w over dt.
DIG_BOTH static inline void dig_rigid_integrate(const double q[4], const double w_radps[3],
                                                const double dt_s, double turned[4])
{
    const double speed =
        sqrt(w_radps[0] * w_radps[0] + w_radps[1] * w_radps[1] + w_radps[2] * w_radps[2]);
    const double half = 0.5 * dt_s * speed;
    // sin(half) / speed; its limit without rotation is half a step.
    const double s    = half > 1e-8 ? sin(half) / speed : 0.5 * dt_s;
    const double p[4] = { cos(half), s * w_radps[0], s * w_radps[1], s * w_radps[2] };
    const double r[4] = { p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3],
                          p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2],
                          p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1],
                          p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0] };
    const double n    = 1.0 / sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2] + r[3] * r[3]);
    for (int k = 0; k < 4; k++) {
        turned[k] = n * r[k];
    }
}

/// Kicks over kick_s, moves over dt_s. The torque is about the centre of mass.
DIG_BOTH static inline void dig_rigid_step(struct dig_rigid *const body, const double force_N[3],
                                           const double torque_Nm[3], const double gravity_mps2[3],
                                           const double kick_s, const double dt_s)
{
    for (int k = 0; k < 3; k++) {
        body->v_mps[k] += kick_s * (force_N[k] / body->mass_kg + gravity_mps2[k]);
        body->l_Nms[k] += kick_s * torque_Nm[k];
        body->x_m[k] += dt_s * body->v_mps[k];
    }
    double w[3];
    double half[4];
    double q[4];
    dig_rigid_angular_velocity(body, body->q, w);
    dig_rigid_integrate(body->q, w, 0.5 * dt_s, half);
    dig_rigid_angular_velocity(body, half, body->w_radps);
    dig_rigid_integrate(body->q, body->w_radps, dt_s, q);
    for (int k = 0; k < 4; k++) {
        body->q[k] = q[k];
    }
}

#endif // DIG_OFFLINE_DEM_LAW_RIGID_H

// The contact law between two grains, or a grain and a wall or plate: Hooke springs with a
// characteristic velocity, tangential history capped by Coulomb, EPSD2 rolling friction. This is
// the plain law; the others, and what they do to these constants, stand in law_general.h.
//
//            i o                n: unit vector from j to i
//               \  n            delta = reach - |d|: overlap, d = x_i - x_j (or the closest point)
//            ----x----          the contact point is ci below i and cj above j, on the line
//                 \             of centres
//                  o j
//
// Normal:     F_n = k_n delta - gamma_n v_n. Not limited at zero: damping may pull for the last
//             instants of a collision, as in the reference code.
// Tangential: xi += v_t dt, its normal part removed; F_t = -k_t xi - gamma_t v_t, and when
//             k_t |xi| > mu |F_n| the spring alone, shortened to mu |F_n| / k_t, without damping.
// Rolling:    M += k_r w_t dt with w_t the part of w_i - w_j that lies in the contact plane (spin
//             about n is free); |M| is cut to mu_r R* |F_n|. No viscous part (EPSD2).
//
// Sources: Di Renzo & Di Maio, Chem. Eng. Sci. 59 (2004) 525; Ai, Chen, Rotter & Ooi, Powder
// Technol. 206 (2011) 269 (EPSD, here with viscous damping 0); Iwata et al. for the values; the
// k_n with a characteristic velocity is the linear spring that stores at that velocity as much as
// Hertz's. Constants and the domain: docs/numerics/dem.md.

#ifndef DIG_OFFLINE_DEM_LAW_LAW_H
#define DIG_OFFLINE_DEM_LAW_LAW_H

#include "core/contact.h"
#include "core/scene.h"
#include "offline_dem/law/both.h"

#include <math.h>
#include <stdbool.h>

/// History of a contact while it lasts; zero when the contact begins.
struct dig_contact_history {
    double sx_m, sy_m, sz_m;    // tangential displacement xi
    double mx_Nm, my_Nm, mz_Nm; // rolling torque M on j (and -M on i)
};

/// Constants of the contacts between two grain types, or of one type with walls and plates.
struct dig_law {
    double reach_m;         // contact below this distance
    double lever_i_m;       // centre to contact point at zero overlap
    double lever_j_m;       // 0 for a wall
    double normal_Npm;      // k_n = k_t
    double damping_Nspm;    // gamma_n = gamma_t
    double rolling_Nmprad;  // k_r
    double friction;        // mu
    double rolling_lever_m; // mu_r R*
    bool   general;         // computed by dig_law_general(), not dig_law_step()

    // Read by law_general.h only. With Hertz's law the three springs are those at an overlap of 1 m
    // and scale with its square root, the two dampings with its fourth root.
    bool   hertz;
    double tangential_Npm;          // k_t
    double tangential_damping_Nspm; // gamma_t
    bool   epsd2, cdt;              // neither: no rolling friction
    double cohesion_Jpm3;           // pull per contact area
};

/// Constants of two materials in contact, and the laws between them, without the grains' sizes.
/// Zero laws: Hooke, EPSD2, no cohesion.
struct dig_law_material {
    double young_Pa, poisson; // of both bodies
    double restitution, characteristic_velocity_mps;
    double friction, rolling;

    enum dig_normal_law  normal_law;
    enum dig_rolling_law rolling_law;
    double               cohesion_Jpm3;
};

/// Relative state of two bodies in contact: d = x_i - x_j, velocities of the centres (of a wall or
/// plate: of its contact point) and rotations.
struct dig_kinematics {
    double dx_m, dy_m, dz_m;
    double vx_mps, vy_mps, vz_mps; // v_i - v_j
    double ix_radps, iy_radps, iz_radps;
    double jx_radps, jy_radps, jz_radps;
};

/// Force and torque of the contact on i; j gets the opposite force and its own torque.
struct dig_contact_force {
    double fx_N, fy_N, fz_N;
    double ix_Nm, iy_Nm, iz_Nm;
    double jx_Nm, jy_Nm, jz_Nm;
};

/// Constants for an effective radius and mass; the caller sets reach and levers.
static inline struct dig_law dig_law_make(const struct dig_law_material *const material,
                                          const double radius_m, const double mass_kg)
{
    const struct dig_material bodies = {
        .young_Pa                    = material->young_Pa,
        .poisson                     = material->poisson,
        .restitution                 = material->restitution,
        .characteristic_velocity_mps = material->characteristic_velocity_mps,
    };
    const struct dig_contact_springs springs =
        dig_contact_springs(&bodies, material->normal_law, radius_m, mass_kg);

    struct dig_law law = {
        .normal_Npm              = springs.normal_Npm,
        .damping_Nspm            = springs.damping_Nspm,
        .rolling_Nmprad          = springs.tangential_Npm * radius_m * radius_m,
        .friction                = material->friction,
        .rolling_lever_m         = material->rolling * radius_m,
        .hertz                   = material->normal_law == DIG_NORMAL_HERTZ,
        .tangential_Npm          = springs.tangential_Npm,
        .tangential_damping_Nspm = springs.tangential_damping_Nspm,
        .epsd2                   = material->rolling_law == DIG_ROLLING_EPSD2,
        .cdt                     = material->rolling_law == DIG_ROLLING_CDT,
        .cohesion_Jpm3           = material->cohesion_Jpm3,
    };
    law.general = law.hertz || !law.epsd2 || law.cohesion_Jpm3 > 0.0;
    return law;
}

/// Two grains: R* = ri rj / (ri + rj), m* likewise.
static inline struct dig_law dig_law_pair(const struct dig_law_material *const material,
                                          const double ri_m, const double rj_m, const double mi_kg,
                                          const double mj_kg)
{
    struct dig_law law =
        dig_law_make(material, ri_m * rj_m / (ri_m + rj_m), mi_kg * mj_kg / (mi_kg + mj_kg));
    law.reach_m   = ri_m + rj_m;
    law.lever_i_m = ri_m;
    law.lever_j_m = rj_m;
    return law;
}

/// A grain and a rigid surface: R* = r, m* = m.
static inline struct dig_law dig_law_wall(const struct dig_law_material *const material,
                                          const double r_m, const double m_kg)
{
    struct dig_law law = dig_law_make(material, r_m, m_kg);
    law.reach_m        = r_m;
    law.lever_i_m      = r_m;
    law.lever_j_m      = 0.0;
    return law;
}

/// Contact normal: the unit vector n from j to i, and the distance of the centres.
struct dig_contact_normal {
    double nx, ny, nz, d_m;
};

/// Trial state: springs advanced over the step, before friction caps them.
struct dig_trial {
    double normal_N;
    double vx_mps, vy_mps, vz_mps; // slip of the contact point
    double spring2_m2;             // |xi|^2
    double torque2_Nm2;            // |M|^2
};

/// Factors by which friction caps springs and damping; 1 where the contact does not slip or roll.
struct dig_caps {
    double spring, damping, torque;
};

// One contact over one step in four stages without branches, so that a loop over contacts
// vectorises. Each stage waits for the one before; with many contacts at one stage the processor
// fills that wait.
#define DIG_LAW_STAGE DIG_BOTH __attribute__((always_inline)) static inline

DIG_LAW_STAGE struct dig_contact_normal dig_law_normal(const double dx_m, const double dy_m,
                                                       const double dz_m)
{
    // The constant keeps a lane of padding from dividing by zero.
    const double d_m = sqrt(dx_m * dx_m + dy_m * dy_m + dz_m * dz_m + 1e-300);
    const double inv = 1.0 / d_m;
    return (struct dig_contact_normal){ dx_m * inv, dy_m * inv, dz_m * inv, d_m };
}

/// Advances the history by slip and rolling. Reads only the velocities of t.
DIG_LAW_STAGE struct dig_trial dig_law_trial(const struct dig_law law, const double dt_s,
                                             const struct dig_contact_normal   n,
                                             const struct dig_kinematics       t,
                                             struct dig_contact_history *const history)
{
    // Normal
    const double delta_m = law.reach_m - n.d_m;
    const double vn_mps  = t.vx_mps * n.nx + t.vy_mps * n.ny + t.vz_mps * n.nz;

    // Slip of the contact point
    const double ci_m = law.lever_i_m - 0.5 * delta_m;
    const double cj_m = law.lever_j_m > 0.0 ? law.lever_j_m - 0.5 * delta_m : 0.0;
    const double wx   = ci_m * t.ix_radps + cj_m * t.jx_radps;
    const double wy   = ci_m * t.iy_radps + cj_m * t.jy_radps;
    const double wz   = ci_m * t.iz_radps + cj_m * t.jz_radps;
    const double vx   = t.vx_mps - vn_mps * n.nx - (wy * n.nz - wz * n.ny);
    const double vy   = t.vy_mps - vn_mps * n.ny - (wz * n.nx - wx * n.nz);
    const double vz   = t.vz_mps - vn_mps * n.nz - (wx * n.ny - wy * n.nx);

    // Tangential spring
    double       sx = history->sx_m + vx * dt_s;
    double       sy = history->sy_m + vy * dt_s;
    double       sz = history->sz_m + vz * dt_s;
    const double sn = sx * n.nx + sy * n.ny + sz * n.nz;
    sx -= sn * n.nx;
    sy -= sn * n.ny;
    sz -= sn * n.nz;

    // Rolling spring
    double       rx = t.ix_radps - t.jx_radps;
    double       ry = t.iy_radps - t.jy_radps;
    double       rz = t.iz_radps - t.jz_radps;
    const double rn = rx * n.nx + ry * n.ny + rz * n.nz;
    const double kr = law.rolling_Nmprad * dt_s;
    rx              = history->mx_Nm + kr * (rx - rn * n.nx);
    ry              = history->my_Nm + kr * (ry - rn * n.ny);
    rz              = history->mz_Nm + kr * (rz - rn * n.nz);

    *history = (struct dig_contact_history){ sx, sy, sz, rx, ry, rz };
    return (struct dig_trial){
        .normal_N    = law.normal_Npm * delta_m - law.damping_Nspm * vn_mps,
        .vx_mps      = vx,
        .vy_mps      = vy,
        .vz_mps      = vz,
        .spring2_m2  = sx * sx + sy * sy + sz * sz,
        .torque2_Nm2 = rx * rx + ry * ry + rz * rz,
    };
}

/// True where dig_law_caps() may return less than 1, decided without a square root. Never false
/// where it does.
DIG_LAW_STAGE bool dig_law_may_cap(const struct dig_law law, const struct dig_trial trial)
{
    const double more     = 1.0 + 1e-12; // above the rounding of either side
    const double load_N   = fabs(trial.normal_N);
    const double grip_N   = law.friction * load_N;
    const double limit_Nm = law.rolling_lever_m * load_N;
    return (more * law.normal_Npm * law.normal_Npm * trial.spring2_m2 >= grip_N * grip_N) |
           (more * trial.torque2_Nm2 >= limit_Nm * limit_Nm);
}

/// Reads the normal force and the two squares of the trial.
DIG_LAW_STAGE struct dig_caps dig_law_caps(const struct dig_law law, const struct dig_trial trial)
{
    const double load_N    = fabs(trial.normal_N);
    const double spring_N  = law.normal_Npm * sqrt(trial.spring2_m2);
    const double grip_N    = law.friction * load_N;
    const bool   slides    = spring_N > grip_N;
    const double torque_Nm = sqrt(trial.torque2_Nm2);
    const double limit_Nm  = law.rolling_lever_m * load_N;
    return (struct dig_caps){
        .spring  = slides ? grip_N / spring_N : 1.0,
        .damping = slides ? 0.0 : 1.0,
        .torque  = torque_Nm > limit_Nm ? limit_Nm / torque_Nm : 1.0,
    };
}

/// Reads the normal force and the slip of the trial. Bodies apart get zeros, and *history is
/// cleared.
DIG_LAW_STAGE struct dig_contact_force dig_law_force(const struct dig_law              law,
                                                     const struct dig_contact_normal   n,
                                                     const struct dig_trial            trial,
                                                     const struct dig_caps             caps,
                                                     struct dig_contact_history *const history)
{
    const bool   touching = n.d_m < law.reach_m;
    const double delta_m  = law.reach_m - n.d_m;
    const double ci_m     = law.lever_i_m - 0.5 * delta_m;
    const double cj_m     = law.lever_j_m > 0.0 ? law.lever_j_m - 0.5 * delta_m : 0.0;

    const double sx = history->sx_m * caps.spring;
    const double sy = history->sy_m * caps.spring;
    const double sz = history->sz_m * caps.spring;
    const double rx = history->mx_Nm * caps.torque;
    const double ry = history->my_Nm * caps.torque;
    const double rz = history->mz_Nm * caps.torque;
    const double tx = -law.normal_Npm * sx - law.damping_Nspm * (trial.vx_mps * caps.damping);
    const double ty = -law.normal_Npm * sy - law.damping_Nspm * (trial.vy_mps * caps.damping);
    const double tz = -law.normal_Npm * sz - law.damping_Nspm * (trial.vz_mps * caps.damping);
    const double ax = n.ny * tz - n.nz * ty;
    const double ay = n.nz * tx - n.nx * tz;
    const double az = n.nx * ty - n.ny * tx;

    history->sx_m  = touching ? sx : 0.0;
    history->sy_m  = touching ? sy : 0.0;
    history->sz_m  = touching ? sz : 0.0;
    history->mx_Nm = touching ? rx : 0.0;
    history->my_Nm = touching ? ry : 0.0;
    history->mz_Nm = touching ? rz : 0.0;
    return (struct dig_contact_force){
        .fx_N  = touching ? trial.normal_N * n.nx + tx : 0.0,
        .fy_N  = touching ? trial.normal_N * n.ny + ty : 0.0,
        .fz_N  = touching ? trial.normal_N * n.nz + tz : 0.0,
        .ix_Nm = touching ? -ci_m * ax - rx : 0.0,
        .iy_Nm = touching ? -ci_m * ay - ry : 0.0,
        .iz_Nm = touching ? -ci_m * az - rz : 0.0,
        .jx_Nm = touching ? -cj_m * ax + rx : 0.0,
        .jy_Nm = touching ? -cj_m * ay + ry : 0.0,
        .jz_Nm = touching ? -cj_m * az + rz : 0.0,
    };
}

/// One contact over one step: all stages. Bodies apart get zeros, and *history is cleared.
DIG_LAW_STAGE struct dig_contact_force dig_law_step(const struct dig_law law, const double dt_s,
                                                    const struct dig_kinematics       t,
                                                    struct dig_contact_history *const history)
{
    const struct dig_contact_normal n     = dig_law_normal(t.dx_m, t.dy_m, t.dz_m);
    const struct dig_trial          trial = dig_law_trial(law, dt_s, n, t, history);
    return dig_law_force(law, n, trial, dig_law_caps(law, trial), history);
}

#endif // DIG_OFFLINE_DEM_LAW_LAW_H

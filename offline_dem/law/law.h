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

/// Relative state of two bodies in contact: d = x_i - x_j, velocities of the centres (of a wall or
/// plate: of its contact point) and rotations.
struct dig_kinematics {
    double dx_m, dy_m, dz_m;
    double vx_mps, vy_mps, vz_mps; // v_i - v_j
    double ix_radps, iy_radps, iz_radps;
    double jx_radps, jy_radps, jz_radps;
};

/// The constants that the plain law reads, in single precision.
struct dig_law_single {
    float reach_m, lever_i_m, lever_j_m;
    float normal_Npm, damping_Nspm, rolling_Nmprad;
    float friction, rolling_lever_m;
};

static inline struct dig_law_single dig_law_to_single(const struct dig_law *const law)
{
    return (struct dig_law_single){
        .reach_m         = (float)law->reach_m,
        .lever_i_m       = (float)law->lever_i_m,
        .lever_j_m       = (float)law->lever_j_m,
        .normal_Npm      = (float)law->normal_Npm,
        .damping_Nspm    = (float)law->damping_Nspm,
        .rolling_Nmprad  = (float)law->rolling_Nmprad,
        .friction        = (float)law->friction,
        .rolling_lever_m = (float)law->rolling_lever_m,
    };
}

// A function of one contact, without branches, so that a loop over contacts vectorises.
#define DIG_LAW_STAGE DIG_BOTH __attribute__((always_inline)) static inline

// The law itself stands in law_step.h, and is compiled for both precisions.
#define DIG_REAL         double
#define DIG_LAW_NAME(x)  x
#define DIG_REAL_SQRT(x) sqrt(x)
#define DIG_REAL_FABS(x) fabs(x)
#include "offline_dem/law/law_step.h"
#undef DIG_REAL
#undef DIG_LAW_NAME
#undef DIG_REAL_SQRT
#undef DIG_REAL_FABS

#define DIG_REAL         float
#define DIG_LAW_NAME(x)  x##_single
#define DIG_REAL_SQRT(x) sqrtf(x)
#define DIG_REAL_FABS(x) fabsf(x)
#include "offline_dem/law/law_step.h"
#undef DIG_REAL
#undef DIG_LAW_NAME
#undef DIG_REAL_SQRT
#undef DIG_REAL_FABS

/// With the sign -1: the history as the other grain has it.
DIG_BOTH static inline struct dig_contact_history
dig_contact_history_times(const struct dig_contact_history h, const double sign)
{
    const struct dig_contact_history times = { sign * h.sx_m,  sign * h.sy_m,  sign * h.sz_m,
                                               sign * h.mx_Nm, sign * h.my_Nm, sign * h.mz_Nm };
    return times;
}

DIG_LAW_STAGE struct dig_contact_normal dig_law_normal(const double reach_m, const double dx_m,
                                                       const double dy_m, const double dz_m)
{
    // The constant keeps a lane of padding from dividing by zero.
    const double d_m = sqrt(dx_m * dx_m + dy_m * dy_m + dz_m * dz_m + 1e-300);
    const double inv = 1.0 / d_m;
    return (struct dig_contact_normal){ dx_m * inv, dy_m * inv, dz_m * inv, reach_m - d_m };
}

/// The same in single precision, but for the overlap: a small difference of two distances, it is
/// (reach^2 - d^2) / (reach + d), whose numerator is formed in double precision. So it errs by
/// parts of itself, not of the distance. One quotient serves the normal and the overlap.
DIG_LAW_STAGE struct dig_contact_normal_single
dig_law_normal_single(const double reach_m, const double dx_m, const double dy_m, const double dz_m)
{
    const float inside_m2 = (float)(reach_m * reach_m - (dx_m * dx_m + dy_m * dy_m + dz_m * dz_m));
    const float x_m       = (float)dx_m;
    const float y_m       = (float)dy_m;
    const float z_m       = (float)dz_m;
    const float d_m       = sqrtf(x_m * x_m + y_m * y_m + z_m * z_m + 1e-30F);
    const float sum_m     = (float)reach_m + d_m;
    const float inverse   = 1.0F / (d_m * sum_m);
    const float inv       = inverse * sum_m;
    return (struct dig_contact_normal_single){ x_m * inv, y_m * inv, z_m * inv,
                                               inside_m2 * (d_m * inverse) };
}

/// One contact over one step. Bodies apart get zeros, and *history is cleared.
DIG_LAW_STAGE struct dig_contact_force dig_law_step(const struct dig_law law, const double dt_s,
                                                    const struct dig_kinematics       t,
                                                    struct dig_contact_history *const history)
{
    const struct dig_contact_normal n = dig_law_normal(law.reach_m, t.dx_m, t.dy_m, t.dz_m);
    const struct dig_contact_motion m = { t.vx_mps,   t.vy_mps,   t.vz_mps,
                                          t.ix_radps, t.iy_radps, t.iz_radps,
                                          t.jx_radps, t.jy_radps, t.jz_radps };
    return dig_law_force(law, dt_s, n, m, history);
}

#endif // DIG_OFFLINE_DEM_LAW_LAW_H

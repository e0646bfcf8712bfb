// Contact laws beyond the plain one of law.h, each chosen by fields of struct dig_law; n, delta,
// the slip v_t and the tangential spring xi are the same as there.
//
// Hertz-Mindlin  k_n = 4/3 Y* sqrt(R* delta),  gamma_n = 2 sqrt(5/6) b sqrt(S_n m*),
//                k_t = 8 G* sqrt(R* delta),    gamma_t = 2 sqrt(5/6) b sqrt(k_t m*),
//                S_n = 2 Y* sqrt(R* delta), b = -ln e / sqrt(ln^2 e + pi^2),
//                Y* = E / 2 (1 - nu^2), G* = E / 4 (2 - nu)(1 + nu) for like bodies.
// EPSD2          as in law.h, with k_r = k_t R*^2 of the present overlap.
// CDT            M = mu_r R* k_n delta w_t / |w|, w = w_i - w_j and w_t its part in the contact
//                plane: as long as it turns, a constant torque against it.
// SJKR           F_n -= c A, A the area of the circle in which the spheres intersect (a sphere and
//                a plane: the circle cut out of the plane). Friction and rolling friction are
//                capped by the F_n without this pull, and so hold a contact that is only glued.
//
// Sources: Di Renzo & Di Maio, Chem. Eng. Sci. 59 (2004) 525 (Hertz-Mindlin); Tsuji, Tanaka &
// Ishida, Powder Technol. 71 (1992) 239 (damping ~ delta^1/4); Zhou et al., Physica A 269 (1999)
// 536 and Ai, Chen, Rotter & Ooi, Powder Technol. 206 (2011) 269, their model A (CDT); LIGGGHTS'
// documentation of `model hertz`, `rolling_friction cdt` and `cohesion sjkr`, whose choices of
// direction, area and cap these are.

#ifndef DIG_OFFLINE_DEM_LAW_LAW_GENERAL_H
#define DIG_OFFLINE_DEM_LAW_LAW_GENERAL_H

#include "core/units.h"
#include "offline_dem/law/law.h"

/// Pull of cohesion at the distance d_m.
DIG_LAW_STAGE double dig_law_pull_N(const struct dig_law law, const double d_m)
{
    // Distance of the circle's plane from the centre of i.
    const double ri2_m2  = law.lever_i_m * law.lever_i_m;
    const double rj2_m2  = law.lever_j_m * law.lever_j_m;
    const double plane_m = law.lever_j_m > 0.0 ? 0.5 * (d_m * d_m + ri2_m2 - rj2_m2) / d_m : d_m;
    return law.cohesion_Jpm3 * DIG_PI * (law.lever_i_m - plane_m) * (law.lever_i_m + plane_m);
}

/// As dig_law_step(), for laws whose `general` is set. Costs a fifth more.
DIG_LAW_STAGE struct dig_contact_force dig_law_general(const struct dig_law law, const double dt_s,
                                                       const struct dig_kinematics       t,
                                                       struct dig_contact_history *const history)
{
    // The constants keep a lane of padding, and a grain that does not rotate, from dividing by
    // zero.
    const double d2_m2    = t.dx_m * t.dx_m + t.dy_m * t.dy_m + t.dz_m * t.dz_m + 1e-300;
    const double d_m      = sqrt(d2_m2);
    const bool   touching = d_m < law.reach_m;
    const double inv      = 1.0 / d_m;
    const double nx       = t.dx_m * inv;
    const double ny       = t.dy_m * inv;
    const double nz       = t.dz_m * inv;

    // Choices are factors: the loop over lanes has no branches.
    const double hertz = law.hertz ? 1.0 : 0.0;
    const double epsd2 = law.epsd2 ? 1.0 : 0.0;
    const double cdt   = law.cdt ? 1.0 : 0.0;

    // Springs and dampings of this overlap
    const double delta_m    = touching ? law.reach_m - d_m : 0.0;
    const double grown      = hertz * sqrt(delta_m) + (1.0 - hertz);
    const double half_grown = sqrt(grown);
    const double kn_Npm     = law.normal_Npm * grown;
    const double kt_Npm     = law.tangential_Npm * grown;
    const double gn_Nspm    = law.damping_Nspm * half_grown;
    const double gt_Nspm    = law.tangential_damping_Nspm * half_grown;

    // Normal
    const double vn_mps   = t.vx_mps * nx + t.vy_mps * ny + t.vz_mps * nz;
    const double normal_N = kn_Npm * delta_m - gn_Nspm * vn_mps;
    const double load_N   = fabs(normal_N);
    const double total_N  = normal_N - dig_law_pull_N(law, d_m);

    // Slip of the contact point
    const double ci_m = law.lever_i_m - 0.5 * delta_m;
    const double cj_m = law.lever_j_m > 0.0 ? law.lever_j_m - 0.5 * delta_m : 0.0;
    const double wx   = ci_m * t.ix_radps + cj_m * t.jx_radps;
    const double wy   = ci_m * t.iy_radps + cj_m * t.jy_radps;
    const double wz   = ci_m * t.iz_radps + cj_m * t.jz_radps;
    const double vx   = t.vx_mps - vn_mps * nx - (wy * nz - wz * ny);
    const double vy   = t.vy_mps - vn_mps * ny - (wz * nx - wx * nz);
    const double vz   = t.vz_mps - vn_mps * nz - (wx * ny - wy * nx);

    // Tangential spring, capped
    double       sx = history->sx_m + vx * dt_s;
    double       sy = history->sy_m + vy * dt_s;
    double       sz = history->sz_m + vz * dt_s;
    const double sn = sx * nx + sy * ny + sz * nz;
    sx -= sn * nx;
    sy -= sn * ny;
    sz -= sn * nz;
    const double spring_N = kt_Npm * sqrt(sx * sx + sy * sy + sz * sz);
    const double grip_N   = law.friction * load_N;
    const bool   slides   = spring_N > grip_N;
    const double shorten  = slides ? grip_N / spring_N : 1.0;
    const double damping  = slides ? 0.0 : gt_Nspm;
    sx *= shorten;
    sy *= shorten;
    sz *= shorten;
    const double tx = -kt_Npm * sx - damping * vx;
    const double ty = -kt_Npm * sy - damping * vy;
    const double tz = -kt_Npm * sz - damping * vz;

    // Rolling: a capped spring, or a torque of constant size against the rotation
    const double ox       = t.ix_radps - t.jx_radps;
    const double oy       = t.iy_radps - t.jy_radps;
    const double oz       = t.iz_radps - t.jz_radps;
    const double on       = ox * nx + oy * ny + oz * nz;
    const double turn     = sqrt(ox * ox + oy * oy + oz * oz + 1e-300);
    const double kr       = law.rolling_Nmprad * grown * dt_s;
    const double constant = law.rolling_lever_m * kn_Npm * delta_m / turn;
    const double gain     = epsd2 * kr + cdt * constant;
    double       rx       = epsd2 * history->mx_Nm + gain * (ox - on * nx);
    double       ry       = epsd2 * history->my_Nm + gain * (oy - on * ny);
    double       rz       = epsd2 * history->mz_Nm + gain * (oz - on * nz);
    const double torque   = sqrt(rx * rx + ry * ry + rz * rz);
    const double limit_Nm = law.rolling_lever_m * load_N;
    const double over     = torque > limit_Nm ? limit_Nm / torque : 1.0;
    const double cut      = epsd2 * over + (1.0 - epsd2);
    rx *= cut;
    ry *= cut;
    rz *= cut;

    history->sx_m  = touching ? sx : 0.0;
    history->sy_m  = touching ? sy : 0.0;
    history->sz_m  = touching ? sz : 0.0;
    history->mx_Nm = touching ? rx : 0.0;
    history->my_Nm = touching ? ry : 0.0;
    history->mz_Nm = touching ? rz : 0.0;

    const double ax = ny * tz - nz * ty;
    const double ay = nz * tx - nx * tz;
    const double az = nx * ty - ny * tx;
    return (struct dig_contact_force){
        .fx_N  = touching ? total_N * nx + tx : 0.0,
        .fy_N  = touching ? total_N * ny + ty : 0.0,
        .fz_N  = touching ? total_N * nz + tz : 0.0,
        .ix_Nm = touching ? -ci_m * ax - rx : 0.0,
        .iy_Nm = touching ? -ci_m * ay - ry : 0.0,
        .iz_Nm = touching ? -ci_m * az - rz : 0.0,
        .jx_Nm = touching ? -cj_m * ax + rx : 0.0,
        .jy_Nm = touching ? -cj_m * ay + ry : 0.0,
        .jz_Nm = touching ? -cj_m * az + rz : 0.0,
    };
}

/// The plain law or a general one, as law->general says.
DIG_BOTH static inline struct dig_contact_force
dig_law_apply(const struct dig_law *const law, const double dt_s,
              const struct dig_kinematics *const kinematics,
              struct dig_contact_history *const  history)
{
    return law->general ? dig_law_general(*law, dt_s, *kinematics, history)
                        : dig_law_step(*law, dt_s, *kinematics, history);
}

#endif // DIG_OFFLINE_DEM_LAW_LAW_GENERAL_H

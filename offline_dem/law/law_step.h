// The plain law of law.h on one contact, in the precision of DIG_REAL. Included by law.h alone,
// once for each precision: DIG_LAW_NAME() makes the names of this one. No include guard.

/// History of a contact while it lasts; zero when the contact begins.
struct DIG_LAW_NAME(dig_contact_history) {
    DIG_REAL sx_m, sy_m, sz_m;    // tangential displacement xi
    DIG_REAL mx_Nm, my_Nm, mz_Nm; // rolling torque M on j (and -M on i)
};

/// Force and torque of the contact on i; j gets the opposite force and its own torque.
struct DIG_LAW_NAME(dig_contact_force) {
    DIG_REAL fx_N, fy_N, fz_N;
    DIG_REAL ix_Nm, iy_Nm, iz_Nm;
    DIG_REAL jx_Nm, jy_Nm, jz_Nm;
};

/// Contact normal: the unit vector n from j to i, and the overlap.
struct DIG_LAW_NAME(dig_contact_normal) {
    DIG_REAL nx, ny, nz, delta_m;
};

/// Velocities of struct dig_kinematics.
struct DIG_LAW_NAME(dig_contact_motion) {
    DIG_REAL vx_mps, vy_mps, vz_mps;
    DIG_REAL ix_radps, iy_radps, iz_radps;
    DIG_REAL jx_radps, jy_radps, jz_radps;
};

/// One contact over one step. Bodies apart get zeros, and *history is cleared.
DIG_LAW_STAGE struct DIG_LAW_NAME(dig_contact_force)
    DIG_LAW_NAME(dig_law_force)(const struct DIG_LAW_NAME(dig_law) law, const DIG_REAL dt_s,
                                const struct DIG_LAW_NAME(dig_contact_normal) n,
                                const struct DIG_LAW_NAME(dig_contact_motion) t,
                                struct DIG_LAW_NAME(dig_contact_history) *const history)
{
    const DIG_REAL zero     = 0;
    const DIG_REAL one      = 1;
    const DIG_REAL half     = (DIG_REAL)0.5;
    const bool     touching = n.delta_m > zero;

    // Normal
    const DIG_REAL vn_mps   = t.vx_mps * n.nx + t.vy_mps * n.ny + t.vz_mps * n.nz;
    const DIG_REAL normal_N = law.normal_Npm * n.delta_m - law.damping_Nspm * vn_mps;
    const DIG_REAL load_N   = DIG_REAL_FABS(normal_N);

    // Slip of the contact point
    const DIG_REAL ci_m = law.lever_i_m - half * n.delta_m;
    const DIG_REAL cj_m = law.lever_j_m > zero ? law.lever_j_m - half * n.delta_m : zero;
    const DIG_REAL wx   = ci_m * t.ix_radps + cj_m * t.jx_radps;
    const DIG_REAL wy   = ci_m * t.iy_radps + cj_m * t.jy_radps;
    const DIG_REAL wz   = ci_m * t.iz_radps + cj_m * t.jz_radps;
    const DIG_REAL vx   = t.vx_mps - vn_mps * n.nx - (wy * n.nz - wz * n.ny);
    const DIG_REAL vy   = t.vy_mps - vn_mps * n.ny - (wz * n.nx - wx * n.nz);
    const DIG_REAL vz   = t.vz_mps - vn_mps * n.nz - (wx * n.ny - wy * n.nx);

    // Tangential spring
    DIG_REAL       sx = history->sx_m + vx * dt_s;
    DIG_REAL       sy = history->sy_m + vy * dt_s;
    DIG_REAL       sz = history->sz_m + vz * dt_s;
    const DIG_REAL sn = sx * n.nx + sy * n.ny + sz * n.nz;
    sx -= sn * n.nx;
    sy -= sn * n.ny;
    sz -= sn * n.nz;

    // Rolling spring
    DIG_REAL       rx = t.ix_radps - t.jx_radps;
    DIG_REAL       ry = t.iy_radps - t.jy_radps;
    DIG_REAL       rz = t.iz_radps - t.jz_radps;
    const DIG_REAL rn = rx * n.nx + ry * n.ny + rz * n.nz;
    const DIG_REAL kr = law.rolling_Nmprad * dt_s;
    rx                = history->mx_Nm + kr * (rx - rn * n.nx);
    ry                = history->my_Nm + kr * (ry - rn * n.ny);
    rz                = history->mz_Nm + kr * (rz - rn * n.nz);

    // Friction caps both
    const DIG_REAL spring_N  = law.normal_Npm * DIG_REAL_SQRT(sx * sx + sy * sy + sz * sz);
    const DIG_REAL grip_N    = law.friction * load_N;
    const bool     slides    = spring_N > grip_N;
    const DIG_REAL shorten   = slides ? grip_N / spring_N : one;
    const DIG_REAL damping   = slides ? zero : one;
    const DIG_REAL torque_Nm = DIG_REAL_SQRT(rx * rx + ry * ry + rz * rz);
    const DIG_REAL limit_Nm  = law.rolling_lever_m * load_N;
    const DIG_REAL cut       = torque_Nm > limit_Nm ? limit_Nm / torque_Nm : one;
    sx *= shorten;
    sy *= shorten;
    sz *= shorten;
    rx *= cut;
    ry *= cut;
    rz *= cut;

    const DIG_REAL tx = -law.normal_Npm * sx - law.damping_Nspm * (vx * damping);
    const DIG_REAL ty = -law.normal_Npm * sy - law.damping_Nspm * (vy * damping);
    const DIG_REAL tz = -law.normal_Npm * sz - law.damping_Nspm * (vz * damping);
    const DIG_REAL ax = n.ny * tz - n.nz * ty;
    const DIG_REAL ay = n.nz * tx - n.nx * tz;
    const DIG_REAL az = n.nx * ty - n.ny * tx;

    history->sx_m  = touching ? sx : zero;
    history->sy_m  = touching ? sy : zero;
    history->sz_m  = touching ? sz : zero;
    history->mx_Nm = touching ? rx : zero;
    history->my_Nm = touching ? ry : zero;
    history->mz_Nm = touching ? rz : zero;
    return (struct DIG_LAW_NAME(dig_contact_force)){
        .fx_N  = touching ? normal_N * n.nx + tx : zero,
        .fy_N  = touching ? normal_N * n.ny + ty : zero,
        .fz_N  = touching ? normal_N * n.nz + tz : zero,
        .ix_Nm = touching ? -ci_m * ax - rx : zero,
        .iy_Nm = touching ? -ci_m * ay - ry : zero,
        .iz_Nm = touching ? -ci_m * az - rz : zero,
        .jx_Nm = touching ? -cj_m * ax + rx : zero,
        .jy_Nm = touching ? -cj_m * ay + ry : zero,
        .jz_Nm = touching ? -cj_m * az + rz : zero,
    };
}

#include "tools/rig/motion/state.h"

#include "core/units.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>

static const double lever_reserve = 0.1;

static void take_smaller(struct dig_rig_margin *const nearest,
                         const struct dig_rig_margin  candidate)
{
    // Negated so that a NaN share is kept and refused later.
    if (!(candidate.share >= nearest->share)) {
        *nearest = candidate;
    }
}

static struct dig_rig_margin in_range(const enum dig_rig_limit limit, const enum dig_joint joint,
                                      const double value, const double low, const double high)
{
    const bool at_low = value - low < high - value;
    return (struct dig_rig_margin){
        .share = (at_low ? value - low : high - value) / (high - low),
        .limit = limit,
        .joint = joint,
        .value = value,
        .bound = at_low ? low : high,
    };
}

static enum dig_status take_linkage_margins(const struct dig_machine *const machine,
                                            const enum dig_joint joint, const double angle_rad,
                                            struct dig_rig_margin *const nearest)
{
    const struct dig_link *const     link     = &machine->link[joint];
    const struct dig_cylinder *const cylinder = &machine->cylinder[joint];
    double                           length_m;
    double                           lever_m;
    enum dig_status status = dig_rig_cylinder_m(machine, joint, angle_rad, &length_m);
    if (status == DIG_OK) {
        status = dig_rig_lever_m(machine, joint, angle_rad, &lever_m);
    }
    if (status != DIG_OK) {
        return status;
    }
    const double mean_m =
        (cylinder->max_length_m - cylinder->min_length_m) / (link->max_rad - link->min_rad);
    take_smaller(nearest,
                 in_range(DIG_RIG_LIMIT_JOINT, joint, angle_rad, link->min_rad, link->max_rad));
    take_smaller(nearest, in_range(DIG_RIG_LIMIT_STROKE, joint, length_m, cylinder->min_length_m,
                                   cylinder->max_length_m));
    take_smaller(nearest, (struct dig_rig_margin){
                              .share = fabs(lever_m) / mean_m - lever_reserve,
                              .limit = DIG_RIG_LIMIT_LEVER,
                              .joint = joint,
                              .value = fabs(lever_m),
                              .bound = lever_reserve * mean_m,
                          });
    return DIG_OK;
}

static void take_pressure_margins(const struct dig_machine *const       machine,
                                  const struct dig_rig_pressures *const pressures,
                                  struct dig_rig_margin *const          nearest)
{
    for (int j = 0; j < DIG_JOINTS; j++) {
        const bool                  head   = pressures->head_Pa[j] > pressures->rod_Pa[j];
        const double                Pa     = head ? pressures->head_Pa[j] : pressures->rod_Pa[j];
        const double                bound  = machine->cylinder[j].relief_Pa;
        const struct dig_rig_margin margin = {
            .share = 1.0 - Pa / bound,
            .limit = DIG_RIG_LIMIT_RELIEF,
            .joint = (enum dig_joint)j,
            .value = Pa,
            .bound = bound,
            .end   = head ? "head" : "rod",
        };
        take_smaller(nearest, margin);
    }
}

struct load {
    double X_m, Z_m, FX_N, FZ_N, M_Nm;
};

// Moment of one load about a tipping edge on the ground, counter-clockwise.
static double about_Nm(const struct load *const load, const double edge_X_m,
                       const double ground_Z_m)
{
    return (load->X_m - edge_X_m) * load->FZ_N - (load->Z_m - ground_Z_m) * load->FX_N + load->M_Nm;
}

// The ground can only push: the reaction must point up, and lie between the tracks' ends.
static void
look_at_ground(const struct dig_machine *const machine, const struct dig_rig_joints *const joints,
               const struct dig_rig_pose *const pose, const struct dig_rig_motion *const motion,
               const struct dig_rig_wrench *const soil, struct dig_rig_margin *const nearest)
{
    struct load loads[DIG_JOINTS + 2] = {
        { machine->weight_X_m, 0.0, 0.0, -machine->weight_N, 0.0 },
        { pose->X_m, pose->Z_m, soil->FX_N, soil->FZ_N, soil->M_Nm },
    };
    const struct dig_rig_front front    = dig_rig_front_at(machine, joints);
    double                     weight_N = machine->weight_N;
    for (int j = 0; j < DIG_JOINTS; j++) {
        const struct dig_link *const link    = &machine->link[j];
        const struct dig_vec2        com     = front.com_m[j];
        const double                 mass_kg = link->mass_kg;
        loads[2 + j]                         = (struct load){
                                    .X_m  = com.x,
                                    .Z_m  = com.y,
                                    .FX_N = -mass_kg * motion->com_mps2[j].x,
                                    .FZ_N = -mass_kg * (DIG_RIG_GRAVITY_mps2 + motion->com_mps2[j].y),
                                    .M_Nm = -link->inertia_kgm2 * motion->turn_radps2[j],
        };
        weight_N += mass_kg * DIG_RIG_GRAVITY_mps2;
    }

    const double ground_Z_m = -machine->boom_foot_Z_m;
    double       down_N     = 0.0;
    double       front_Nm   = 0.0; // > 0 holds the rear down
    double       rear_Nm    = 0.0; // < 0 holds the front down
    for (size_t i = 0; i < sizeof loads / sizeof loads[0]; i++) {
        down_N -= loads[i].FZ_N;
        front_Nm += about_Nm(&loads[i], machine->tip_front_X_m, ground_Z_m);
        rear_Nm += about_Nm(&loads[i], machine->tip_rear_X_m, ground_Z_m);
    }
    const double hold_front_Nm = machine->weight_N * (machine->tip_front_X_m - machine->weight_X_m);
    const double hold_rear_Nm  = machine->weight_N * (machine->weight_X_m - machine->tip_rear_X_m);

    take_smaller(nearest, (struct dig_rig_margin){
                              .share = down_N / weight_N,
                              .limit = DIG_RIG_LIMIT_LIFT,
                              .value = weight_N - down_N,
                              .bound = weight_N,
                          });
    // Off the ground altogether there is no edge left to speak of.
    if (!(down_N > 0.0)) {
        return;
    }
    take_smaller(nearest, (struct dig_rig_margin){
                              .share = front_Nm / hold_front_Nm,
                              .limit = DIG_RIG_LIMIT_TIP,
                              .value = hold_front_Nm - front_Nm,
                              .bound = hold_front_Nm,
                              .end   = "front",
                          });
    take_smaller(nearest, (struct dig_rig_margin){
                              .share = -rear_Nm / hold_rear_Nm,
                              .limit = DIG_RIG_LIMIT_TIP,
                              .value = hold_rear_Nm + rear_Nm,
                              .bound = hold_rear_Nm,
                              .end   = "rear",
                          });
}

static void take_load_margins(const struct dig_force_sensor *const sensor,
                              const struct dig_rig_load *const     load,
                              struct dig_rig_margin *const         nearest)
{
    const struct {
        const char *name;
        double      value, limit;
    } axis[] = {
        { "Fx", load->Fx_N, sensor->limit_N },
        { "Fz", load->Fz_N, sensor->limit_N },
        { "My", load->My_Nm, sensor->limit_Nm },
    };
    for (size_t i = 0; i < sizeof axis / sizeof axis[0]; i++) {
        take_smaller(nearest, (struct dig_rig_margin){
                                  .share = 1.0 - fabs(axis[i].value) / axis[i].limit,
                                  .limit = DIG_RIG_LIMIT_SENSOR,
                                  .value = axis[i].value,
                                  .bound = axis[i].limit,
                                  .end   = axis[i].name,
                              });
    }
}

enum dig_status dig_rig_state_solve(const struct dig_machine *const    machine,
                                    const struct dig_rig_pose *const   pose,
                                    const struct dig_rig_motion *const motion,
                                    const struct dig_rig_wrench *const soil,
                                    struct dig_rig_state *const        state)
{
    assert(machine != NULL && state != NULL);

    struct dig_rig_state result = { .nearest = { .share = INFINITY } };
    if (machine->sensor.fitted) {
        result.load = dig_rig_gauge_read(machine, pose, motion, soil);
        take_load_margins(&machine->sensor, &result.load, &result.nearest);
        *state = result;
        return DIG_OK;
    }
    enum dig_status status = dig_rig_inverse(machine, pose, &result.joints);
    for (int j = 0; j < DIG_JOINTS && status == DIG_OK; j++) {
        status =
            take_linkage_margins(machine, (enum dig_joint)j, result.joints.rad[j], &result.nearest);
    }
    result.mechanical = result.nearest;

    struct dig_rig_pushes pushes;
    if (status == DIG_OK) {
        status = dig_rig_work_solve(machine, &result.joints, motion, soil, &pushes);
    }
    if (status != DIG_OK) {
        return status;
    }
    dig_rig_work_pressures(machine, &pushes, &result.pressures);
    take_pressure_margins(machine, &result.pressures, &result.nearest);
    look_at_ground(machine, &result.joints, pose, motion, soil, &result.nearest);
    *state = result;
    return DIG_OK;
}

const char *dig_rig_margin_text(const struct dig_rig_margin *const margin, const size_t size,
                                char text[])
{
    const char *const joint = dig_joint_name(margin->joint);
    const char *const unit =
        margin->limit == DIG_RIG_LIMIT_SENSOR && margin->end[0] == 'M' ? "Nm" : "N";
    switch (margin->limit) {
    case DIG_RIG_LIMIT_JOINT:
        (void)snprintf(text, size, "%s joint: %.1f deg, limit %.1f deg", joint,
                       margin->value / DIG_RAD_PER_DEG, margin->bound / DIG_RAD_PER_DEG);
        break;
    case DIG_RIG_LIMIT_STROKE:
        (void)snprintf(text, size, "%s cylinder: %.3f m long, limit %.3f m", joint, margin->value,
                       margin->bound);
        break;
    case DIG_RIG_LIMIT_LEVER:
        (void)snprintf(text, size, "%s cylinder: leverage %.3f m, limit %.3f m", joint,
                       margin->value, margin->bound);
        break;
    case DIG_RIG_LIMIT_RELIEF:
        (void)snprintf(text, size, "%s cylinder: %.1f MPa in the %s side, relief %.1f MPa", joint,
                       1e-6 * margin->value, margin->end, 1e-6 * margin->bound);
        break;
    case DIG_RIG_LIMIT_LIFT:
        (void)snprintf(text, size, "machine lifted: soil pushes up %.1f kN, all weighs %.1f kN",
                       1e-3 * margin->value, 1e-3 * margin->bound);
        break;
    case DIG_RIG_LIMIT_TIP:
        (void)snprintf(text, size,
                       "machine tipped over its %s edge: %.1f kNm, its weight holds %.1f kNm",
                       margin->end, 1e-3 * margin->value, 1e-3 * margin->bound);
        break;
    case DIG_RIG_LIMIT_SENSOR:
        (void)snprintf(text, size, "force sensor: %s of %.3g %s, limit %g %s", margin->end,
                       margin->value, unit, margin->bound, unit);
        break;
    }
    return text;
}

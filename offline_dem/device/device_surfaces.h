// Walls, tool and rocks at one grain in one step of a device.

#ifndef DIG_OFFLINE_DEM_DEVICE_DEVICE_SURFACES_H
#define DIG_OFFLINE_DEM_DEVICE_DEVICE_SURFACES_H

#include "offline_dem/device/device_pair.h"
#include "offline_dem/shapes/plate_contacts.h"

#include <math.h>

/// No contact beyond this factor of the reach, however the law rounds.
#define DIG_DEVICE_FAR 1.001

/// A grain and its surface contacts during the step.
struct dig_device_contacts {
    const struct dig_device_view *view;
    const struct dig_device_step *step;
    uint32_t                      i;
    struct dig_motion             m;
    struct dig_load               load;
    uint64_t                      surface_mask;
};

DIG_BOTH static inline struct dig_contact_history *
dig_device_surface_history(const struct dig_device_contacts *const grain, const uint32_t surface)
{
    return &grain->view->surface_history[(size_t)surface * grain->view->n + grain->i];
}

DIG_BOTH static inline uint32_t dig_device_plate(const struct dig_device_contacts *const grain,
                                                 const uint32_t                          plate)
{
    return grain->view->walls + plate;
}

DIG_BOTH static inline void dig_device_clear_history(struct dig_device_contacts *const grain,
                                                     const uint32_t                    surface)
{
    if ((grain->surface_mask >> surface & 1) != 0) {
        const struct dig_contact_history none = { 0 };
        grain->surface_mask &= ~((uint64_t)1 << surface);
        *dig_device_surface_history(grain, surface) = none;
    }
}

DIG_BOTH static inline void dig_device_add_force(const struct dig_contact_force *const p,
                                                 struct dig_load *const                load)
{
    load->f_N[0] += p->fx_N;
    load->f_N[1] += p->fy_N;
    load->f_N[2] += p->fz_N;
    load->t_Nm[0] += p->ix_Nm;
    load->t_Nm[1] += p->iy_Nm;
    load->t_Nm[2] += p->iz_Nm;
}

/// Contact force of a surface on the grain: d to the grain's centre, v of the surface.
DIG_BOTH static inline struct dig_contact_force
dig_device_add_surface(struct dig_device_contacts *const grain, const struct dig_law *const law,
                       const uint32_t surface, const double d[3], const double v[3])
{
    const struct dig_motion *const m          = &grain->m;
    const struct dig_kinematics    kinematics = {
           d[0],
           d[1],
           d[2],
           m->v_mps[0] - v[0],
           m->v_mps[1] - v[1],
           m->v_mps[2] - v[2],
           m->w_radps[0],
           m->w_radps[1],
           m->w_radps[2],
           0.0,
           0.0,
           0.0,
    };
    const struct dig_contact_force force = dig_law_apply(
        law, grain->step->dt_s, &kinematics, dig_device_surface_history(grain, surface));
    grain->surface_mask |= (uint64_t)1 << surface;
    dig_device_add_force(&force, &grain->load);
    return force;
}

DIG_BOTH static inline void dig_device_add_walls(struct dig_device_contacts *const grain)
{
    const struct dig_law *const law      = &grain->view->wall_law[grain->view->type_of[grain->i]];
    const double                still[3] = { 0.0, 0.0, 0.0 };
    for (uint32_t w = 0; w < grain->step->walls; w++) {
        const double *const n = grain->step->wall[w].normal;
        const double *const x = grain->m.x_m;
        const double h = n[0] * x[0] + n[1] * x[1] + n[2] * x[2] - grain->step->wall[w].offset_m;
        if (h > DIG_DEVICE_FAR * law->reach_m) {
            dig_device_clear_history(grain, w);
            continue;
        }
        // A grain pressed through a wall stays on its inner side.
        const double                least_m    = 1e-3 * law->reach_m;
        const double                safe_m     = h > least_m ? h : least_m;
        const double                d[3]       = { safe_m * n[0], safe_m * n[1], safe_m * n[2] };
        const struct dig_kinematics kinematics = { .dx_m = d[0], .dy_m = d[1], .dz_m = d[2] };
        if (dig_device_touches(law, &kinematics)) {
            (void)dig_device_add_surface(grain, law, w, d, still);
        } else {
            dig_device_clear_history(grain, w);
        }
    }
}

/// Adds one plate in contact; its reaction acts on the tool, about the pin.
DIG_BOTH static inline void dig_device_add_plate(struct dig_device_contacts *const grain,
                                                 const uint32_t plate, const double body_m[3],
                                                 const double closest_m[3])
{
    double d[3];
    double arm[3];
    double v[3];
    dig_tool_separation(&grain->step->tool, body_m, closest_m, d, arm, v);
    const struct dig_law *const    law = &grain->view->tool_law[grain->view->type_of[grain->i]];
    const struct dig_contact_force p =
        dig_device_add_surface(grain, law, dig_device_plate(grain, plate), d, v);
    const double f[3] = { p.fx_N, p.fy_N, p.fz_N };
    const double t[3] = { p.jx_Nm, p.jy_Nm, p.jz_Nm };
    dig_wrench_react(f, t, arm, &grain->view->on_tool[grain->i]);
}

DIG_BOTH static inline void dig_device_add_tool(struct dig_device_contacts *const grain)
{
    const struct dig_tool *const tool = &grain->step->tool;
    const double radius_m = grain->view->tool_law[grain->view->type_of[grain->i]].reach_m;
    double       body_m[3];
    dig_tool_to_body(tool, grain->m.x_m, body_m);
    const double reach_m = tool->radius_m + radius_m;
    const bool   is_far  = body_m[0] * body_m[0] + body_m[2] * body_m[2] > reach_m * reach_m ||
                        fabs(body_m[1]) > 0.5 * tool->bucket.width_m + radius_m;
    struct dig_plate_contacts near;
    near.count       = 0;
    uint32_t touched = 0;
    for (uint32_t p = 0; p < tool->plates && !is_far; p++) {
        // The distance to a side is at least that to its plane.
        const double half_m =
            p + 1 == tool->bucket.points ? -0.5 * tool->bucket.width_m : 0.5 * tool->bucket.width_m;
        if (p + 1 >= tool->bucket.points && fabs(body_m[1] - half_m) > DIG_DEVICE_FAR * radius_m) {
            continue;
        }
        if (!dig_plate_contacts_add(&tool->bucket, p, body_m, radius_m, &near)) {
            near.count--;
        }
    }
    for (size_t k = 0; k < near.count && near.count > 1; k++) {
        near.history[k] =
            *dig_device_surface_history(grain, dig_device_plate(grain, (uint32_t)near.plate[k]));
    }
    if (near.count > 1) {
        dig_plate_contacts_resolve(&tool->bucket, radius_m, &near);
    }
    for (size_t k = 0; k < near.count; k++) {
        const uint32_t plate = (uint32_t)near.plate[k];
        touched |= (near.touched[k] ? 1U : 0U) << plate;
        if (near.touched[k] && near.count > 1) {
            *dig_device_surface_history(grain, dig_device_plate(grain, plate)) = near.history[k];
        }
        if (near.touched[k]) {
            dig_device_add_plate(grain, plate, body_m, near.closest_m[k]);
        }
    }
    for (uint32_t p = 0; p < tool->plates; p++) {
        if ((touched >> p & 1) == 0) {
            dig_device_clear_history(grain, dig_device_plate(grain, p));
        }
    }
}

/// Fixed rocks, in their nearest image along y.
DIG_BOTH static inline void dig_device_add_rocks(struct dig_device_contacts *const grain)
{
    const struct dig_device_step *const step = grain->step;
    const struct dig_law *const law      = &grain->view->wall_law[grain->view->type_of[grain->i]];
    const double                still[3] = { 0.0, 0.0, 0.0 };
    const uint32_t              first    = grain->view->walls + grain->view->plates;
    for (uint32_t r = 0; r < step->rocks; r++) {
        const struct dig_rock_surface *const rock = &step->rock[r];
        double seen[3] = { grain->m.x_m[0], grain->m.x_m[1], grain->m.x_m[2] };
        double closest[3];
        double d[3];
        if (step->period_y_m > 0.0) {
            seen[1] = rock->x_m[1] + dig_period_fold(seen[1] - rock->x_m[1], step->period_y_m,
                                                     step->inverse_period);
        }
        dig_rock_surface_separation(rock, seen, law->reach_m, closest, d);
        const struct dig_kinematics kinematics = { .dx_m = d[0], .dy_m = d[1], .dz_m = d[2] };
        if (dig_device_touches(law, &kinematics)) {
            (void)dig_device_add_surface(grain, law, first + r, d, still);
        } else {
            dig_device_clear_history(grain, first + r);
        }
    }
}

DIG_BOTH static inline void dig_device_step_surfaces(const struct dig_device_view *const view,
                                                     const struct dig_device_step *const step,
                                                     const uint32_t                      i)
{
    struct dig_device_contacts grain = {
        view, step, i, view->motion[i], { { 0 }, { 0 } }, view->surface_mask[i]
    };
    const uint64_t before = grain.surface_mask;
    dig_device_add_walls(&grain);
    if (step->has_tool) {
        dig_device_add_tool(&grain);
    }
    dig_device_add_rocks(&grain);
    if ((before | grain.surface_mask) != 0) {
        view->surface_load[i] = grain.load;
        view->surface_mask[i] = grain.surface_mask;
    }
}

#endif // DIG_OFFLINE_DEM_DEVICE_DEVICE_SURFACES_H

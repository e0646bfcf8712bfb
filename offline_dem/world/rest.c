#include "offline_dem/world/rest.h"

#include "offline_dem/law/period.h"
#include "offline_dem/world/world.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define LOOK_STEPS    64     // between two looks
#define CALM_LOOKS    4      // on end, before a grain is held
#define CREEP         2.5e-3 // slowest speed that counts as moving, in sqrt(g r)
#define NEAR_RADII    3.0    // a grain whose surface is closer to the tool is not held
#define HOLD_FRACTION 0.5    // of the tolerance: what is held must not be let go at once

bool dig_rest_is_on(const struct dig_world *const w)
{
    return w->freeze > 0.0 && w->bodies == NULL;
}

bool dig_rest_is_due(const struct dig_world *const w)
{
    return dig_rest_is_on(w) && w->steps % LOOK_STEPS == 0;
}

static enum dig_status make_room(struct dig_world *const w)
{
    struct dig_rest *const rest = &w->rest;
    const size_t           n    = w->grains.n;
    if (rest->grain != NULL) {
        return DIG_OK;
    }
    rest->grain = calloc(n + 1, sizeof *rest->grain);
    rest->awake = calloc(n + 1, sizeof *rest->awake);
    if (rest->grain == NULL || rest->awake == NULL) {
        dig_rest_finish(rest);
        return DIG_ENOMEM;
    }
    rest->grains = n;
    for (size_t i = 0; i < n; i++) {
        memcpy(rest->grain[i].at_m, w->grains.motion[i].x_m, sizeof rest->grain[i].at_m);
    }
    return DIG_OK;
}

static void list_awake(struct dig_rest *const rest)
{
    rest->awakes = 0;
    for (size_t i = 0; i < rest->grains; i++) {
        rest->awake[rest->awakes] = (uint32_t)i;
        rest->awakes += !rest->grain[i].held;
    }
}

static double overlap(const struct dig_world *const w, const uint32_t i, const uint32_t j,
                      const double reach_m)
{
    const double *const x     = w->grains.motion[i].x_m;
    const double *const y     = w->grains.motion[j].x_m;
    const double        per_m = dig_period_inverse(w->period_y_m);
    const double        d[3]  = { x[0] - y[0], dig_period_fold(x[1] - y[1], w->period_y_m, per_m),
                                  x[2] - y[2] };
    return reach_m - sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
}

// A quarter of what each contact presses with goes to both grains.
static void squeeze(const struct dig_world *const w, const struct dig_law *const law,
                    const struct dig_contacts *const list)
{
    for (size_t c = 0; c < list->n; c++) {
        const double quarter_N =
            0.25 * law->normal_Npm * fmax(0.0, overlap(w, list->i[c], list->j[c], law->reach_m));
        w->rest.grain[list->i[c]].squeeze_N += quarter_N;
        w->rest.grain[list->j[c]].squeeze_N += quarter_N;
    }
}

static void weigh(struct dig_world *const w)
{
    const double *const g      = w->gravity_mps2;
    const double        g_mps2 = sqrt(g[0] * g[0] + g[1] * g[1] + g[2] * g[2]);
    for (size_t i = 0; i < w->grains.n; i++) {
        w->rest.grain[i].squeeze_N = 0.0;
    }
    for (size_t l = 0; l < (size_t)DIG_GRAIN_TYPES_MAX * DIG_GRAIN_TYPES_MAX; l++) {
        squeeze(w, &w->pair_law[l], &w->pair[l]);
        squeeze(w, &w->pair_law[l], &w->held_pair[l]);
    }
    for (size_t i = 0; i < w->grains.n; i++) {
        w->rest.grain[i].squeeze_N =
            fmax(w->rest.grain[i].squeeze_N, g_mps2 * w->grains.kind[w->grains.of[i]].mass_kg);
    }
}

static bool is_balanced(const struct dig_world *const w, const size_t i, const double fraction)
{
    const struct dig_kind *const kind    = &w->grains.kind[w->grains.of[i]];
    const struct dig_load *const load    = &w->grains.load[i];
    const double                 most_N  = fraction * w->rest.grain[i].squeeze_N;
    const double                 most_Nm = most_N * kind->radius_m;
    double                       f2      = 0.0;
    double                       t2      = 0.0;
    for (int k = 0; k < 3; k++) {
        const double f_N = load->f_N[k] + kind->mass_kg * w->gravity_mps2[k];
        f2 += f_N * f_N;
        t2 += load->t_Nm[k] * load->t_Nm[k];
    }
    return f2 <= most_N * most_N && t2 <= most_Nm * most_Nm;
}

static bool is_near_tool(const struct dig_world *const w, const size_t i)
{
    const struct dig_tool *const tool = w->tool;
    if (tool == NULL) {
        return false;
    }
    // Beside what is near, the tool may come as far as it moves until the look after the next.
    const double speed_mps =
        hypot(tool->vx_mps, tool->vz_mps) + tool->radius_m * fabs(tool->w_radps);
    const double radius_m = w->grains.kind[w->grains.of[i]].radius_m;
    const double reach_m  = (1.0 + NEAR_RADII) * radius_m + 2.0 * LOOK_STEPS * w->dt_s * speed_mps;
    const double *const x = w->grains.motion[i].x_m;
    const double        dx_m = x[0] - tool->pose.x_m;
    const double        dz_m = x[2] - tool->pose.z_m;
    if (hypot(dx_m, dz_m) > tool->radius_m + reach_m) {
        return false;
    }
    double body_m[3];
    dig_tool_to_body(tool, x, body_m);
    for (size_t p = 0; p < tool->plates; p++) {
        double c[3];
        dig_tool_closest(tool, p, body_m, c);
        const double d[3] = { body_m[0] - c[0], body_m[1] - c[1], body_m[2] - c[2] };
        if (d[0] * d[0] + d[1] * d[1] + d[2] * d[2] < reach_m * reach_m) {
            return true;
        }
    }
    return false;
}

// Whether the grain has crept since the last look; remembers where it stands.
static bool has_moved(struct dig_world *const w, const size_t i, const double creep_mps)
{
    const double *const x    = w->grains.motion[i].x_m;
    double *const       at_m = w->rest.grain[i].at_m;
    const double        d[3] = { x[0] - at_m[0], x[1] - at_m[1], x[2] - at_m[2] };
    const double        most = creep_mps * LOOK_STEPS * w->dt_s;
    memcpy(at_m, x, 3 * sizeof *at_m);
    return !(d[0] * d[0] + d[1] * d[1] + d[2] * d[2] <= most * most);
}

// What is let go takes along the held grains it touches.
static bool let_go(struct dig_world *const w, unsigned char go[])
{
    bool any = false;
    for (size_t l = 0; l < (size_t)DIG_GRAIN_TYPES_MAX * DIG_GRAIN_TYPES_MAX; l++) {
        const struct dig_contacts *const list = &w->held_pair[l];
        for (size_t c = 0; c < list->n; c++) {
            const uint32_t i = list->i[c];
            const uint32_t j = list->j[c];
            if ((go[i] | go[j]) == 1 && overlap(w, i, j, w->pair_law[l].reach_m) > 0.0) {
                go[i] = go[i] == 1 ? 1 : 2;
                go[j] = go[j] == 1 ? 1 : 2;
            }
        }
    }
    for (size_t i = 0; i < w->grains.n; i++) {
        if (go[i] != 0) {
            w->rest.grain[i].held = false;
            w->rest.grain[i].calm = 0;
            any                   = true;
        }
    }
    return any;
}

static void hold(struct dig_world *const w, const size_t i)
{
    w->rest.grain[i].held = true;
    memset(w->grains.motion[i].v_mps, 0, sizeof w->grains.motion[i].v_mps);
    memset(w->grains.motion[i].w_radps, 0, sizeof w->grains.motion[i].w_radps);
}

enum dig_status dig_rest_look(struct dig_world *const w)
{
    unsigned char *const go = calloc(w->grains.n + 1, 1);
    if (go == NULL || make_room(w) != DIG_OK) {
        free(go);
        return DIG_ENOMEM;
    }
    weigh(w);
    const double *const g       = w->gravity_mps2;
    const double        g_mps2  = sqrt(g[0] * g[0] + g[1] * g[1] + g[2] * g[2]);
    bool                changed = false;
    bool                any_go  = false;
    for (size_t i = 0; i < w->grains.n; i++) {
        struct dig_rest_grain *const own = &w->rest.grain[i];
        if (own->held) {
            go[i] = !is_balanced(w, i, w->freeze) || is_near_tool(w, i);
            any_go |= go[i] != 0;
            continue;
        }
        const double creep_mps = CREEP * sqrt(g_mps2 * w->grains.kind[w->grains.of[i]].radius_m);
        own->calm              = has_moved(w, i, creep_mps) ? 0 : own->calm + 1;
        if (own->calm >= CALM_LOOKS && is_balanced(w, i, HOLD_FRACTION * w->freeze) &&
            !is_near_tool(w, i)) {
            hold(w, i);
            changed = true;
        }
    }
    if (any_go) {
        changed |= let_go(w, go);
    }
    free(go);
    list_awake(&w->rest);
    w->rest.changed |= changed;
    w->stale |= changed;
    return DIG_OK;
}

void dig_rest_mark(struct dig_world *const w)
{
    const struct dig_neighbours *const near = &w->near_list;
    if (w->rest.grain == NULL) {
        return;
    }
    for (size_t i = 0; i < w->grains.n; i++) {
        bool loose = !w->rest.grain[i].held;
        for (uint32_t s = near->start[i]; s < near->start[i + 1] && !loose; s++) {
            loose = !w->rest.grain[near->other[s]].held;
        }
        w->rest.grain[i].loose = loose;
    }
}

enum dig_status dig_rest_move(struct dig_world *const w, const uint32_t place[])
{
    struct dig_rest *const rest = &w->rest;
    if (rest->grain == NULL) {
        return DIG_OK;
    }
    struct dig_rest_grain *const moved = calloc(rest->grains + 1, sizeof *moved);
    if (moved == NULL) {
        return DIG_ENOMEM;
    }
    size_t kept = 0;
    for (size_t i = 0; i < rest->grains; i++) {
        if (place[i] != UINT32_MAX) {
            moved[place[i]] = rest->grain[i];
            kept++;
        }
    }
    free(rest->grain);
    rest->grain  = moved;
    rest->grains = kept;
    list_awake(rest);
    return DIG_OK;
}

void dig_rest_finish(struct dig_rest *const rest)
{
    free(rest->grain);
    free(rest->awake);
    *rest = (struct dig_rest){ 0 };
}

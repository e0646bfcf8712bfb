#include "tests/blind/soil.h"

#include "core/units.h"

#include <math.h>

// The rig's scene: tooth below the pin, height of the levelled bed.
#define TOOTH_m   0.09
#define SURFACE_m 0.085

const char *blind_soil_effect_name(const enum blind_soil_effect effect)
{
    static const char *const name[BLIND_SOIL_EFFECTS] = {
        "rate_dependence", "wear", "water_table", "root_mat", "ripples", "weather", "pile_up"
    };
    return name[effect];
}

struct blind_ground blind_ground_draw(struct blind_draw *const     draw,
                                      const enum blind_soil_effect effect, const int strength)
{
    static const double size[BLIND_SOIL_EFFECTS][3] = {
        [BLIND_RATE_DEPENDENCE] = { 0.08, 0.3, 0.9 },   // exponent
        [BLIND_WEAR]            = { 0.01, 0.04, 0.12 }, // per dig
        [BLIND_WATER_TABLE]     = { 0.1, 0.35, 0.7 },   // share lost
        [BLIND_ROOT_MAT]        = { 0.15, 0.6, 2.0 },   // of the rms force
        [BLIND_RIPPLES]         = { 0.1, 0.35, 0.8 },   // amplitude
        [BLIND_WEATHER]         = { 0.06, 0.2, 0.5 },   // amplitude
        [BLIND_PILE_UP]         = { 0.1, 0.4, 1.2 },    // per 100 mm
    };
    return (struct blind_ground){ effect,
                                  { size[effect][strength] * exp(blind_between(draw, -0.2, 0.2)),
                                    blind_uniform(draw), blind_uniform(draw),
                                    blind_uniform(draw) } };
}

struct tooth {
    double x_m, depth_m; // where it is
    double vx_mps, vz_mps;
    double rx_m, rz_m; // from the pin
};

static void tooth_place(const struct dig_force_row *const row, double *const x_m, double *const z_m)
{
    const double theta = row->theta_deg * DIG_RAD_PER_DEG;
    *x_m               = row->pin_x_m + TOOTH_m * sin(theta);
    *z_m               = row->pin_z_m - TOOTH_m * cos(theta);
}

static struct tooth tooth_at(const struct dig_recording *const recording, const size_t i)
{
    const struct dig_force_row *const a = &recording->row[i == 0 ? 0 : i - 1];
    const struct dig_force_row *const b = &recording->row[i + 1 < recording->rows ? i + 1 : i];

    double       ax_m;
    double       az_m;
    double       bx_m;
    double       bz_m;
    struct tooth t;
    double       z_m;
    tooth_place(a, &ax_m, &az_m);
    tooth_place(b, &bx_m, &bz_m);
    tooth_place(&recording->row[i], &t.x_m, &z_m);
    t.depth_m = SURFACE_m - z_m;
    t.vx_mps  = (bx_m - ax_m) / (b->t_s - a->t_s);
    t.vz_mps  = (bz_m - az_m) / (b->t_s - a->t_s);
    t.rx_m    = t.x_m - recording->row[i].pin_x_m;
    t.rz_m    = z_m - recording->row[i].pin_z_m;
    return t;
}

static double rms_force_N(const struct dig_recording *const recording)
{
    double sum = 0.0;
    for (size_t i = 0; i < recording->rows; i++) {
        sum += pow(recording->row[i].Fx_N, 2.0) + pow(recording->row[i].Fz_N, 2.0);
    }
    return sqrt(sum / (double)recording->rows);
}

static double factor(const struct blind_ground *const g, const size_t order,
                     const struct tooth *const t, const double dragged_m)
{
    switch (g->effect) {
    case BLIND_RATE_DEPENDENCE: return pow(fmax(hypot(t->vx_mps, t->vz_mps), 0.01) / 0.05, g->p[0]);
    case BLIND_WEAR: return 1.0 + g->p[0] * (double)order;
    case BLIND_WATER_TABLE:
        return 1.0 - g->p[0] / (1.0 + exp(-(t->depth_m - 0.02 - 0.01 * g->p[1]) / 0.003));
    case BLIND_RIPPLES:
        return 1.0 + g->p[0] * sin(2.0 * DIG_PI * (t->x_m / (0.05 + 0.05 * g->p[1]) + g->p[2]));
    case BLIND_WEATHER: return 1.0 + (order % 2 == 0 ? g->p[0] : -g->p[0]);
    case BLIND_PILE_UP: return 1.0 + g->p[0] * fmax(dragged_m, 0.0) / 0.1;
    case BLIND_ROOT_MAT:
    case BLIND_SOIL_EFFECTS:
    default: return 1.0;
    }
}

// A force at the tooth against its way, while it is in the skin.
static void tear(const struct blind_ground *const g, const double force_N,
                 const struct tooth *const t, struct dig_force_row *const row)
{
    const double thick_m = 0.006 + 0.012 * g->p[1];
    const double speed   = hypot(t->vx_mps, t->vz_mps);
    if (t->depth_m <= 0.0 || t->depth_m >= 2.0 * thick_m || !(speed > 0.0)) {
        return;
    }
    const double pull_N = g->p[0] * force_N * (1.0 - fabs(t->depth_m / thick_m - 1.0));
    const double fx_N   = -pull_N * t->vx_mps / speed;
    const double fz_N   = -pull_N * t->vz_mps / speed;
    row->Fx_N += fx_N;
    row->Fz_N += fz_N;
    row->My_Nm += t->rz_m * fx_N - t->rx_m * fz_N;
}

void blind_ground_apply(const struct blind_ground *const ground, const size_t order,
                        struct dig_recording *const recording)
{
    const double force_N = rms_force_N(recording);
    const double begin_m = tooth_at(recording, 0).x_m;
    for (size_t i = 0; i < recording->rows; i++) {
        struct dig_force_row *const row = &recording->row[i];
        const struct tooth          t   = tooth_at(recording, i);
        const double                f   = factor(ground, order, &t, t.x_m - begin_m);
        row->Fx_N *= f;
        row->Fz_N *= f;
        row->My_Nm *= f;
        if (ground->effect == BLIND_ROOT_MAT) {
            tear(ground, force_N, &t, row);
        }
    }
}

void blind_hurry(const double pace, struct dig_recording *const recording)
{
    for (size_t i = 0; i < recording->rows; i++) {
        recording->row[i].t_s /= pace;
    }
}

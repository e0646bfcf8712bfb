#include "tests/blind/inject.h"

#include "core/units.h"
#include "tests/blind/front.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

#define GRAVITY_mps2 9.81

const char *blind_machine_effect_name(const enum blind_machine_effect effect)
{
    static const char *const name[BLIND_MACHINE_EFFECTS] = {
        "cylinder_friction", "pressure_offset", "bucket_weight", "bucket_inertia", "payload",
        "linkage_geometry",  "angle_offset",    "sensor_delay",  "swing_ripple",   "sensor_drift",
        "thermal_gain",      "hose_lag",        "cross_talk",    "angle_warp",
    };
    return name[effect];
}

// The first parameter of each effect at its three strengths.
static const double size_of[BLIND_MACHINE_EFFECTS][BLIND_STRENGTHS] = {
    [BLIND_CYLINDER_FRICTION] = { 100.0, 800.0, 4000.0 },   // N of dry friction, bucket drive
    [BLIND_PRESSURE_OFFSET]   = { 6.0e3, 6.0e4, 5.0e5 },    // Pa
    [BLIND_BUCKET_WEIGHT]     = { 1.5, 15.0, 120.0 },       // kg
    [BLIND_BUCKET_INERTIA]    = { 80.0, 250.0, 800.0 },     // kg m2
    [BLIND_PAYLOAD]           = { 2.0, 15.0, 120.0 },       // kg
    [BLIND_LINKAGE_GEOMETRY]  = { 0.015, 0.05, 0.12 },      // share of a length
    [BLIND_ANGLE_OFFSET]      = { 0.003, 0.015, 0.06 },     // rad, of any joint
    [BLIND_SENSOR_DELAY]      = { 0.015, 0.05, 0.15 },      // s
    [BLIND_SWING_RIPPLE]      = { 6.0e3, 6.0e4, 6.0e5 },    // Pa
    [BLIND_SENSOR_DRIFT]      = { 50.0, 500.0, 5000.0 },    // Pa/s
    [BLIND_THERMAL_GAIN]      = { 1.0e-4, 1.0e-3, 1.0e-2 }, // 1/K
    [BLIND_HOSE_LAG]          = { 0.015, 0.07, 0.3 },       // s
    [BLIND_CROSS_TALK]        = { 0.001, 0.01, 0.1 },       // of the other chamber
    [BLIND_ANGLE_WARP]        = { 0.005, 0.02, 0.07 },      // rad
};

struct blind_fault blind_fault_draw(struct blind_draw *const        draw,
                                    const enum blind_machine_effect effect, const int strength)
{
    assert(strength >= 0 && strength < BLIND_STRENGTHS);
    struct blind_fault f = { .effect = effect };
    for (int i = 1; i < BLIND_PARAMETERS; i++) {
        f.p[i] = blind_uniform(draw);
    }
    f.p[0] = size_of[effect][strength] * exp(blind_between(draw, -0.6, 0.6));
    if (effect == BLIND_PRESSURE_OFFSET || effect == BLIND_LINKAGE_GEOMETRY ||
        effect == BLIND_CROSS_TALK || effect == BLIND_ANGLE_WARP || effect == BLIND_ANGLE_OFFSET ||
        effect == BLIND_BUCKET_WEIGHT || effect == BLIND_THERMAL_GAIN) {
        f.p[0] *= blind_sign(draw);
    }
    return f;
}

// A recording as the faults need it: angles, lengths and their rates, true pushes.
struct motion {
    size_t rows;
    double step_s;
    double (*q)[DIG_JOINTS];
    double (*lever)[DIG_JOINTS];
    double (*speed)[DIG_JOINTS]; // of the cylinders, extending is positive
    double (*push)[DIG_JOINTS];  // without the fault; changed by it
    double *phi;                 // direction of the bucket
};

static double second_difference(const double before, const double now, const double after,
                                const double step_s)
{
    return (after - 2.0 * now + before) / (step_s * step_s);
}

static void motion_finish(struct motion *const m)
{
    free(m->q);
    free(m->lever);
    free(m->speed);
    free(m->push);
    free(m->phi);
}

static enum dig_status motion_init(const struct dig_machine *const           machine,
                                   const struct dig_machine_recording *const recording,
                                   struct motion *const                      m)
{
    const size_t n = recording->rows;
    *m             = (struct motion){ .rows  = n,
                                      .q     = calloc(n, sizeof *m->q),
                                      .lever = calloc(n, sizeof *m->lever),
                                      .speed = calloc(n, sizeof *m->speed),
                                      .push  = calloc(n, sizeof *m->push),
                                      .phi   = calloc(n, sizeof *m->phi) };
    if (n < 16 || m->q == NULL || m->lever == NULL || m->speed == NULL || m->push == NULL ||
        m->phi == NULL) {
        motion_finish(m);
        return DIG_ENOMEM;
    }
    m->step_s = 1e-9 * (double)(recording->row[1].time_ns - recording->row[0].time_ns);
    for (size_t i = 0; i < n; i++) {
        const double *const value = recording->row[i].value;
        for (int j = 0; j < DIG_JOINTS; j++) {
            m->q[i][j] = value[DIG_SIGNAL_BOOM_rad + j];
            m->phi[i] += m->q[i][j];
        }
        for (int j = 0; j < DIG_JOINTS; j++) {
            m->lever[i][j] = blind_lever_m(machine, (enum dig_joint)j, m->q[i]);
            m->push[i][j] =
                blind_push_N(&machine->cylinder[j], value[DIG_SIGNAL_BOOM_HEAD_Pa + 2 * j],
                             value[DIG_SIGNAL_BOOM_ROD_Pa + 2 * j]);
        }
    }
    for (size_t i = 0; i < n; i++) {
        const size_t a = i < 2 ? 0 : i - 2;
        const size_t b = i + 2 < n ? i + 2 : n - 1;
        for (int j = 0; j < DIG_JOINTS; j++) {
            m->speed[i][j] =
                m->lever[i][j] * (m->q[b][j] - m->q[a][j]) / ((double)(b - a) * m->step_s);
        }
    }
    return DIG_OK;
}

// Dry friction with a Stribeck bump, viscous friction and a share of the push, all against the
// motion. p: dry N (bucket drive), bump, viscous, share; the other drives by their bore.
static void friction(const struct dig_machine *const machine, const struct blind_fault *const f,
                     const double scale, struct motion *const m)
{
    for (size_t i = 0; i < m->rows; i++) {
        for (int j = 0; j < DIG_JOINTS; j++) {
            const double v     = m->speed[i][j];
            const double large = scale * machine->cylinder[j].count * machine->cylinder[j].bore_m /
                                 machine->cylinder[DIG_JOINT_BUCKET].bore_m;
            const double dry   = f->p[0] * large;
            const double bump  = 1.0 + 0.6 * f->p[1] * exp(-fabs(v) / 0.02);
            const double solid = dry * bump + 0.01 * f->p[3] * fabs(m->push[i][j]);
            m->push[i][j] += solid * tanh(v / 0.002) + 4.0 * f->p[2] * dry * v;
        }
    }
}

// A mass at a point of the bucket, with its weight and its inertia: virtual work of all three
// drives. mass_kg is a function of the row.
static void mass(const struct dig_machine *const machine, const struct dig_vec2 point,
                 const double mass_kg[], struct motion *const m)
{
    const size_t wide = 4; // rows to either side of the accelerations
    for (size_t i = 0; i < m->rows; i++) {
        const size_t at = i < wide ? wide : (i + wide < m->rows ? i : m->rows - 1 - wide);

        const struct dig_vec2 before = blind_bucket_point(machine, m->q[at - wide], point);
        const struct dig_vec2 now    = blind_bucket_point(machine, m->q[at], point);
        const struct dig_vec2 after  = blind_bucket_point(machine, m->q[at + wide], point);

        const double h_s    = (double)wide * m->step_s;
        const double load_x = -second_difference(before.x, now.x, after.x, h_s);
        const double load_y = -GRAVITY_mps2 - second_difference(before.y, now.y, after.y, h_s);
        for (int j = 0; j < DIG_JOINTS; j++) {
            double q[DIG_JOINTS] = { m->q[i][0], m->q[i][1], m->q[i][2] };
            q[j] += 1e-4;
            const struct dig_vec2 more = blind_bucket_point(machine, q, point);
            q[j] -= 2e-4;
            const struct dig_vec2 less = blind_bucket_point(machine, q, point);

            const double work =
                load_x * (more.x - less.x) / 2e-4 + load_y * (more.y - less.y) / 2e-4;
            m->push[i][j] -= mass_kg[i] * work / m->lever[i][j];
        }
    }
}

static void inertia(const double extra_kgm2, struct motion *const m)
{
    const size_t wide = 4;
    for (size_t i = 0; i < m->rows; i++) {
        const size_t at = i < wide ? wide : (i + wide < m->rows ? i : m->rows - 1 - wide);
        const double a  = second_difference(m->phi[at - wide], m->phi[at], m->phi[at + wide],
                                            (double)wide * m->step_s);
        for (int j = 0; j < DIG_JOINTS; j++) {
            m->push[i][j] += extra_kgm2 * a / m->lever[i][j];
        }
    }
}

// What stayed in the bucket after the dig before, until it is emptied again; then what stays now.
static double stuck_kg(const struct blind_fault *const f, const size_t order)
{
    return order == 0 ? 0.0 : f->p[0] * (0.5 + f->p[1 + order % (BLIND_PARAMETERS - 1)]);
}

static enum dig_status masses(const struct dig_machine *const machine,
                              const struct blind_fault *const f,
                              const struct blind_place *const place, struct motion *const m)
{
    double *const kg = calloc(m->rows, sizeof *kg);
    if (kg == NULL) {
        return DIG_ENOMEM;
    }
    const double    scale  = pow(place->lambda / 10.0, 3.0);
    const double    long_m = machine->link[DIG_JOINT_BUCKET].length_m;
    struct dig_vec2 point  = { 0.45 * long_m, 0.22 * long_m };
    for (size_t i = 0; i < m->rows; i++) {
        const double t_s = (double)i * m->step_s;
        kg[i]            = f->effect == BLIND_BUCKET_WEIGHT
                               ? f->p[0] * scale
                               : scale * stuck_kg(f, place->order + (t_s > place->released_s ? 1 : 0));
    }
    if (f->effect == BLIND_BUCKET_WEIGHT) {
        point =
            (struct dig_vec2){ (0.3 + 0.5 * f->p[1]) * long_m, (0.05 + 0.25 * f->p[2]) * long_m };
    }
    mass(machine, point, kg, m);
    free(kg);
    return DIG_OK;
}

// The linkage as it is, where the file says otherwise: bucket ear, bucket base, arm eye.
static void geometry(const struct dig_machine *const machine, const struct blind_fault *const f,
                     struct motion *const m)
{
    struct dig_machine true_one = *machine;
    const int          which    = (int)(3.0 * f->p[1]);
    if (which == 0) {
        true_one.four_bar.ear_m.x *= 1.0 + f->p[0];
        true_one.four_bar.ear_m.y *= 1.0 + f->p[0];
    } else if (which == 1) {
        true_one.cylinder[DIG_JOINT_BUCKET].base_m.y *= 1.0 + 2.0 * f->p[0];
    } else {
        true_one.four_bar.rocker_m *= 1.0 + f->p[0];
        true_one.cylinder[DIG_JOINT_ARM].eye_m.y *= 1.0 + f->p[0];
    }
    for (size_t i = 0; i < m->rows; i++) {
        for (int j = 0; j < DIG_JOINTS; j++) {
            const double lever = blind_lever_m(&true_one, (enum dig_joint)j, m->q[i]);
            m->push[i][j] *= m->lever[i][j] / lever;
        }
    }
}

// The faults that act on what the drives push.
static enum dig_status push_faults(const struct dig_machine *const     machine,
                                   const struct blind_fault *const     f,
                                   const struct blind_place *const     place,
                                   struct dig_machine_recording *const recording)
{
    struct motion   m;
    enum dig_status status = motion_init(machine, recording, &m);
    if (status != DIG_OK) {
        return status;
    }
    if (f->effect == BLIND_CYLINDER_FRICTION) {
        friction(machine, f, pow(place->lambda / 10.0, 3.0), &m);
    } else if (f->effect == BLIND_BUCKET_INERTIA) {
        inertia(f->p[0] * pow(place->lambda / 10.0, 5.0), &m);
    } else if (f->effect == BLIND_LINKAGE_GEOMETRY) {
        geometry(machine, f, &m);
    } else {
        status = masses(machine, f, place, &m);
    }
    for (size_t i = 0; i < m.rows && status == DIG_OK; i++) {
        double *const value = recording->row[i].value;
        for (int j = 0; j < DIG_JOINTS; j++) {
            blind_pressures(&machine->cylinder[j], m.push[i][j],
                            &value[DIG_SIGNAL_BOOM_HEAD_Pa + 2 * j],
                            &value[DIG_SIGNAL_BOOM_ROD_Pa + 2 * j]);
        }
    }
    motion_finish(&m);
    return status;
}

// Late pressures, by a dead time or a first-order lag of p[0] seconds.
static enum dig_status late(const struct blind_fault *const     f,
                            struct dig_machine_recording *const recording)
{
    const double  step_s = 1e-9 * (double)(recording->row[1].time_ns - recording->row[0].time_ns);
    double *const was    = calloc(recording->rows, sizeof *was);
    if (was == NULL) {
        return DIG_ENOMEM;
    }
    for (int s = DIG_SIGNAL_BOOM_HEAD_Pa; s <= DIG_SIGNAL_BUCKET_ROD_Pa; s++) {
        for (size_t i = 0; i < recording->rows; i++) {
            was[i] = recording->row[i].value[s];
        }
        double held = was[0];
        for (size_t i = 0; i < recording->rows; i++) {
            if (f->effect == BLIND_HOSE_LAG) {
                held += (was[i] - held) * (1.0 - exp(-step_s / f->p[0]));
            } else {
                const double at   = fmax((double)i - f->p[0] / step_s, 0.0);
                const size_t low  = (size_t)at;
                const size_t high = low + 1 < recording->rows ? low + 1 : low;
                held              = was[low] + (at - (double)low) * (was[high] - was[low]);
            }
            recording->row[i].value[s] = held;
        }
    }
    free(was);
    return DIG_OK;
}

// The oil warms over the campaign; p[1] sets how fast.
static double oil_degC(const struct blind_fault *const f, const double t_s)
{
    return 45.0 + 25.0 * (1.0 - exp(-t_s / (60.0 + 240.0 * f->p[1])));
}

// A gain as faint or strong as an offset: 0.8, 2.5 and 7 % for 0.06, 0.6 and 5 bar.
static double gain_of(const double offset_Pa)
{
    return copysign(1e-4 * sqrt(fabs(offset_Pa)), offset_Pa);
}

// The faults that act on what a sensor reads, sample by sample.
static void read_faults(const struct blind_fault *const f, const struct blind_place *const place,
                        struct dig_sample *const sample, const double t_s)
{
    double *const p     = &sample->value[DIG_SIGNAL_BOOM_HEAD_Pa];
    const int     which = (int)(4.0 * f->p[1]);
    const double  turn  = 2.0 * DIG_PI * (0.12 + 0.35 * f->p[1]) * (place->start_s + t_s);
    switch ((int)f->effect) {
    case BLIND_PRESSURE_OFFSET: // one chamber, or all of a common supply, or a gain alone
        if (which == 2) {
            p[f->p[2] < 0.5 ? 4 : 5] *= 1.0 + gain_of(f->p[0]);
        } else {
            p[which == 0 ? 5 : 4] += f->p[0];
        }
        if (which == 3) {
            p[0] += f->p[0] * f->p[2];
            p[2] -= f->p[0] * f->p[3];
        }
        break;
    case BLIND_SWING_RIPPLE:
        for (int c = 0; c < 6; c++) {
            p[c] += f->p[0] * (0.3 + f->p[2 + c]) * sin(turn + 6.0 * f->p[3 + c]);
        }
        break;
    case BLIND_SENSOR_DRIFT: p[4] -= f->p[0] * (place->start_s + t_s); break;
    case BLIND_THERMAL_GAIN:
        sample->value[DIG_SIGNAL_TEMPERATURE_degC] = oil_degC(f, place->start_s + t_s);
        for (int c = 0; c < 6; c++) {
            p[c] *= 1.0 + f->p[0] * (oil_degC(f, place->start_s + t_s) - 45.0);
        }
        break;
    case BLIND_CROSS_TALK: p[4] += f->p[0] * p[3]; break;
    case BLIND_ANGLE_OFFSET:
        sample->value[DIG_SIGNAL_BOOM_rad + (int)(3.0 * f->p[1])] += f->p[0];
        break;
    case BLIND_ANGLE_WARP:
        sample->value[DIG_SIGNAL_BUCKET_rad] +=
            f->p[0] * sin(2.0 * sample->value[DIG_SIGNAL_BUCKET_rad] + 6.0 * f->p[1]);
        break;
    default: break;
    }
    for (int c = 0; c < 6; c++) {
        p[c] = fmax(p[c], 0.0);
    }
}

enum dig_status blind_inject(const struct dig_machine *const     machine,
                             const struct blind_fault *const     fault,
                             const struct blind_place *const     place,
                             struct dig_machine_recording *const recording)
{
    switch ((int)fault->effect) {
    case BLIND_CYLINDER_FRICTION:
    case BLIND_BUCKET_WEIGHT:
    case BLIND_BUCKET_INERTIA:
    case BLIND_PAYLOAD:
    case BLIND_LINKAGE_GEOMETRY: return push_faults(machine, fault, place, recording);
    case BLIND_SENSOR_DELAY:
    case BLIND_HOSE_LAG: return late(fault, recording);
    default: break;
    }
    for (size_t i = 0; i < recording->rows; i++) {
        read_faults(fault, place, &recording->row[i], 1e-9 * (double)recording->row[i].time_ns);
    }
    return DIG_OK;
}

static double whole_steps(const double value, const double step)
{
    return step > 0.0 ? step * floor(value / step + 0.5) : value;
}

void blind_sense(const struct dig_machine *const machine, struct blind_draw *const draw,
                 struct dig_machine_recording *const recording)
{
    for (size_t i = 0; i < recording->rows; i++) {
        double *const value = recording->row[i].value;
        for (int j = 0; j < DIG_JOINTS; j++) {
            value[DIG_SIGNAL_BOOM_rad + j] = whole_steps(
                value[DIG_SIGNAL_BOOM_rad + j] + machine->angle_sigma_rad * blind_normal(draw),
                machine->angle_step_rad);
            for (int c = 0; c < 2; c++) {
                double *const p = &value[DIG_SIGNAL_BOOM_HEAD_Pa + 2 * j + c];
                *p = whole_steps(*p + machine->cylinder[j].pressure_sigma_Pa * blind_normal(draw),
                                 machine->pressure_step_Pa);
            }
        }
    }
}

// Campaigns of machine recordings from the rig's machine (virtual work), spoilt here by formulas of
// the tests' own.

#ifndef DIG_TESTS_CLOSED_LOOP_MACHINE_CAMPAIGN_H
#define DIG_TESTS_CLOSED_LOOP_MACHINE_CAMPAIGN_H

#include "closed_loop/machine/machine_side.h"
#include "core/units.h"
#include "tests/closed_loop/pitched_machine.h"
#include "tests/made_table.h"
#include "tests/model_front.h"
#include "tests/read.h"
#include "tools/rig/motion/track.h"
#include "tools/rig/sensors.h"

#include <stdlib.h>
#include <string.h>

enum { KINDS = 2, DIGS = 4 };

static struct dig_machine    machine;
static struct dig_rig_track  track[KINDS];
static struct dig_curve_set *set;

static inline int build(void **state)
{
    (void)state;
    static const char *const  kind[KINDS] = { "simpleA", "actual" };
    const struct made_options options     = { .relative_sd = 0.1, .packings = 3 };
    struct dig_error          error       = { "" };
    set                                   = made_table(&options);
    machine                               = read_machine("zx200_trench");
    struct dig_rig_track_options how      = dig_rig_track_options_default();
    how.placed  = true; // where digrig would put it: the search takes seconds
    how.pin_X_m = 7.43;
    how.pin_Z_m = -0.62;
    for (int k = 0; k < KINDS; k++) {
        char path[200];
        (void)snprintf(path, sizeof path, "tests/data/reference/mu0.5_mur0.5_rho2500__%s.csv",
                       kind[k]);
        struct dig_recording recording = read_recording(path);
        assert_ok(dig_rig_track_build(&machine, &how, 1, &recording, &track[k], &error), error);
        dig_recording_finish(&recording);
    }
    return 0;
}

static inline int tear_down(void **state)
{
    (void)state;
    made_table_destroy(set);
    for (int k = 0; k < KINDS; k++) {
        dig_rig_track_finish(&track[k]);
    }
    return 0;
}

// What the machine does that its file does not say.
struct fault {
    double dry_N;       // the bucket cylinder's seal, against its motion
    double held_N;      // seals of all drives that bend .2 mm before they slip, and stay bent
    double rod_Pa;      // the bucket's rod side sensor reads so much more
    double gain;        // the bucket's head side sensor reads 1 + this times what is there
    double boom_gain;   // the boom's, likewise
    double late_s;      // pressures are so old
    double pitched_rad; // the machine, nose up, and its pitch is not recorded
    double heavier_kg[DIG_JOINTS]; // a link, in its centre of mass
    double angle_rad[DIG_JOINTS];  // its sensor reads so much more
    double payload_kg;             // in the middle of the bucket, from the second dig on
    bool   falls_out;              // before the second
    bool   was_there;              // in the first already, twice as much
    double wandering_N;            // of all drives, by a slow sine: nothing the catalogue holds
    double warm_perK; // pressures read so much more for every degree above 45, where it is recorded
    double hunting_Pa; // 1 sigma of every pressure, forgotten in so many seconds; 0: in a tenth
    double hunting_s;
    double lost;        // readings do not arrive whose luck is worse than so many sigmas; 0: all do
    size_t stands;      // so many samples more, as the first, before the machine moves
    double stands_kg;   // something carries so much of the bucket there
    size_t rests;       // so many samples more where it is about to go in: the ground
    double ground_kg;   // carries so much of the bucket there
    double slews_radps; // at most, from the first of those to the last
    bool   slews_after; // from the end of the dig to that of the recording instead
    size_t every;       // one sample in so many is recorded; 0: all are
    bool   warms;       // the oil's temperature is recorded, and rises
    bool   bare;        // no pressures but the bucket's
    bool   airless;     // recorded from the first touch of the ground to the last
};

static inline double rod_mps(const struct dig_rig_track *const t, const size_t i, const int j)
{
    const size_t b = i > 0 ? i - 1 : i, a = i + 1 < t->rows ? i + 1 : i;
    double       from_m, to_m;
    assert_int_equal(
        dig_rig_cylinder_m(&machine, (enum dig_joint)j, t->row[b].joints.rad[j], &from_m), DIG_OK);
    assert_int_equal(
        dig_rig_cylinder_m(&machine, (enum dig_joint)j, t->row[a].joints.rad[j], &to_m), DIG_OK);
    return (to_m - from_m) / (t->step_s * (double)(a - b));
}

// What bent seals hold: by so much of the rod's last way as they can bend.
static inline void bend(const struct dig_rig_track *const t, const size_t i,
                        double bent_m[DIG_JOINTS])
{
    static const double most_m = 2e-4;
    for (int j = 0; j < DIG_JOINTS; j++) {
        bent_m[j] += t->step_s * rod_mps(t, i, j);
        bent_m[j] = fmin(fmax(bent_m[j], -most_m), most_m);
    }
}

static inline struct dig_vec2 com_m(const struct dig_rig_joints *const joints, const int link)
{
    return dig_rig_front_at(&machine, joints).com_m[link];
}

// What a mass in a link's centre asks of a drive: the work of its weight and of its inertia over a
// small turn of the joint.
static inline double weight_N(const struct dig_rig_track *const t, const size_t i, const int j,
                              const int link, const double kg)
{
    if (!(fabs(kg) > 0.0)) {
        return 0.0;
    }
    const size_t          before = i > 0 ? i - 1 : i, after = i + 1 < t->rows ? i + 1 : i;
    const struct dig_vec2 was  = com_m(&t->row[before].joints, link);
    const struct dig_vec2 is   = com_m(&t->row[i].joints, link);
    const struct dig_vec2 be   = com_m(&t->row[after].joints, link);
    const double          s2   = t->step_s * t->step_s;
    struct dig_rig_joints less = t->row[i].joints, more = t->row[i].joints;
    double                lever_m;
    less.rad[j] -= 1e-5;
    more.rad[j] += 1e-5;
    const struct dig_vec2 by = dig_vec2_sub(com_m(&more, link), com_m(&less, link));
    assert_int_equal(
        dig_rig_lever_m(&machine, (enum dig_joint)j, t->row[i].joints.rad[j], &lever_m), DIG_OK);
    const double work_J = kg * ((be.x - 2.0 * is.x + was.x) / s2 * by.x +
                                (9.81 + (be.y - 2.0 * is.y + was.y) / s2) * by.y);
    return work_J / 2e-5 / lever_m;
}

// What a drive holds more while the machine slews: by the work that the pull outward does over a
// small turn of the joint. The slew axis lies 0.1 m behind the boom pin.
static inline double slew_N(const struct dig_rig_row *const row, const int j, const double radps)
{
    if (!(fabs(radps) > 0.0)) {
        return 0.0;
    }
    double                     lever_m;
    double                     work_J = 0.0;
    const struct dig_rig_front at     = dig_rig_front_at(&machine, &row->joints);
    struct dig_rig_joints      turned = row->joints;
    turned.rad[j] += 1e-5;
    const struct dig_rig_front to = dig_rig_front_at(&machine, &turned);
    for (int k = 0; k < DIG_JOINTS; k++) {
        work_J += machine.link[k].mass_kg * radps * radps * (at.com_m[k].x + 0.1) *
                  (to.com_m[k].x - at.com_m[k].x);
    }
    assert_int_equal(dig_rig_lever_m(&machine, (enum dig_joint)j, row->joints.rad[j], &lever_m),
                     DIG_OK);
    return -work_J / 1e-5 / lever_m;
}

static inline void lose(struct dig_sample *const sample, const enum dig_signal signal)
{
    sample->valid[signal] = false;
    sample->value[signal] = 0.0;
}

static inline void lose_readings(const struct fault *const fault, uint64_t *const state,
                                 struct dig_sample *const sample)
{
    for (int s = 0; s < DIG_SIGNALS_NEEDED; s++) {
        if (fault->lost > 0.0 && fabs(model_normal(state)) > fault->lost) {
            lose(sample, (enum dig_signal)s);
        }
    }
    for (int s = DIG_SIGNAL_BOOM_HEAD_Pa; s <= DIG_SIGNAL_ARM_ROD_Pa && fault->bare; s++) {
        lose(sample, (enum dig_signal)s);
    }
    if (fabs(fault->pitched_rad) > 0.0) {
        lose(sample, DIG_SIGNAL_PITCH_rad);
    }
}

static inline size_t last_of_soil(const struct dig_rig_track *const t)
{
    size_t last = t->rows - 1;
    while (!(fabs(t->row[last].soil.M_Nm) > 0.0)) {
        last--;
    }
    return last;
}

static inline size_t first_of_soil(const struct dig_rig_track *const t)
{
    size_t first = 0;
    while (!(fabs(t->row[first].soil.M_Nm) > 0.0)) {
        first++;
    }
    return first;
}

static inline void cut_air(const struct dig_rig_track *const   t,
                           struct dig_machine_recording *const r)
{
    const size_t last  = last_of_soil(t);
    const size_t first = first_of_soil(t);
    r->rows            = last + 1 - first;
    memmove(r->row, r->row + first, r->rows * sizeof *r->row);
}

static inline void thin(const size_t every, struct dig_machine_recording *const r)
{
    size_t kept = 0;
    for (size_t i = 0; every > 0 && i < r->rows; i += every) {
        r->row[kept++] = r->row[i];
    }
    r->rows = every > 0 ? kept : r->rows;
}

static inline double carried_kg(const struct fault *const fault, const size_t order)
{
    if (order == 0) {
        return fault->was_there ? 2.0 * fault->payload_kg : 0.0;
    }
    return order > 1 || !fault->falls_out ? fault->payload_kg : 0.0;
}

static inline double slewing_radps(const struct fault *const fault, const size_t row,
                                   const size_t from, const size_t to)
{
    const double part = ((double)row - (double)from) / (double)(to - from + 1);
    return part > 0.0 && part < 1.0 ? fault->slews_radps * sin(DIG_PI * part) : 0.0;
}

static inline struct dig_machine_recording
record(const int kind, const size_t order, const struct fault *const fault, const uint64_t seed)
{
    const struct dig_rig_track *const t         = &track[kind];
    const size_t                      rows      = t->rows + fault->stands + fault->rests;
    struct dig_machine_recording      r         = { rows, malloc(rows * sizeof *r.row) };
    struct dig_rig_noise              noise     = dig_rig_noise_init(seed);
    const size_t                      late      = (size_t)lround(fault->late_s / t->step_s);
    const double                      hunting_s = fault->hunting_s > 0.0 ? fault->hunting_s : 0.1;
    const double                      kept      = exp(-t->step_s / hunting_s);
    const size_t                      touch     = fault->stands + first_of_soil(t) - 15;
    const size_t slew_from = fault->slews_after ? fault->stands + last_of_soil(t) : 0;
    const size_t slew_to   = fault->slews_after ? rows - 1 : fault->stands;
    double       hunts_Pa[2 * DIG_JOINTS] = { 0.0 };
    double       bent_m[DIG_JOINTS]       = { 0.0 };
    uint64_t     state                    = seed;
    for (size_t i = 0; i < rows; i++) {
        const bool         rests = i >= touch && i < touch + fault->rests;
        const size_t       moved = rests ? touch : i < touch ? i : i - fault->rests;
        const size_t       now   = moved > fault->stands ? moved - fault->stands : 0;
        const size_t       then  = now > late ? now - late : 0;
        struct dig_rig_row row   = t->row[then];
        push_more(&machine, &row, DIG_JOINT_BUCKET,
                  fault->dry_N * tanh(rod_mps(t, then, DIG_JOINT_BUCKET) / 0.002));
        bend(t, then, bent_m);
        for (int j = 0; j < DIG_JOINTS; j++) {
            push_more(&machine, &row, j, fault->held_N * bent_m[j] / 2e-4);
            const double time_s    = t->step_s * (double)then + 40.0 * (double)order;
            const double ground_kg = rests               ? fault->ground_kg
                                     : i < fault->stands ? fault->stands_kg
                                                         : 0.0;
            push_more(&machine, &row, j,
                      weight_N(t, then, j, DIG_JOINT_BUCKET, carried_kg(fault, order) - ground_kg));
            for (int link = j; link < DIG_JOINTS; link++) {
                push_more(&machine, &row, j, weight_N(t, then, j, link, fault->heavier_kg[link]));
            }
            push_more(&machine, &row, j, pitch_N(&machine, &row.joints, j, fault->pitched_rad));
            push_more(&machine, &row, j,
                      slew_N(&row, j, slewing_radps(fault, i, slew_from, slew_to)));
            push_more(&machine, &row, j,
                      fault->wandering_N * (j + 1) * sin(1.7 * time_s + 2.0 * j));
        }
        row.pressures.rod_Pa[DIG_JOINT_BUCKET] += fault->rod_Pa;
        row.pressures.head_Pa[DIG_JOINT_BUCKET] *= 1.0 + fault->gain;
        row.pressures.head_Pa[DIG_JOINT_BOOM] *= 1.0 + fault->boom_gain;
        for (int p = 0; p < 2 * DIG_JOINTS; p++) {
            hunts_Pa[p] = kept * hunts_Pa[p] +
                          sqrt(1.0 - kept * kept) * fault->hunting_Pa * model_normal(&state);
            row.pressures.head_Pa[p / 2] += p % 2 == 0 ? hunts_Pa[p] : 0.0;
            row.pressures.rod_Pa[p / 2] += p % 2 == 1 ? hunts_Pa[p] : 0.0;
        }
        const double above_degC =
            fault->warms ? 6.0 * (double)order + 0.1 * t->step_s * (double)i : 0.0;
        for (int j = 0; j < DIG_JOINTS; j++) {
            row.pressures.head_Pa[j] *= 1.0 + fault->warm_perK * above_degC;
            row.pressures.rod_Pa[j] *= 1.0 + fault->warm_perK * above_degC;
        }
        row.joints = t->row[now].joints;
        for (int j = 0; j < DIG_JOINTS; j++) {
            row.joints.rad[j] += fault->angle_rad[j];
        }
        r.row[i] = dig_rig_sense(&machine, &row, llround((double)i * t->step_s * 1e9) + 1, &noise);
        dig_rig_quantise(&machine, &r.row[i]);
        r.row[i].value[DIG_SIGNAL_TEMPERATURE_degC] = 45.0 + above_degC;
        r.row[i].valid[DIG_SIGNAL_TEMPERATURE_degC] = fault->warms;
        lose_readings(fault, &state, &r.row[i]);
    }
    if (fault->airless) {
        cut_air(t, &r);
    }
    thin(fault->every, &r);
    return r;
}

struct campaign {
    struct dig_machine_recording recording[DIGS];
    struct dig_measured          measured[DIGS];
    struct dig_machine_side     *side;
    struct dig_machine_finding   finding;
};

// Measured, but not traced: what it is compared with.
static inline struct campaign *measure(const struct fault *const fault, const uint64_t seed)
{
    struct campaign *const c     = calloc(1, sizeof *c);
    struct dig_error       error = { "" };
    for (size_t d = 0; d < DIGS; d++) {
        c->recording[d]           = record((int)(d % KINDS), d, fault, seed * 100 + d);
        c->measured[d].trajectory = d % KINDS == 0 ? MADE_SIMPLE_A : MADE_ACTUAL;
        c->measured[d].use        = d == DIGS - 1 ? DIG_USE_HOLDOUT : DIG_USE_FIT;
        c->measured[d].order      = d;
    }
    assert_ok(
        dig_machine_side_create(&machine, set, DIGS, c->recording, c->measured, &c->side, &error),
        error);
    return c;
}

static inline struct campaign *trace(const struct fault *const fault, const uint64_t seed)
{
    struct campaign *const c = measure(fault, seed);
    assert_int_equal(dig_machine_side_trace(c->side, 0.01, seed, &c->finding), DIG_OK);
    return c;
}

static inline void end(struct campaign *const c)
{
    dig_machine_side_destroy(c->side);
    for (int d = 0; d < DIGS; d++) {
        dig_machine_recording_finish(&c->recording[d]);
    }
    free(c);
}

// Under a sanitizer one seed tells as much as several, and none where another test has the lines.
static inline uint64_t most(const uint64_t quick, const uint64_t all)
{
    return test_is_quick() ? quick : all;
}

// The only effect found is this one; its parameter has this value within its interval.
static inline void expect_found(const struct campaign *const c, const enum dig_effect_id effect,
                                const char *const parameter, const double value)
{
    assert_true(c->finding.significant && !c->finding.unexplained);
    assert_int_equal(c->finding.effects, 1);
    const struct dig_model_effect *const found = &c->finding.effect[0];
    assert_int_equal(found->effect, effect);
    // Digs are drawn anew: a third of the draws lack the first, which alone carries no payload.
    assert_true(found->probability > 0.6);
    for (size_t p = 0; parameter != NULL && p < found->parameters; p++) {
        if (strcmp(found->parameter[p].name, parameter) == 0) {
            const double wide = found->parameter[p].high - found->parameter[p].low;
            assert_close(found->parameter[p].value, value, wide);
            return;
        }
    }
    assert_null(parameter);
}

static inline void assert_nothing_found(const struct campaign *const c)
{
    for (size_t i = 0; i < c->finding.candidates; i++) {
        print_message("%s %.1f, ", dig_effect_name(c->finding.candidate[i].as.effect),
                      c->finding.candidate[i].log_evidence);
    }
    print_message("air %.3f\n", c->finding.residual_air);
    assert_false(c->finding.significant);
}

#endif // DIG_TESTS_CLOSED_LOOP_MACHINE_CAMPAIGN_H

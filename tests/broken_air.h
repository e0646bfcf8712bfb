// Recordings in free air of a machine whose file, wiring or sensors are broken in exactly one way.
// The machine is the rig's, by virtual work; what is broken is broken in its samples, by formulas
// of the tests' own, or in the file that is checked.

#ifndef DIG_TESTS_BROKEN_AIR_H
#define DIG_TESTS_BROKEN_AIR_H

#include "closed_loop/check/machine_check.h"
#include "core/recording.h"
#include "files/machine_yaml.h"
#include "tools/rig/motion/mechanism.h"
#include "tools/rig/motion/track.h"
#include "tools/rig/motion/work.h"
#include "tools/rig/sensors.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const air_machines[] = {
    "mini_1t8", "mini_2t8", "zx120", "crawler_14t", "zx200", "zx200_trench", "crawler_36t",
};
#define AIR_MACHINES (sizeof air_machines / sizeof air_machines[0])

enum air_break_kind {
    AIR_WHOLE,    // nothing is broken
    AIR_TURNED,   // the angle counts the other way
    AIR_ZERO,     // the angle sensor reads amount degrees too much
    AIR_DRIVES,   // the columns of two cylinders are exchanged
    AIR_SIDES,    // those of head and rod
    AIR_UNIT,     // all pressures are amount times what they are
    AIR_ONE_UNIT, // those of one cylinder
    AIR_FACTOR,   // the same by another factor than a unit's
    AIR_DEGREES,  // angles are degrees
    AIR_HEAD,     // the head side's sensor reads amount bar too much
    AIR_ROD,      // the rod side's
    AIR_WEIGHT,   // the file has amount times the link's mass
    AIR_LATE,     // pressures are amount seconds older than angles
    AIR_STILL,    // the joint does not move
    AIR_STUCK,    // the head side's sensor stands from the middle on
    AIR_GAP,      // a second is missing
    AIR_LOST      // so large a share of samples lacks a pressure
};

struct air_break {
    const char             *name;
    enum air_break_kind     kind;
    int                     of, with; // joints
    double                  amount;
    enum dig_check_question asked; // the question that must find it …
    int                     found; // … of which joint or signal
    enum dig_check_verdict  verdict;
};

#define AIR_EACH(text, kind, amount, question)                                                     \
    { "boom " text, kind, 0, 0, amount, question, 0, DIG_CHECK_WRONG },                            \
        { "arm " text, kind, 1, 1, amount, question, 1, DIG_CHECK_WRONG },                         \
    {                                                                                              \
        "bucket " text, kind, 2, 2, amount, question, 2, DIG_CHECK_WRONG                           \
    }

static const struct air_break air_breaks[] = {
    AIR_EACH("angle turned", AIR_TURNED, 0.0, DIG_CHECK_DIRECTION),
    AIR_EACH("angle 4 deg too much", AIR_ZERO, 4.0, DIG_CHECK_ZERO),
    AIR_EACH("angle 25 deg too little", AIR_ZERO, -25.0, DIG_CHECK_ZERO),
    { "boom and arm exchanged", AIR_DRIVES, 0, 1, 0.0, DIG_CHECK_CYLINDER, 0, DIG_CHECK_WRONG },
    { "arm and bucket exchanged", AIR_DRIVES, 1, 2, 0.0, DIG_CHECK_CYLINDER, 1, DIG_CHECK_WRONG },
    { "boom and bucket exchanged", AIR_DRIVES, 0, 2, 0.0, DIG_CHECK_CYLINDER, 2, DIG_CHECK_WRONG },
    AIR_EACH("head and rod exchanged", AIR_SIDES, 0.0, DIG_CHECK_SIDES),
    { "bar taken for kPa", AIR_UNIT, 0, 0, 0.01, DIG_CHECK_UNIT, 0, DIG_CHECK_WRONG },
    { "pressures times ten", AIR_UNIT, 0, 0, 10.0, DIG_CHECK_UNIT, 1, DIG_CHECK_WRONG },
    { "bar taken for Pa", AIR_UNIT, 0, 0, 1e-5, DIG_CHECK_UNIT, 2, DIG_CHECK_WRONG },
    AIR_EACH("pressures a tenth", AIR_ONE_UNIT, 0.1, DIG_CHECK_UNIT),
    AIR_EACH("pressures a fifth too much", AIR_FACTOR, 1.2, DIG_CHECK_FACTOR),
    { "angles in degrees", AIR_DEGREES, 0, 0, 0.0, DIG_CHECK_DEGREES, -1, DIG_CHECK_WRONG },
    AIR_EACH("head 20 bar too much", AIR_HEAD, 20.0, DIG_CHECK_OFFSET),
    AIR_EACH("rod 20 bar too much", AIR_ROD, 20.0, DIG_CHECK_OFFSET),
    AIR_EACH("two thirds too heavy in the file", AIR_WEIGHT, 1.667, DIG_CHECK_WEIGHT),
    { "pressures 60 ms late", AIR_LATE, 0, 0, 0.06, DIG_CHECK_DELAY, -1, DIG_CHECK_WRONG },
    { "boom does not move", AIR_STILL, 0, 0, 0.0, DIG_CHECK_MOVES, 0, DIG_CHECK_UNTOLD },
    { "arm does not move", AIR_STILL, 1, 0, 0.0, DIG_CHECK_MOVES, 1, DIG_CHECK_UNTOLD },
    { "bucket does not move", AIR_STILL, 2, 0, 0.0, DIG_CHECK_MOVES, 2, DIG_CHECK_UNTOLD },
    { "bucket head stuck", AIR_STUCK, 2, 0, 0.0, DIG_CHECK_STUCK, DIG_SIGNAL_BUCKET_HEAD_Pa,
      DIG_CHECK_WRONG },
    { "a second missing", AIR_GAP, 0, 0, 0.0, DIG_CHECK_TIMES, -1, DIG_CHECK_DOUBTFUL },
    { "a third of samples without a pressure", AIR_LOST, 0, 0, 0.3, DIG_CHECK_MISSING, -1,
      DIG_CHECK_WRONG },
};
#define AIR_BREAKS (sizeof air_breaks / sizeof air_breaks[0])

/// The line that must find a break.
static inline bool air_is_asked(const struct dig_check_item *const item,
                                const struct air_break *const      broken)
{
    return item->question == broken->asked && item->of == broken->found;
}

/// True when that line has the verdict it should.
static inline bool air_is_named(const struct dig_machine_air_check *const check,
                                const struct air_break *const             broken)
{
    bool named = false;
    for (size_t i = 0; i < check->items; i++) {
        named = named || (air_is_asked(&check->item[i], broken) &&
                          check->item[i].verdict == broken->verdict);
    }
    return named;
}

/// True when anything else is called wrong or doubtful: another question, or of two cylinders that
/// are exchanged or a unit that all have, one of them not. What stands in the place of the break
/// says so itself.
static inline bool air_says_more(const struct dig_machine_air_check *const check,
                                 const struct air_break *const             broken)
{
    bool more = false;
    for (size_t i = 0; i < check->items; i++) {
        const struct dig_check_item *const item = &check->item[i];

        const bool same    = broken != NULL && item->question == broken->asked;
        const bool several = same && (broken->kind == AIR_DRIVES || broken->kind == AIR_UNIT);
        const bool mine    = several || (same && item->of == broken->found);
        const bool instead = broken != NULL && item->or_item >= 0 &&
                             air_is_asked(&check->item[item->or_item], broken);
        more = more || (item->verdict >= DIG_CHECK_DOUBTFUL && !mine && !instead);
    }
    return more;
}

/// Reads a machine that ships, and moves it in free air. False: an error, in *error.
static inline bool air_move(const char *const name, struct dig_machine *const machine,
                            struct dig_rig_track *const track, struct dig_error *const error)
{
    char                               path[200];
    const struct dig_rig_track_options how = dig_rig_track_options_default();
    (void)snprintf(path, sizeof path, "config/machines/%s.yaml", name);
    return dig_machine_read(path, machine, error) == DIG_OK &&
           dig_rig_track_build_air(machine, &how, track, error) == DIG_OK;
}

/// Gives the moved machine seals that rub with a share of the largest push of their drive where its
/// rod moves. stand: they bend .2 mm before they slip and stay bent, so that a rod that stands is
/// held by all that it rubbed with, or by less; else they hold none.
static inline void air_rub(const struct dig_machine *const machine,
                           struct dig_rig_track *const track, const double share, const bool stand)
{
    static const double still_mps          = 0.001; // slower, a part of it
    static const double bend_m             = 2e-4;
    double              at_m[DIG_JOINTS]   = { 0.0 };
    double              bent_m[DIG_JOINTS] = { 0.0 };
    for (size_t i = 0; i < track->rows; i++) {
        struct dig_rig_row *const row = &track->row[i];
        struct dig_rig_pushes     pushes;
        for (int j = 0; j < DIG_JOINTS; j++) {
            const struct dig_cylinder *const c = &machine->cylinder[j];

            const double head_m2  = 0.25 * 3.141592653589793 * c->bore_m * c->bore_m;
            const double rod_m2   = head_m2 - 0.25 * 3.141592653589793 * c->rod_m * c->rod_m;
            const double before_m = at_m[j];
            if (dig_rig_cylinder_m(machine, (enum dig_joint)j, row->joints.rad[j], &at_m[j]) !=
                DIG_OK) {
                abort();
            }
            const double way_m = i > 0 ? at_m[j] - before_m : 0.0;
            bent_m[j]          = fmin(fmax(bent_m[j] + way_m, -bend_m), bend_m);
            const double rubs  = stand ? bent_m[j] / bend_m
                                       : fmin(fmax(way_m / (track->step_s * still_mps), -1.0), 1.0);
            pushes.N[j]        = c->count *
                          (row->pressures.head_Pa[j] * head_m2 - row->pressures.rod_Pa[j] * rod_m2 +
                           share * c->relief_Pa * head_m2 * rubs);
        }
        dig_rig_work_pressures(machine, &pushes, &row->pressures);
    }
}

static inline void air_swap(struct dig_sample *const sample, const int a, const int b)
{
    const double value = sample->value[a];
    sample->value[a]   = sample->value[b];
    sample->value[b]   = value;
}

static inline void air_scale(struct dig_sample *const sample, const int joint, const double factor)
{
    sample->value[DIG_SIGNAL_BOOM_HEAD_Pa + 2 * joint] *= factor;
    sample->value[DIG_SIGNAL_BOOM_ROD_Pa + 2 * joint] *= factor;
}

static inline void air_spoil(const struct air_break *const broken, struct dig_sample *const sample)
{
    const int head = DIG_SIGNAL_BOOM_HEAD_Pa + 2 * broken->of;
    const int with = DIG_SIGNAL_BOOM_HEAD_Pa + 2 * broken->with;
    if (broken->kind == AIR_TURNED) {
        sample->value[DIG_SIGNAL_BOOM_rad + broken->of] *= -1.0;
    } else if (broken->kind == AIR_ZERO) {
        sample->value[DIG_SIGNAL_BOOM_rad + broken->of] += broken->amount * 0.017453292519943295;
    } else if (broken->kind == AIR_DRIVES) {
        air_swap(sample, head, with);
        air_swap(sample, head + 1, with + 1);
    } else if (broken->kind == AIR_SIDES) {
        air_swap(sample, head, head + 1);
    } else if (broken->kind == AIR_ONE_UNIT || broken->kind == AIR_FACTOR) {
        air_scale(sample, broken->of, broken->amount);
    } else if (broken->kind == AIR_HEAD || broken->kind == AIR_ROD) {
        sample->value[head + (broken->kind == AIR_ROD ? 1 : 0)] += 1e5 * broken->amount;
    }
    for (int j = 0; j < DIG_JOINTS; j++) {
        if (broken->kind == AIR_UNIT) {
            air_scale(sample, j, broken->amount);
        } else if (broken->kind == AIR_DEGREES) {
            sample->value[DIG_SIGNAL_BOOM_rad + j] /= 0.017453292519943295;
        }
    }
}

// Not where the joint began.
static inline bool air_is_away(const struct dig_rig_track *const track, const size_t row,
                               const int joint)
{
    const size_t i = row < track->rows ? row : track->rows - 1;
    return fabs(track->row[i].joints.rad[joint] - track->row[0].joints.rad[joint]) > 1e-9;
}

/// What the machine's sensors read; free with dig_machine_recording_finish(). broken NULL: as they
/// should.
static inline struct dig_machine_recording air_record(const struct dig_machine *const   machine,
                                                      const struct dig_rig_track *const track,
                                                      const struct air_break *const     broken,
                                                      const uint64_t                    seed)
{
    struct dig_machine_recording r     = { 0, malloc(track->rows * sizeof *r.row) };
    struct dig_rig_noise         noise = dig_rig_noise_init(seed);
    const enum air_break_kind    kind  = broken != NULL ? broken->kind : AIR_WHOLE;
    const size_t late  = kind == AIR_LATE ? (size_t)lround(broken->amount / track->step_s) : 0;
    double       stuck = 0.0;
    for (size_t i = 0; i < track->rows; i++) {
        struct dig_rig_row row   = track->row[i > late ? i - late : 0];
        row.joints               = track->row[i].joints;
        const int64_t     ns     = llround((double)r.rows * track->step_s * 1e9) + 1;
        struct dig_sample sample = dig_rig_sense(machine, &row, ns, &noise);
        dig_rig_quantise(machine, &sample);
        if (kind != AIR_WHOLE) {
            air_spoil(broken, &sample);
        }
        if (kind == AIR_STILL &&
            (air_is_away(track, i, broken->of) || air_is_away(track, i + 1, broken->of))) {
            continue;
        }
        if (kind == AIR_GAP && i * 2 > track->rows) {
            sample.time_ns += 1000000000;
        }
        if (kind == AIR_STUCK) {
            double *const at = &sample.value[DIG_SIGNAL_BOOM_HEAD_Pa + 2 * broken->of];
            stuck            = i * 2 == track->rows - track->rows % 2 ? *at : stuck;
            *at              = i * 2 > track->rows ? stuck : *at;
        }
        if (kind == AIR_LOST && i % 10 < (size_t)(10.0 * broken->amount)) {
            sample.valid[DIG_SIGNAL_ARM_HEAD_Pa] = false;
            sample.value[DIG_SIGNAL_ARM_HEAD_Pa] = 0.0;
        }
        r.row[r.rows++] = sample;
    }
    return r;
}

/// The file that is checked.
static inline struct dig_machine air_file(const struct dig_machine *const machine,
                                          const struct air_break *const   broken)
{
    struct dig_machine file = *machine;
    if (broken != NULL && broken->kind == AIR_WEIGHT) {
        file.link[broken->of].mass_kg *= broken->amount;
    }
    return file;
}

#endif // DIG_TESTS_BROKEN_AIR_H

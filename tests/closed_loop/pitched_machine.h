// A level machine's recording as one that stands pitched would have made it, on level ground or on
// ground that is pitched as it is.

#ifndef DIG_TESTS_CLOSED_LOOP_PITCHED_MACHINE_H
#define DIG_TESTS_CLOSED_LOOP_PITCHED_MACHINE_H

#include "core/recording.h"
#include "tests/testlib.h"
#include "tools/rig/motion/mechanism.h"
#include "tools/rig/motion/track.h"

static inline double push_N(const struct dig_machine *const which, const int j,
                            const double head_Pa, const double rod_Pa)
{
    const struct dig_cylinder *const c = &which->cylinder[j];
    return c->count * (head_Pa * dig_cylinder_head_m2(c) - rod_Pa * dig_cylinder_rod_m2(c));
}

// Makes one row's true pressures those that push so much more.
static inline void push_more(const struct dig_machine *const which, struct dig_rig_row *const row,
                             const int j, const double more_N)
{
    struct dig_rig_pushes pushes;
    for (int k = 0; k < DIG_JOINTS; k++) {
        pushes.N[k] = push_N(which, k, row->pressures.head_Pa[k], row->pressures.rod_Pa[k]);
    }
    pushes.N[j] += more_N;
    dig_rig_work_pressures(which, &pushes, &row->pressures);
}

// What a drive holds more where the links' weights pull another way, nose up by so much: by their
// work over a small turn of the joint.
static inline double pitch_N(const struct dig_machine *const    which,
                             const struct dig_rig_joints *const joints, const int j,
                             const double rad)
{
    if (!(fabs(rad) > 0.0)) {
        return 0.0;
    }
    double                     lever_m;
    double                     work_J = 0.0;
    const struct dig_rig_front at     = dig_rig_front_at(which, joints);
    struct dig_rig_joints      turned = *joints;
    turned.rad[j] += 1e-5;
    const struct dig_rig_front to = dig_rig_front_at(which, &turned);
    for (int k = 0; k < DIG_JOINTS; k++) {
        const struct dig_vec2 by = dig_vec2_sub(to.com_m[k], at.com_m[k]);
        work_J += 9.81 * which->link[k].mass_kg * (sin(rad) * by.x + (cos(rad) - 1.0) * by.y);
    }
    assert_int_equal(dig_rig_lever_m(which, (enum dig_joint)j, joints->rad[j], &lever_m), DIG_OK);
    return work_J / 1e-5 / lever_m;
}

// Nose up by so much, all that hangs on the boom's pin as before: the boom is folded by as much,
// and its drive, at another lever, pushes as much about the pin.
static inline void stand_pitched(const struct dig_machine *const which, const double pitch_rad,
                                 struct dig_machine_recording *const r)
{
    for (size_t i = 0; i < r->rows; i++) {
        double *const value = r->row[i].value;
        double        was_m, is_m;
        assert_int_equal(dig_rig_lever_m(which, DIG_JOINT_BOOM, value[DIG_SIGNAL_BOOM_rad], &was_m),
                         DIG_OK);
        value[DIG_SIGNAL_BOOM_rad] -= pitch_rad;
        assert_int_equal(dig_rig_lever_m(which, DIG_JOINT_BOOM, value[DIG_SIGNAL_BOOM_rad], &is_m),
                         DIG_OK);
        value[DIG_SIGNAL_BOOM_HEAD_Pa] *= was_m / is_m;
        value[DIG_SIGNAL_BOOM_ROD_Pa] *= was_m / is_m;
        value[DIG_SIGNAL_PITCH_rad]           = pitch_rad;
        r->row[i].valid[DIG_SIGNAL_PITCH_rad] = true;
    }
}

#endif // DIG_TESTS_CLOSED_LOOP_PITCHED_MACHINE_H

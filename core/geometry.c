#include "core/geometry.h"

#include "core/linkage.h"
#include "core/units.h"

#include <assert.h>
#include <math.h>
#include <stdbool.h>
#include <stddef.h>

static const double gravity_mps2 = 9.81;

// Plates and teeth reach beyond the pins that a link's length is between, by this much at most.
static const double beyond = 1.25;

// How far the parts of a link lie from its pin at most.
static double reach_m(const struct dig_machine *const machine, const int joint)
{
    const double length_m = machine->link[joint].length_m;
    return machine->sensor.fitted ? length_m + dig_vec2_norm(machine->sensor.place_m)
                                  : beyond * length_m;
}

static void check_mass(const struct dig_machine *const machine, const int joint,
                       struct dig_conditions *const c)
{
    const struct dig_link *const link  = &machine->link[joint];
    const char *const            name  = dig_joint_name((enum dig_joint)joint);
    const double                 far_m = reach_m(machine, joint);
    dig_require(c, dig_vec2_norm(link->com_m) <= far_m,
                "%s.com_m: %.4g m from the pin, expected at most the %.4g m that the %s reaches",
                name, dig_vec2_norm(link->com_m), far_m, name);
    const double most_kgm2 = link->mass_kg * far_m * far_m;
    dig_require(c, link->inertia_kgm2 <= most_kgm2,
                "%s.inertia_kgm2: %.4g, expected at most mass_kg times %.4g m squared, %.4g, about "
                "the centre of mass",
                name, link->inertia_kgm2, far_m, most_kgm2);
}

// min_deg and max_deg given in radians are a range of two or three degrees.
static void check_range(const struct dig_machine *const machine, const int joint,
                        struct dig_conditions *const c)
{
    static const double          least_deg = 10.0;
    const struct dig_link *const link      = &machine->link[joint];
    const double                 range_deg = (link->max_rad - link->min_rad) / DIG_RAD_PER_DEG;
    dig_require(c, range_deg >= least_deg,
                "%s.max_deg: %.3g degrees above min_deg, expected %g or more",
                dig_joint_name((enum dig_joint)joint), range_deg, least_deg);
}

static void check_whole(const struct dig_machine *const machine, struct dig_conditions *const c)
{
    const double most_m   = 2.0 * machine->link[DIG_JOINT_ARM].length_m;
    const double bucket_m = machine->link[DIG_JOINT_BUCKET].length_m;
    dig_require(c, bucket_m <= most_m,
                "bucket.length_m: %.4g, expected at most twice the arm's, %.4g", bucket_m, most_m);
    double front_N = 0.0;
    for (int j = 0; j < DIG_JOINTS; j++) {
        front_N += gravity_mps2 * machine->link[j].mass_kg;
    }
    dig_require(c, machine->weight_N > front_N,
                "ground.weight_N: %.4g, expected more than the %.4g N of boom, arm and bucket, "
                "which it does not hold",
                machine->weight_N, front_N);
}

// A drive at one angle of its joint.
struct pose {
    double           at_deg;
    struct dig_lever lever;
};

// The poses of a joint's range where its cylinder is shortest and longest; of those that its stops
// let it come to, where its lever, with its sign, is least and greatest, and how many of all.
struct extremes {
    struct pose shortest, longest, low, high;
    double      share;
};

static double spare_m(const struct pose *const pose)
{
    return DIG_GEOMETRY_ANGLE_TOLERANCE_rad * fabs(pose->lever.arm_m);
}

static bool is_within(const struct dig_cylinder *const cylinder, const struct pose *const pose)
{
    return pose->lever.length_m >= cylinder->min_length_m - spare_m(pose) &&
           pose->lever.length_m <= cylinder->max_length_m + spare_m(pose);
}

static void find_extremes(const struct dig_machine *const machine, const int joint,
                          struct extremes *const extremes, struct dig_conditions *const c)
{
    enum { STEPS = 512 };
    const struct dig_link *const link   = &machine->link[joint];
    struct extremes              e      = { .share = 0.0 };
    int                          within = 0;
    for (int i = 0; c->status == DIG_OK && i <= STEPS; i++) {
        const double at_rad = link->min_rad + (link->max_rad - link->min_rad) * (double)i / STEPS;
        struct pose  pose   = { .at_deg = at_rad / DIG_RAD_PER_DEG };
        dig_require(
            c, dig_lever_solve(machine, (enum dig_joint)joint, at_rad, &pose.lever) == DIG_OK,
            "%s: its linkage does not close at %.2f deg, expected that it does from min_deg to "
            "max_deg",
            joint == DIG_JOINT_BUCKET ? "four_bar" : dig_joint_name((enum dig_joint)joint),
            pose.at_deg);
        const struct dig_lever *const now = &pose.lever;
        e.shortest = i == 0 || now->length_m < e.shortest.lever.length_m ? pose : e.shortest;
        e.longest  = i == 0 || now->length_m > e.longest.lever.length_m ? pose : e.longest;
        if (is_within(&machine->cylinder[joint], &pose)) {
            e.low  = within == 0 || now->arm_m < e.low.lever.arm_m ? pose : e.low;
            e.high = within == 0 || now->arm_m > e.high.lever.arm_m ? pose : e.high;
            within++;
        }
    }
    e.share   = (double)within / (STEPS + 1);
    *extremes = e;
}

static void check_stroke(const struct dig_cylinder *const cylinder,
                         const struct extremes *const seen, const char *const name,
                         struct dig_conditions *const c)
{
    dig_require(c, cylinder->max_length_m < 2.0 * cylinder->min_length_m,
                "cylinders.%s.max_length_m: %.4g, expected less than twice min_length_m, %.4g: the "
                "rod must go into the tube",
                name, cylinder->max_length_m, 2.0 * cylinder->min_length_m);
    dig_require(c, seen->share >= DIG_GEOMETRY_LEAST_RANGE,
                "cylinders.%s.max_length_m: from %.4g to %.4g, expected to move the %s through "
                "half of min_deg to max_deg at least, where it is %.4g long at %.2f deg and %.4g "
                "at %.2f deg",
                name, cylinder->min_length_m, cylinder->max_length_m, name,
                seen->shortest.lever.length_m, seen->shortest.at_deg, seen->longest.lever.length_m,
                seen->longest.at_deg);
}

static void check_levers(const struct extremes *const seen, const char *const name,
                         struct dig_conditions *const c)
{
    const double low_m  = seen->low.lever.arm_m;
    const double high_m = seen->high.lever.arm_m;
    dig_require(c, low_m > 0.0 || high_m < 0.0,
                "cylinders.%s: a lever of %.3f m at %.2f deg and of %.3f m at %.2f deg, expected "
                "one sign between its stops",
                name, low_m, seen->low.at_deg, high_m, seen->high.at_deg);
    const bool   pushes_up = low_m > 0.0;
    const double least_m   = pushes_up ? low_m : -high_m;
    const double most_m    = pushes_up ? high_m : -low_m;
    dig_require(c, least_m >= DIG_GEOMETRY_LEAST_LEVER * most_m,
                "cylinders.%s: a lever of %.4f m at %.2f deg, expected %.4f or more, a twentieth "
                "of its largest between its stops",
                name, least_m, pushes_up ? seen->low.at_deg : seen->high.at_deg,
                DIG_GEOMETRY_LEAST_LEVER * most_m);
}

enum dig_status dig_geometry_check(const struct dig_machine *const machine,
                                   struct dig_error *const         error)
{
    assert(machine != NULL);
    struct dig_conditions c = { .error = error };
    if (machine->sensor.fitted) {
        check_mass(machine, DIG_JOINT_BUCKET, &c);
        return c.status;
    }
    check_whole(machine, &c);
    for (int j = 0; j < DIG_JOINTS; j++) {
        check_range(machine, j, &c);
    }
    for (int j = 0; j < DIG_JOINTS; j++) {
        check_mass(machine, j, &c);
    }
    for (int j = 0; j < DIG_JOINTS; j++) {
        const char *const name = dig_joint_name((enum dig_joint)j);
        struct extremes   seen = { .shortest = { .at_deg = 0.0 } };
        find_extremes(machine, j, &seen, &c);
        check_stroke(&machine->cylinder[j], &seen, name, &c);
        check_levers(&seen, name, &c);
    }
    return c.status;
}

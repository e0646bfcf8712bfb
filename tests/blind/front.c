#include "tests/blind/front.h"

#include "core/units.h"

#include <complex.h>
#include <math.h>

// C11 makes I of floats.
static const double complex i = (double complex)I;

static double complex place(const struct dig_vec2 v)
{
    return v.x + v.y * i;
}

// The four-bar's corner on the cylinder's side: the crossing of two circles about N and K.
static double complex corner(const struct dig_four_bar *const bar, const double complex n,
                             const double complex k)
{
    const double complex d    = k - n;
    const double         away = cabs(d);
    const double         along =
        (bar->rocker_m * bar->rocker_m - bar->link_m * bar->link_m + away * away) / (2.0 * away);
    const double aside = sqrt(fmax(bar->rocker_m * bar->rocker_m - along * along, 0.0));
    return n + d / away * (along + aside * i);
}

double blind_length_m(const struct dig_machine *const machine, const enum dig_joint joint,
                      const double angle_rad[DIG_JOINTS])
{
    const struct dig_cylinder *const c = &machine->cylinder[joint];
    if (joint == DIG_JOINT_BOOM) {
        return cabs(place(c->eye_m) * cexp(i * angle_rad[DIG_JOINT_BOOM]) - place(c->base_m));
    }
    const double complex end =
        machine->link[joint == DIG_JOINT_ARM ? DIG_JOINT_BOOM : DIG_JOINT_ARM].length_m;
    const double complex turn = cexp(i * angle_rad[joint]);
    if (joint == DIG_JOINT_ARM) {
        return cabs(end + place(c->eye_m) * turn - place(c->base_m));
    }
    const struct dig_four_bar *const bar = &machine->four_bar;
    const double complex m = corner(bar, place(bar->rocker_pin_m), end + place(bar->ear_m) * turn);
    return cabs(m - place(c->base_m));
}

double blind_lever_m(const struct dig_machine *const machine, const enum dig_joint joint,
                     const double angle_rad[DIG_JOINTS])
{
    const double step = 1e-4;
    double       q[DIG_JOINTS];
    for (int j = 0; j < DIG_JOINTS; j++) {
        q[j] = angle_rad[j];
    }
    q[joint] += step;
    const double more = blind_length_m(machine, joint, q);
    q[joint] -= 2.0 * step;
    return (more - blind_length_m(machine, joint, q)) / (2.0 * step);
}

struct dig_vec2 blind_bucket_point(const struct dig_machine *const machine,
                                   const double angle_rad[DIG_JOINTS], const struct dig_vec2 point)
{
    double complex at   = 0.0;
    double complex turn = 1.0;
    for (int j = 0; j < DIG_JOINTS; j++) {
        turn *= cexp(i * angle_rad[j]);
        at += turn * (j == DIG_JOINT_BUCKET ? place(point) : machine->link[j].length_m);
    }
    return (struct dig_vec2){ creal(at), cimag(at) };
}

static double disc_m2(const double diameter_m)
{
    return DIG_PI / 4.0 * diameter_m * diameter_m;
}

double blind_push_N(const struct dig_cylinder *const cylinder, const double head_Pa,
                    const double rod_Pa)
{
    return cylinder->count * (head_Pa * disc_m2(cylinder->bore_m) -
                              rod_Pa * (disc_m2(cylinder->bore_m) - disc_m2(cylinder->rod_m)));
}

void blind_pressures(const struct dig_cylinder *const cylinder, const double push_N,
                     double *const head_Pa, double *const rod_Pa)
{
    const double head_m2 = disc_m2(cylinder->bore_m);
    const double ring_m2 = head_m2 - disc_m2(cylinder->rod_m);
    const double each_N  = push_N / cylinder->count;
    const double excess  = each_N - cylinder->back_Pa * (head_m2 - ring_m2);
    *head_Pa             = cylinder->back_Pa + fmax(excess, 0.0) / head_m2;
    *rod_Pa              = cylinder->back_Pa + fmax(-excess, 0.0) / ring_m2;
}

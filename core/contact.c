#include "core/contact.h"

#include "core/units.h"

#include <math.h>

#define RAYLEIGH_SHARE    0.14
#define STEPS_PER_CONTACT 20.0

// Contacts of a grain in a dense bed, nearly the most.
#define DAMPING_CONTACTS 8.0

static struct dig_contact_springs hooke(const struct dig_material *const material,
                                        const double radius_m, const double mass_kg)
{
    const double young_Pa =
        material->young_Pa / (2.0 * (1.0 - material->poisson * material->poisson));
    const double hertz      = 16.0 / 15.0 * sqrt(radius_m) * young_Pa;
    const double velocity   = material->characteristic_velocity_mps;
    const double normal_Npm = hertz * pow(mass_kg * velocity * velocity / hertz, 0.2);
    const double ratio      = DIG_PI / log(material->restitution);
    const double damping    = sqrt(4.0 * mass_kg * normal_Npm / (1.0 + ratio * ratio));
    return (struct dig_contact_springs){ normal_Npm, damping, normal_Npm, damping };
}

static struct dig_contact_springs hertz(const struct dig_material *const material,
                                        const double radius_m, const double mass_kg)
{
    const double nu       = material->poisson;
    const double young_Pa = material->young_Pa / (2.0 * (1.0 - nu * nu));
    const double shear_Pa = material->young_Pa / (4.0 * (2.0 - nu) * (1.0 + nu));
    const double log_e    = log(material->restitution);
    const double share    = -log_e / sqrt(log_e * log_e + DIG_PI * DIG_PI);
    const double damping  = 2.0 * sqrt(5.0 / 6.0) * share;
    const double root_m   = sqrt(radius_m);

    const double tangential_Npm = 8.0 * shear_Pa * root_m;
    return (struct dig_contact_springs){
        .normal_Npm              = 4.0 / 3.0 * young_Pa * root_m,
        .damping_Nspm            = damping * sqrt(2.0 * young_Pa * root_m * mass_kg),
        .tangential_Npm          = tangential_Npm,
        .tangential_damping_Nspm = damping * sqrt(tangential_Npm * mass_kg),
    };
}

struct dig_contact_springs dig_contact_springs(const struct dig_material *const material,
                                               const enum dig_normal_law        normal,
                                               const double radius_m, const double mass_kg)
{
    return normal == DIG_NORMAL_HERTZ ? hertz(material, radius_m, mass_kg)
                                      : hooke(material, radius_m, mass_kg);
}

// Half a period of a contact of two like grains, and the largest tangential damping in it.
struct contact {
    double time_s;
    double damping_Nspm;
};

static struct contact hooke_contact(const struct dig_contact_springs *const springs,
                                    const double                            mass_kg)
{
    return (struct contact){
        .time_s       = DIG_PI * sqrt(mass_kg / springs->normal_Npm),
        .damping_Nspm = springs->tangential_damping_Nspm,
    };
}

// An undamped impact of Hertz's spheres: (5 m* v^2 / 4 k)^2/5 deep, 2.9432 depths / v long.
static struct contact hertz_contact(const struct dig_contact_springs *const springs,
                                    const double mass_kg, const double speed_mps)
{
    const double deepest_m =
        pow(1.25 * mass_kg * speed_mps * speed_mps / springs->normal_Npm, 2.0 / 5.0);
    return (struct contact){
        .time_s       = 2.9432 * deepest_m / speed_mps,
        .damping_Nspm = springs->tangential_damping_Nspm * pow(deepest_m, 0.25),
    };
}

double dig_contact_step_s(const struct dig_material *const material,
                          const enum dig_normal_law normal, const double density_kgpm3)
{
    const double radius_m = 0.5 * material->diameter_m;
    const double mass_kg  = density_kgpm3 * 4.0 / 3.0 * DIG_PI * radius_m * radius_m * radius_m;
    // Rayleigh wave over half a circumference.
    const double shear_Pa = material->young_Pa / (2.0 * (1.0 + material->poisson));
    const double rayleigh_s =
        DIG_PI * radius_m * sqrt(density_kgpm3 / shear_Pa) / (0.1631 * material->poisson + 0.8766);
    // Of two like grains.
    const double                     star_m  = radius_m * radius_m / (radius_m + radius_m);
    const double                     star_kg = mass_kg * mass_kg / (mass_kg + mass_kg);
    const struct dig_contact_springs springs =
        dig_contact_springs(material, normal, star_m, star_kg);
    const struct contact contact =
        normal == DIG_NORMAL_HERTZ
            ? hertz_contact(&springs, 0.5 * mass_kg, material->characteristic_velocity_mps)
            : hooke_contact(&springs, 0.5 * mass_kg);
    // Tangential damping reduces the spin of a grain with 8 contacts at a rate of 8 x 2/3 x gamma
    // r^2 / I; a neighbour of the same spin doubles it. Beyond 2 / rate the spin flips at every
    // step.
    const double damping_s =
        2.0 * 0.4 * mass_kg / (DAMPING_CONTACTS * 2.0 / 3.0 * 2.0 * contact.damping_Nspm);
    return fmin(fmin(RAYLEIGH_SHARE * rayleigh_s, contact.time_s / STEPS_PER_CONTACT), damping_s);
}

double dig_contact_stiffness_power(const struct dig_material *const material,
                                   const enum dig_normal_law        normal)
{
    const double of_fixed = normal == DIG_NORMAL_HERTZ ? 1.0 / 3.0 : 0.2;
    return material->young_at_kgpm3 > 0.0 ? 1.0 : of_fixed;
}

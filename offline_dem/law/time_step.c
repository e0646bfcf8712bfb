#include "offline_dem/law/time_step.h"

#include "core/units.h"

#include <math.h>

#define RAYLEIGH_SHARE    0.14
#define STEPS_PER_CONTACT 20.0

// Contacts of a grain in a dense bed, nearly the most.
#define DAMPING_CONTACTS 8.0

// Half a period of a contact of two like grains, and the largest tangential damping in it.
struct contact {
    double time_s;
    double damping_Nspm;
};

static struct contact hooke_contact(const struct dig_law *const law, const double mass_kg)
{
    return (struct contact){
        .time_s       = DIG_PI * sqrt(mass_kg / law->normal_Npm),
        .damping_Nspm = law->tangential_damping_Nspm,
    };
}

// An undamped impact of Hertz's spheres: (5 m* v^2 / 4 k)^2/5 deep, 2.9432 depths / v long.
static struct contact hertz_contact(const struct dig_law *const law, const double mass_kg,
                                    const double speed_mps)
{
    const double deepest_m =
        pow(1.25 * mass_kg * speed_mps * speed_mps / law->normal_Npm, 2.0 / 5.0);
    return (struct contact){
        .time_s       = 2.9432 * deepest_m / speed_mps,
        .damping_Nspm = law->tangential_damping_Nspm * pow(deepest_m, 0.25),
    };
}

double dig_time_step_limit_s(const struct dig_law_material *const material, const double radius_m,
                             const double density_kgpm3)
{
    const double mass_kg = density_kgpm3 * 4.0 / 3.0 * DIG_PI * radius_m * radius_m * radius_m;
    // Rayleigh wave over half a circumference.
    const double shear_Pa = material->young_Pa / (2.0 * (1.0 + material->poisson));
    const double rayleigh_s =
        DIG_PI * radius_m * sqrt(density_kgpm3 / shear_Pa) / (0.1631 * material->poisson + 0.8766);
    const struct dig_law law = dig_law_pair(material, radius_m, radius_m, mass_kg, mass_kg);
    const struct contact contact =
        law.hertz ? hertz_contact(&law, 0.5 * mass_kg, material->characteristic_velocity_mps)
                  : hooke_contact(&law, 0.5 * mass_kg);
    // Tangential damping reduces the spin of a grain with 8 contacts at a rate of 8 x 2/3 x gamma
    // r^2 / I; a neighbour of the same spin doubles it. Beyond 2 / rate the spin flips at every
    // step.
    const double damping_s =
        2.0 * 0.4 * mass_kg / (DAMPING_CONTACTS * 2.0 / 3.0 * 2.0 * contact.damping_Nspm);
    return fmin(fmin(RAYLEIGH_SHARE * rayleigh_s, contact.time_s / STEPS_PER_CONTACT), damping_s);
}

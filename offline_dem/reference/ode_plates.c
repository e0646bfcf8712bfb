#include "offline_dem/reference/ode_plates.h"

#include "offline_dem/shapes/bucket_surface.h"

#include <math.h>

// Numbers of plates in the contact history, beyond any grain's and any wall's.
#define PLATE_NUMBER 0xFFFF8000U

struct candidate {
    double closest_m[3];
    double distance_m;
    size_t plate;
};

static size_t find_candidates(const struct dig_tool *const tool, const double body_m[3],
                              const double radius_m, struct candidate found[])
{
    size_t count = 0;
    for (size_t plate = 0; plate < tool->plates; plate++) {
        struct candidate *const c = &found[count];
        dig_bucket_closest(&tool->bucket, plate, body_m, c->closest_m);
        c->distance_m = dig_bucket_distance(body_m, c->closest_m);
        c->plate      = plate;
        count += c->distance_m < radius_m;
    }
    return count;
}

static void take_history(struct dig_ode_plate_contact *const contact, const uint32_t grain,
                         const size_t plate, const struct dig_ode_history *const map)
{
    const struct dig_contact_history *const was =
        dig_ode_history_previous(map, grain, PLATE_NUMBER + (uint32_t)plate);
    const struct dig_contact_history *const m = &contact->history;
    const double known = fabs(m->sx_m) + fabs(m->sy_m) + fabs(m->sz_m) + fabs(m->mx_Nm) +
                         fabs(m->my_Nm) + fabs(m->mz_Nm);
    if (was != NULL && !(known > 0.0)) {
        contact->history = *was;
    }
}

// The nearer plate on which c's closest point lies: c is no minimum there.
static const struct candidate *find_closer(const struct dig_tool *const tool,
                                           const struct candidate found[], const size_t count,
                                           const struct candidate *const c, const double same_m)
{
    for (size_t k = 0; k < count; k++) {
        double on[3];
        dig_bucket_closest(&tool->bucket, found[k].plate, c->closest_m, on);
        if (found[k].distance_m < c->distance_m - same_m &&
            dig_bucket_distance(on, c->closest_m) <= same_m) {
            return &found[k];
        }
    }
    return NULL;
}

static void add(struct dig_ode_plate_contact contact[], size_t *const contacts,
                const struct candidate *const c, const double same_m)
{
    size_t k = 0;
    while (k < *contacts && dig_bucket_distance(contact[k].closest_m, c->closest_m) > same_m) {
        k++;
    }
    if (k == *contacts) {
        contact[k] = (struct dig_ode_plate_contact){
            .closest_m = { c->closest_m[0], c->closest_m[1], c->closest_m[2] },
        };
        (*contacts)++;
    }
    contact[k].plate[contact[k].plates++] = c->plate;
}

size_t dig_ode_plates_find(const struct dig_tool *const tool, const double body_m[3],
                           const double radius_m, const uint32_t grain,
                           const struct dig_ode_history *const map,
                           struct dig_ode_plate_contact        contact[DIG_PLATES_MAX])
{
    const double            same_m                    = 1e-6 * radius_m;
    struct candidate        found[DIG_PLATES_MAX + 1] = { { { 0.0 }, 0.0, 0 } };
    const struct candidate *closer[DIG_PLATES_MAX];
    const size_t            count    = find_candidates(tool, body_m, radius_m, found);
    size_t                  contacts = 0;
    for (size_t k = 0; k < count; k++) {
        closer[k] = find_closer(tool, found, count, &found[k], same_m);
        if (closer[k] == NULL) {
            add(contact, &contacts, &found[k], same_m);
        }
    }
    // A contact takes the history of its own plates; else that of the plates it came over from.
    for (size_t t = 0; t < contacts; t++) {
        for (size_t p = 0; p < contact[t].plates; p++) {
            take_history(&contact[t], grain, contact[t].plate[p], map);
        }
        for (size_t k = 0; k < count; k++) {
            for (size_t p = 0; closer[k] != NULL && p < contact[t].plates; p++) {
                if (closer[k]->plate == contact[t].plate[p]) {
                    take_history(&contact[t], grain, found[k].plate, map);
                }
            }
        }
    }
    return contacts;
}

bool dig_ode_plates_store(const struct dig_ode_plate_contact *const contact, const uint32_t grain,
                          struct dig_ode_history *const map)
{
    for (size_t p = 0; p < contact->plates; p++) {
        struct dig_contact_history *const history =
            dig_ode_history_of(map, grain, PLATE_NUMBER + (uint32_t)contact->plate[p]);
        if (history == NULL) {
            return false;
        }
        *history = contact->history;
    }
    return true;
}

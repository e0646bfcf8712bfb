// Contacts of one grain with the tool's plates. Inlined into the kernel's surfaces.c, the device's
// step and the ODE engine.
//
// Plates share edges. A grain touches the tool where its distance to all plates together has a
// local minimum: a plate's edge counts only if the neighbouring plate comes no closer there, and an
// edge two plates share is one contact. In a concave corner a grain lies on two faces: two
// contacts. A contact that passes over an edge from plate to plate keeps its history.

#ifndef DIG_OFFLINE_DEM_SHAPES_PLATE_CONTACTS_H
#define DIG_OFFLINE_DEM_SHAPES_PLATE_CONTACTS_H

#include "offline_dem/law/law.h"
#include "offline_dem/shapes/bucket_surface.h"
#include "offline_dem/shapes/tool.h"

/// The plates near a grain, ascending; touched: closer than its radius, and in the end a contact.
struct dig_plate_contacts {
    size_t                     count;
    size_t                     plate[DIG_PLATES_MAX];
    bool                       touched[DIG_PLATES_MAX];
    double                     closest_m[DIG_PLATES_MAX][3]; // body frame
    double                     distance_m[DIG_PLATES_MAX];
    struct dig_contact_history history[DIG_PLATES_MAX]; // read by dig_plate_contacts_resolve()
};

/// Appends a plate. Returns whether it is touched.
DIG_BOTH static inline bool dig_plate_contacts_add(const struct dig_bucket *const bucket,
                                                   const size_t plate, const double body_m[3],
                                                   const double                     radius_m,
                                                   struct dig_plate_contacts *const near)
{
    const size_t k = near->count++;
    dig_bucket_closest(bucket, plate, body_m, near->closest_m[k]);
    near->plate[k]      = plate;
    near->distance_m[k] = dig_bucket_distance(body_m, near->closest_m[k]);
    near->touched[k]    = near->distance_m[k] < radius_m;
    return near->touched[k];
}

DIG_BOTH static inline bool dig_plate_contacts_lasted(const struct dig_contact_history *const h)
{
    return fabs(h->sx_m) > 0.0 || fabs(h->sy_m) > 0.0 || fabs(h->sz_m) > 0.0 ||
           fabs(h->mx_Nm) > 0.0 || fabs(h->my_Nm) > 0.0 || fabs(h->mz_Nm) > 0.0;
}

/// Leaves the local minima of the distance to the whole tool, with their histories. Needed where
/// more than one plate is touched.
DIG_BOTH static inline void dig_plate_contacts_resolve(const struct dig_bucket *const   bucket,
                                                       const double                     radius_m,
                                                       struct dig_plate_contacts *const near)
{
    const double same_m = 1e-6 * radius_m;
    for (size_t p = 0; p < near->count; p++) {
        for (size_t q = 0; q < near->count && near->touched[p]; q++) {
            if (q == p || !near->touched[q] || near->distance_m[q] > near->distance_m[p] + same_m) {
                continue;
            }
            // Does p's closest point lie on q as well?
            double on_q[3];
            dig_bucket_closest(bucket, near->plate[q], near->closest_m[p], on_q);
            if (dig_bucket_distance(on_q, near->closest_m[p]) > same_m) {
                continue;
            }
            // On a tie the contact stays with the plate that had it; else with the first.
            const bool tie    = near->distance_m[q] > near->distance_m[p] - same_m;
            const bool lasted = dig_plate_contacts_lasted(&near->history[q]);
            if (tie && (dig_plate_contacts_lasted(&near->history[p]) || (!lasted && p < q))) {
                near->touched[q] = false;
                continue;
            }
            if (!lasted) {
                near->history[q] = near->history[p];
            }
            near->touched[p] = false;
        }
    }
}

#endif // DIG_OFFLINE_DEM_SHAPES_PLATE_CONTACTS_H

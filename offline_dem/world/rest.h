// The active set: grains at rest far from the tool are held still, so that the law is worked out
// only where something moves.
//
// A held grain keeps its place and has no velocity. Contacts between two held grains, or a held
// grain and a wall, stand aside with what they remember, untouched. Every DIG_REST_STEPS steps all
// contacts are worked out once, those that stand aside too, and
//   * a held grain whose forces do not cancel - more than world->freeze x its squeeze is left over,
//     as force or as torque over its radius - or that the tool has come near, is let go, and with
//     it the held grains it touches;
//   * a grain that has moved less than a creep for some looks on end, whose forces cancel and that
//     the tool is not near, is held.
// The squeeze is a quarter of the sum of the normal forces on the grain, at least its weight. So
// between two looks no force of a contact is worked out from positions that are wrong by more than
// the creep; what a held grain may carry without answering is bounded by freeze x its squeeze.
// With freeze 0, or with bodies in the world, no grain is ever held and nothing is approximate.

#ifndef DIG_OFFLINE_DEM_WORLD_REST_H
#define DIG_OFFLINE_DEM_WORLD_REST_H

#include "core/status.h"
#include "offline_dem/shapes/tool.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct dig_world;

/// What is known of one grain.
struct dig_rest_grain {
    double   at_m[3]; // at the last look
    double   squeeze_N;
    uint32_t calm;  // looks on end without moving
    bool     held;  // still, until a look lets it go
    bool     loose; // has a pair that is not held
};

struct dig_rest {
    struct dig_rest_grain *grain; // [grains]; NULL: never looked, no grain is held
    uint32_t              *awake; // [awakes] grains that are not held, ascending
    size_t                 awakes;
    size_t                 grains;  // the arrays were made for
    bool                   changed; // since the lists were made
};

/// Whether this world holds grains still at all.
bool dig_rest_is_on(const struct dig_world *world);

static inline bool dig_rest_holds(const struct dig_rest *const rest, const size_t i)
{
    return rest->grain != NULL && rest->grain[i].held;
}

/// Whether the step about to be done ends with a look: all contacts are to be worked out.
bool dig_rest_is_due(const struct dig_world *world);

/// The look: with the loads of all contacts, before the grains move. Grains it holds have no
/// velocity afterwards; lists are stale if the set changed. DIG_ENOMEM: as it was.
DIG_MUST_CHECK enum dig_status dig_rest_look(struct dig_world *world);

/// Marks the grains some contact of which is worked out at every step; after the neighbour list or
/// the set has changed.
void dig_rest_mark(struct dig_world *world);

/// Follows grains to new places, as dig_lists_move(). DIG_ENOMEM: nothing is held any more.
DIG_MUST_CHECK enum dig_status dig_rest_move(struct dig_world *world, const uint32_t place[]);

/// Lets every grain go.
void dig_rest_finish(struct dig_rest *rest);

#endif // DIG_OFFLINE_DEM_WORLD_REST_H

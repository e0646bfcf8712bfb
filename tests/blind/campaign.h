// One blind campaign: which effects, which digs, and the folder that a trace is given.

#ifndef DIG_TESTS_BLIND_CAMPAIGN_H
#define DIG_TESTS_BLIND_CAMPAIGN_H

#include "core/machine.h"
#include "tests/blind/grid.h"
#include "tests/blind/inject.h"
#include "tests/blind/pool.h"
#include "tests/blind/soil.h"

#define BLIND_DIGS_MAX    10
#define BLIND_EFFECTS_MAX 2
#define BLIND_MACHINES    2

enum blind_kind { BLIND_NONE, BLIND_SINGLE, BLIND_PAIR, BLIND_OUTSIDE, BLIND_KINDS };

/// An effect to put in: of the machine, of the ground by formula, or a group of the pool.
enum blind_how { BLIND_BY_MACHINE, BLIND_BY_GROUND, BLIND_BY_POOL };

struct blind_choice {
    char           name[DIG_NAME_SIZE];
    enum blind_how how;
    int            which; // the enum of its kind
    bool           outside;
};

/// What is asked for.
struct blind_order {
    uint64_t            seed, number;
    enum blind_kind     kind;
    size_t              effects;
    struct blind_choice effect[BLIND_EFFECTS_MAX];
    int                 strength;
};

struct blind_dig {
    size_t             bed;
    bool               plain_bed; // of the plain group, though the campaign has another
    enum blind_path    path;
    int                role; // 0 identify, 1 fit, 2 holdout
    unsigned           pass;
    double             pace;
    struct blind_curve without; // moment of the ground as it was dug, before formulas
    struct blind_curve with;    // as the uncorrected model sees it, without sensor noise
    struct blind_curve alone[BLIND_EFFECTS_MAX]; // with that effect only; the pool's is in without
    // Free air of this dig: rms of what an effect adds to a joint's moment over 1 sigma of what the
    // sensors make of it, both smoothed; of the joint that shows most. 0 for force recordings.
    double air[BLIND_EFFECTS_MAX];
};

struct blind_campaign {
    struct blind_order        order;
    const struct blind_group *group; // whose digs these are
    const struct blind_group *plain; // its plain fellow, NULL when there is none
    bool                      by_machine;
    struct dig_machine        machine;
    char                      machine_path[512];
    double                    lambda;
    size_t                    digs;
    struct blind_dig          dig[BLIND_DIGS_MAX];
    struct blind_fault        fault[BLIND_EFFECTS_MAX]; // by the order of effects, where it is one
    struct blind_ground       ground[BLIND_EFFECTS_MAX];
};

/// Where things are.
struct blind_site {
    const struct blind_pool     *pool;
    const struct dig_trajectory *trajectory[BLIND_PATHS];
    double                       tooth_m;
    const char                  *scene;  // absolute
    const char                  *digrig; // program
    const char                  *cache;  // folder for exact machine recordings
    struct dig_machine           machine[BLIND_MACHINES];
    char                         machine_path[BLIND_MACHINES][512]; // absolute
};

/// Draws the campaign and writes it into folder, which exists. DIG_ENOMATCH: the pool has no digs
/// for it.
DIG_MUST_CHECK enum dig_status
blind_campaign_make(const struct blind_site *site, const struct blind_order *order,
                    const char *folder, struct blind_campaign *campaign, struct dig_error *error);

#endif // DIG_TESTS_BLIND_CAMPAIGN_H

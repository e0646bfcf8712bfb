// What somebody who knows the truth makes of a blind campaign: how large its effect is, and how
// well the held out digs can be predicted at all.
//
//   size = sqrt( sum over fit digs of integral (D - (T(g) - T(g0)))^2 dt
//              / sum over fit digs of integral sd^2 (1/digs + 1/packings) dt ),  g: the best
//
// D: what the effect adds to the moment of a trajectory, mean over digs; T: the table; g0: the
// gravel the table comes nearest to the plain digs with; sd: of one dig about the table's mean;
// digs: along that trajectory; packings: of the table there.

#ifndef DIG_TESTS_BLIND_ORACLE_H
#define DIG_TESTS_BLIND_ORACLE_H

#include "core/error.h"
#include "tests/blind/campaign.h"

struct blind_oracle; // the table on a fine grid of gravels

/// Interpolates the table, which lives longer. DIG_EINVAL: it lacks a trajectory of the bench.
DIG_MUST_CHECK enum dig_status blind_oracle_create(const struct dig_curve_set *set,
                                                   struct blind_oracle       **oracle,
                                                   struct dig_error           *error);

void blind_oracle_destroy(struct blind_oracle *oracle);

/// By effect of the campaign, in its order.
struct blind_truth {
    double size[BLIND_EFFECTS_MAX];     // of what the soil shows, as above
    double size_air[BLIND_EFFECTS_MAX]; // of what free air shows: see struct blind_dig, rss of digs
    double error; // of the held out digs, docs/numerics.md, with the effects known
};

/// DIG_ENOMATCH: the table has no gravel for it.
DIG_MUST_CHECK enum dig_status blind_oracle_judge(const struct blind_oracle   *oracle,
                                                  const struct blind_campaign *campaign,
                                                  struct blind_truth          *truth);

#endif // DIG_TESTS_BLIND_ORACLE_H

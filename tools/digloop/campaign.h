// A campaign folder as the closed loop wants it: its digs measured, its machine's samples at hand.

#ifndef DIG_TOOLS_DIGLOOP_CAMPAIGN_H
#define DIG_TOOLS_DIGLOOP_CAMPAIGN_H

#include "closed_loop/machine/machine_side.h"
#include "closed_loop/recordings/measured.h"
#include "core/curve.h"
#include "core/error.h"
#include "tools/digloop/commands.h"

struct digloop_campaign {
    size_t                   digs;
    double                   lambda;   // size of what dug over the table's
    struct dig_measured     *measured; // [digs], malloc'ed
    struct dig_machine_side *machine;  // NULL: the digs are force recordings
};

/// Reads campaign.yaml of the folder that the job names, its recordings and its machine. Refuses a
/// scene that is not similar to that of the table, a file, and a machine whose bucket is not of its
/// shape, a dig that is not along the trajectory named for it, force and machine recordings mixed;
/// *error names file and reason. Force recordings in a scene that is the table's at another size
/// are taken to the table's. Free with digloop_campaign_finish().
DIG_MUST_CHECK enum dig_status digloop_campaign_load(const struct digloop_job *job,
                                                     struct digloop_campaign  *campaign,
                                                     struct dig_error         *error);

void digloop_campaign_finish(struct digloop_campaign *campaign);

#endif // DIG_TOOLS_DIGLOOP_CAMPAIGN_H

// The digs of a campaign as the closed loop compares them: on the table's grid of path progress, at
// rig scale, smoothed as the table is.

#ifndef DIG_CLOSED_LOOP_RECORDINGS_MEASURED_H
#define DIG_CLOSED_LOOP_RECORDINGS_MEASURED_H

#include "closed_loop/recordings/features.h"
#include "core/approach.h"
#include "core/curve.h"

#include <stdbool.h>
#include <stddef.h>

/// What a recording may be used for (files/campaign_yaml.h has the same, in the same order).
enum dig_use { DIG_USE_IDENTIFY, DIG_USE_FIT, DIG_USE_HOLDOUT };

#define DIG_MEASURED_MAX 64

/// What a dig at another approach, or off its trajectory, adds to the plain one, as the table has
/// it: N m and N at rig scale, over the plain path.
struct dig_added {
    double value[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
    double error[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS]; // 1 sigma of that, all along the dig alike
    double noise; // as it was dug in few beds, in variances of one dig
};

// What sensors are off by that lasts: 1 sigma of it, and the time of the table's dig in which it
// becomes e times less alike. Zeros: nothing.
struct dig_lasting {
    double sigma[DIG_FORCE_CHANNELS];
    double memory_s;
};

struct dig_measured {
    char         name[64]; // the recording, for people
    size_t       order;    // place in the campaign, 0 …: digs follow each other in this order
    int          trajectory;
    enum dig_use use;
    unsigned     pass; // how often the place was dug, counted from 1
    double       pace; // duration of the table's trajectory / of this dig, both at rig scale

    double              off_path_m;  // of a force recording, from its trajectory: rms
    struct dig_approach approach;    // of a force recording: the nearest that the table holds
    struct dig_approach made;        // as its path tells; zeroed: as the table's, or not told
    double deeper[DIG_CURVE_POINTS]; // recordings/path_depth.h; zeros: along its trajectory
    struct dig_approach taken_off;   // what that adds is no longer in value; zeroed: nothing
    struct dig_added    added;       // that
    // How far its ground may lie elsewhere, of all depths of the table: 0: it is known; 1: anywhere
    // among them, as a machine's, or of a force recording whose path is another.
    double depth_share;

    double first, last;                  // progress range from contact to exit
    bool   measured[DIG_FORCE_CHANNELS]; // which of the channels there are
    double value[DIG_FORCE_CHANNELS]
                [DIG_CURVE_POINTS]; // by the model as it was; 0 where not measured
    double sigma[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS]; // 1 sigma of the sensors, after smoothing
    struct dig_lasting lasting;                         // verdict/trace_work.c tells it
    // What effects of the machine that were found add to value: 0 until any is.
    double machine[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];

    // Of a force recording how fast its features change with time (recordings/lateness.h): N m/s
    // and N/s at rig scale; zeros: not told, as of a machine, whose free air tells what is late.
    double rate[DIG_FEATURES];

    bool   pitch_known; // recorded while it was dug
    double pitch_rad;   // of the machine, mean over the dig
};

#endif // DIG_CLOSED_LOOP_RECORDINGS_MEASURED_H

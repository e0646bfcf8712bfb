// What a machine may do that its file does not say, put into an exact machine recording. Formulas
// of the bench's own; magnitudes are those of a machine ten times the rig and scale with others.

#ifndef DIG_TESTS_BLIND_INJECT_H
#define DIG_TESTS_BLIND_INJECT_H

#include "core/machine.h"
#include "core/recording.h"
#include "tests/blind/draw.h"

#include <stdbool.h>

#define BLIND_STRENGTHS 3

enum blind_machine_effect {
    // Of the catalogue, by its names.
    BLIND_CYLINDER_FRICTION,
    BLIND_PRESSURE_OFFSET,
    BLIND_BUCKET_WEIGHT,
    BLIND_BUCKET_INERTIA,
    BLIND_PAYLOAD,
    BLIND_LINKAGE_GEOMETRY,
    BLIND_ANGLE_OFFSET,
    BLIND_SENSOR_DELAY,
    BLIND_MACHINE_LISTED,
    // Outside of it.
    BLIND_SWING_RIPPLE = BLIND_MACHINE_LISTED, // the slewing motor shakes the oil
    BLIND_SENSOR_DRIFT,                        // a leaking sensor reads less from dig to dig
    BLIND_THERMAL_GAIN,                        // a sensor's gain follows the oil's temperature
    BLIND_HOSE_LAG,                            // a long hose, first order
    BLIND_CROSS_TALK,                          // a chamber reads a share of another drive's
    BLIND_ANGLE_WARP,                          // an angle sensor off its axis
    BLIND_MACHINE_EFFECTS
};

/// "cylinder_friction", …, "swing_ripple", ….
const char *blind_machine_effect_name(enum blind_machine_effect effect);

#define BLIND_PARAMETERS 12

/// One effect as drawn for one campaign.
struct blind_fault {
    enum blind_machine_effect effect;
    double                    p[BLIND_PARAMETERS]; // what each is stands beside the effect's code
};

/// strength 0, 1, 2: faint, plain, strong.
struct blind_fault blind_fault_draw(struct blind_draw *draw, enum blind_machine_effect effect,
                                    int strength);

/// Where a recording stands in its campaign.
struct blind_place {
    size_t order;      // 0 … in the campaign
    double start_s;    // of the recording, since the campaign's first
    double contact_s;  // in the recording: when the tooth meets the ground …
    double released_s; // … and when the bucket has been emptied
    double lambda;     // of the machine
};

/// Changes pressures (and temperature) of an exact recording as the fault would have. Rows are
/// evenly spaced and complete. DIG_ENOMEM.
DIG_MUST_CHECK enum dig_status blind_inject(const struct dig_machine     *machine,
                                            const struct blind_fault     *fault,
                                            const struct blind_place     *place,
                                            struct dig_machine_recording *recording);

/// What sensors make of an exact recording: white noise of the machine's sigmas, whole steps.
void blind_sense(const struct dig_machine *machine, struct blind_draw *draw,
                 struct dig_machine_recording *recording);

#endif // DIG_TESTS_BLIND_INJECT_H

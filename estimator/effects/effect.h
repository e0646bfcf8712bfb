// The effects a model of digging may lack: parameters, where each can show, and its action. One
// file each; this is the list.
//
// An effect of the machine writes into a struct dig_correction, one of the soil adds to a curve. A
// soil effect that a bed was dug with has templates (template.h): its parameter 0 is then their
// magnitude, and it applies only where the set of effects holds it. Its further parameters, and
// all of rate_dependence and wear, act in a reduced form that needs no bed and is documented in the
// effect's file. Parameters stand in the order of the list wherever they are an array; their names
// carry the unit and are what a model file and a report say.

#ifndef DIG_ESTIMATOR_EFFECTS_EFFECT_H
#define DIG_ESTIMATOR_EFFECTS_EFFECT_H

#include "core/curve.h"
#include "core/effect.h"
#include "core/effect_set.h"
#include "core/model.h"
#include "core/status.h"
#include "estimator/effects/template.h"
#include "estimator/wrench/correction.h"

#include <stdbool.h>
#include <stddef.h>

struct dig_effect_parameter {
    const char *name;   // with its unit: "coulomb_N"
    double      absent; // the value at which it does nothing
    double      low, high;
    double      scale; // 1 sigma of the prior
};

/// Where in a dig an effect can show; a set of these.
enum dig_effect_part { DIG_IN_AIR = 1, DIG_IN_SOIL = 2, DIG_IN_LIFT = 4 };

/// The dig an effect of the soil acts on.
struct dig_effect_dig {
    size_t   trajectory;
    unsigned pass;  // how often the ground was dug there, from 1
    size_t   order; // how many digs the tooth has done before
    double   pace;  // duration of the table's trajectory / of this dig, at rig scale

    const double *speed; // [DIG_CURVE_POINTS], dig_effect_speeds(); NULL: dig_effect_add() asks
};

struct dig_effect {
    enum dig_effect_id          id;
    const char                 *summary;   // one phrase for people
    unsigned                    parts;     // of enum dig_effect_part
    bool                        templated; // parameter 0 is the magnitude of templates
    size_t                      parameters;
    struct dig_effect_parameter parameter[DIG_MODEL_PARAMETERS_MAX];

    /// Of the machine: adds the parameters' values to *correction. NULL for the soil's.
    void (*correct)(const double value[], struct dig_correction *correction);

    /// Of the soil: the reduced form, added to what delta holds for this dig's plain curve. NULL
    /// for the machine's, and for an effect that has templates alone.
    void (*reduce)(const double value[], const struct dig_effect_dig *dig,
                   const struct dig_curve *plain, double delta[DIG_CHANNELS][DIG_CURVE_POINTS]);

    /// Of the soil: the template's magnitude in this dig. NULL: parameter 0.
    double (*magnitude)(const double value[], const struct dig_effect_dig *dig);
};

/// Speed of the tooth along a trajectory, smoothed as curves are, over the mean of all of the
/// set's.
void dig_effect_speeds(const struct dig_curve_set *set, size_t trajectory,
                       double speed[DIG_CURVE_POINTS]);

/// The effect of that id; NULL for DIG_EFFECT_UNLISTED.
const struct dig_effect *dig_effect_of(enum dig_effect_id id);

/// All parameters at their absent value.
void dig_effect_absent(const struct dig_effect *effect, double value[DIG_MODEL_PARAMETERS_MAX]);

/// The parameters of a model's effect in the list's order, the absent value where the model has
/// none. DIG_EINVAL: a name the effect does not have, or a value out of its bounds.
DIG_MUST_CHECK enum dig_status dig_effect_values(const struct dig_model_effect *found,
                                                 double value[DIG_MODEL_PARAMETERS_MAX]);

/// What an effect of the soil adds to the plain curve of one dig at a gravel: its template, when
/// its magnitude in this dig is not the absent one, and its reduced form. effects may be NULL.
/// sigma is the template's alone. Fails as dig_template_find(); DIG_ENOMATCH as well for a gravel
/// outside the grid.
DIG_MUST_CHECK enum dig_status dig_effect_add(const struct dig_effect     *effect,
                                              const struct dig_curve_set  *plain,
                                              const struct dig_effect_set *effects,
                                              const double value[], const struct dig_gravel *gravel,
                                              const struct dig_effect_dig *dig,
                                              struct dig_template         *added);

/// The machine's effects of a model as one correction (payload left out: it is of one dig).
DIG_MUST_CHECK enum dig_status dig_effects_correction(const struct dig_model *model,
                                                      struct dig_correction  *correction);

/// Writes into out the plain set with the model's soil effects: every entry's curves, for a first
/// pass, an unworn tooth and the table's own pace; sd grows by the templates'. An unlisted effect's
/// share of the rms is added the same way. out is another set of the same table; its curves are
/// written, and packings become 0 where an effect has no template along a trajectory. DIG_ENOMATCH:
/// it has none at all; DIG_EINVAL: a parameter it does not have. Then out is unspecified. Some ten
/// milliseconds for a table.
DIG_MUST_CHECK enum dig_status dig_effects_apply(const struct dig_curve_set  *plain,
                                                 const struct dig_effect_set *effects,
                                                 const struct dig_model      *model,
                                                 struct dig_curve_set        *out);

#endif // DIG_ESTIMATOR_EFFECTS_EFFECT_H

// An effect of the catalogue: its parameters with unit, bounds and prior, and what it does to a
// reading or to a curve. One file each; core/effect.h lists them.
//
// An effect of the machine writes into a struct dig_correction, one of the soil adds to a curve. A
// soil effect with beds has templates (template.h): its parameter 0 is their magnitude, and it
// applies only where the set of effects holds it. One without beds is a factor on the plain curve
// or a reduced form. Parameters stand in the order of the list wherever they are an array. Their
// names carry the unit and are those of model files and reports.

#ifndef DIG_ESTIMATOR_EFFECTS_EFFECT_H
#define DIG_ESTIMATOR_EFFECTS_EFFECT_H

#include "core/curve.h"
#include "core/effect.h"
#include "core/entry_set.h"
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
    bool        bent;  // only changes the form of the others' effect; none by itself
};

/// In what the digs of one trajectory must differ for an effect to act on each otherwise. Its share
/// in a dig: log(pace), order, or pass - 1; 1 for an effect that acts on all alike.
enum dig_effect_by { DIG_BY_NOTHING, DIG_BY_PACE, DIG_BY_ORDER, DIG_BY_PASS };

/// The dig an effect of the soil acts on.
struct dig_effect_dig {
    size_t   trajectory;
    unsigned pass;  // how often the ground was dug there, from 1
    size_t   order; // how many digs the tooth has done before
    double   pace;  // duration of the table's trajectory / of this dig, at rig scale
};

/// What is known of the ground and the bucket that an effect was found in.
struct dig_effect_ground {
    struct dig_gravel gravel;
    double            bucket_friction, bucket_rolling; // of the table's bucket in that gravel
    double            layer[2]; // a hard layer's resistance over the gravel's, and a loose one's
};

struct dig_effect {
    enum dig_effect_id          id;
    const char                 *summary; // one phrase for people
    size_t                      parameters;
    struct dig_effect_parameter parameter[DIG_MODEL_PARAMETERS_MAX];
    /// What the values mean there, in one line without its end, where a person knows the thing by
    /// another number. NULL: the parameters say it.
    void (*say)(const double value[], const struct dig_effect_ground *ground, size_t size,
                char text[]);

    // Of the machine.

    /// Adds the parameters' values to *correction. NULL for the soil's.
    void (*correct)(const double value[], struct dig_correction *correction);
    /// How far the formula may be wrong, which where the effect is strong is more than the sensors'
    /// noise: a share of what it explains of a row, and of the step where it comes or goes within a
    /// block, as friction does when a rod turns about.
    double wrong_share, wrong_step;

    // Of the soil.

    enum dig_effect_by by;
    size_t             digs_done; // by order: the parameter that holds the digs before counting
                                  // began, which a saved model sets; 0: none
    bool   templated;             // parameter 0 is the magnitude of templates, times the share
    bool   whole;                 // beds are dug at whole magnitudes, from 1
    bool   over_stiffness;        // acts by magnitude / stiffness of the grains' contacts
    bool   mirrored;              // has a meaning on both sides of absent, dug on one or on both
    bool   unlike_sides;          // magnitudes below absent are of another thing than those above
    bool   contrasted;            // what templates add is multiplied by parameter 1
    double likeness; // 1 sigma of what a template may differ by, as a share of itself; 0: usual
    double reach;    // without templates: the largest parameter 0 that a trace tries; of the
                     // machine: by force recordings, which have no free air, 0: none

    /// What is added without a bed, as a share of the plain curve, in a dig of that share, where
    /// the tooth has that speed over the mean of all trajectories. NULL: nothing.
    double (*factor)(const double value[], double share, double speed);
    /// What is added without a bed and is no factor, to what delta holds for this dig's plain
    /// curve. NULL: nothing.
    void (*reduce)(const double value[], const struct dig_curve *plain,
                   double delta[DIG_CHANNELS][DIG_CURVE_POINTS]);
};

/// Speed of the tooth along a trajectory, smoothed as curves are, over the mean of all of the
/// set's.
void dig_effect_speeds(const struct dig_curve_set *set, size_t trajectory,
                       double speed[DIG_CURVE_POINTS]);

/// The effect of that id; NULL for DIG_EFFECT_UNLISTED.
const struct dig_effect *dig_effect_of(enum dig_effect_id id);

/// True when it acts on the digs of one trajectory otherwise.
bool dig_effect_is_by_dig(enum dig_effect_id id);

/// Its share in a dig; 1 for DIG_EFFECT_UNLISTED.
double dig_effect_share(enum dig_effect_id id, const struct dig_effect_dig *dig);

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
DIG_MUST_CHECK enum dig_status dig_effect_add(const struct dig_effect    *effect,
                                              const struct dig_curve_set *plain,
                                              const struct dig_entry_set *effects,
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
DIG_MUST_CHECK enum dig_status dig_effects_apply(const struct dig_curve_set *plain,
                                                 const struct dig_entry_set *effects,
                                                 const struct dig_model     *model,
                                                 struct dig_curve_set       *out);

#endif // DIG_ESTIMATOR_EFFECTS_EFFECT_H

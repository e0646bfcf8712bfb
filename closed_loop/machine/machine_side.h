// The effects of the machine, traced in free air: before contact and after the dump the soil does
// nothing, so what is left of the bucket's moment is the machine's own.

#ifndef DIG_CLOSED_LOOP_MACHINE_MACHINE_SIDE_H
#define DIG_CLOSED_LOOP_MACHINE_MACHINE_SIDE_H

#include "closed_loop/air/machine_air.h"
#include "closed_loop/model/candidate.h"
#include "closed_loop/recordings/measured.h"
#include "core/machine.h"
#include "core/recording.h"

struct dig_machine_side; // samples of all machine recordings of a campaign

/// Takes machine recordings, one dig each, in the campaign's order, and places each dig on the
/// table's grid: *measured (all of it but machine, with name, order, use and pass as given) is
/// filled for each. trajectory says which dig to look for, -1: any of the table's. Froude's scale:
/// machine's tooth length / table's. DIG_ENOMATCH: a recording holds no dig along its trajectory
/// (*error names which). Free with dig_machine_side_destroy().
DIG_MUST_CHECK enum dig_status
dig_machine_side_create(const struct dig_machine *machine, const struct dig_curve_set *set,
                        size_t digs, const struct dig_machine_recording recording[],
                        struct dig_measured measured[], struct dig_machine_side **side,
                        struct dig_error *error);

void dig_machine_side_destroy(struct dig_machine_side *side);

/// The machine, its sensors as noisy as its recordings are.
const struct dig_machine *dig_machine_side_machine(const struct dig_machine_side *side);

#define DIG_MACHINE_AT_ONCE 2 // effects of the machine in one answer
#define DIG_MACHINE_ANSWERS (2 * (DIG_MACHINE_EFFECTS + 1))
#define DIG_MACHINE_OTHERS  12
#define DIG_MACHINE_NUMBERS                                                                        \
    (DIG_MACHINE_AT_ONCE * DIG_MODEL_PARAMETERS_MAX + DIG_FILE_ERRORS) // DIG_STEPS_MAX

/// A number of an effect beside an answer that lacks it, which free air does not exclude: 1 sigma
/// of the mixture of the answer and the answer with any one such number. Beside an answer all
/// effects are as likely before as none, the numbers of each alike.
struct dig_machine_other {
    enum dig_effect_id effect;
    size_t             parameter;
    double             value;
    double             with[DIG_MACHINE_NUMBERS]; // what the answer's numbers do meanwhile
};

/// One answer of free air: effects with their values by one prior (machine_fit.h), what the file
/// has wrong beside them, and what it leaves open of these. With z of normal distribution the
/// parameters, effect after effect, and then the file's are value + the sum over k of z[k] step[k].
/// The prior that free air likes best is narrow, and says nothing of what free air does not tell;
/// the wide one leaves that to the digs.
struct dig_machine_answer {
    size_t                   effects;
    struct dig_model_effect  effect[DIG_MACHINE_AT_ONCE];
    bool                     wide; // by the wide prior, not by the one free air likes best
    double                   file[DIG_FILE_ERRORS];
    double                   log_evidence; // of free air, against no effect
    size_t                   numbers; // parameters of all its effects, and the file's; 0: not told
    double                   value[DIG_MACHINE_NUMBERS];
    double                   step[DIG_MACHINE_NUMBERS][DIG_MACHINE_NUMBERS]; // [k][parameter]
    size_t                   others; // the farthest first, in their scales
    struct dig_machine_other other[DIG_MACHINE_OTHERS];
};

/// An error of the file that is larger than it allows, where free air shows one.
struct dig_machine_unlike_file {
    bool                is;
    enum dig_file_error error;
    double              value, allowed; // 1 sigma
    double              log_evidence;   // of free air, against a file within its tolerance
};

/// What free air says.
struct dig_machine_finding {
    bool                      significant; // something of the machine is missing
    double                    p_complete;
    bool                      no_air;       // in the recordings: nothing was traced
    double                    residual_air; // rms over the rms expected
    double                    residual_air_of[DIG_MEASURED_MAX]; // the same dig by dig; NaN: no air
    size_t                    effects;                           // found, most certain first
    struct dig_model_effect   effect[DIG_MODEL_EFFECTS_MAX];
    size_t                    candidates;
    struct dig_candidate      candidate[DIG_TRACE_CANDIDATES_MAX]; // of the machine, best first
    size_t                    sets;
    struct dig_candidate_set  set[DIG_TRACE_SETS_MAX]; // that free air cannot tell apart
    struct dig_machine_answer none;                    // no effect
    size_t                    answers; // the set found, if of several, and each candidate alone
    struct dig_machine_answer answer[DIG_MACHINE_ANSWERS];
    bool        by_digs; // the effects are told by free air and the digs together, not by air alone
    bool        unexplained;               // significant, and no effect of the machine explains it
    const char *follows;                   // what it then depends on, for people; NULL: not told
    struct dig_machine_unlike_file unlike; // unexplained unless the digs tell it; corrected in them
};

/// Traces in the air of the fit and identify digs only, at this false-alarm rate, and remembers
/// what payload each of them carried beyond the one they have in common. Seconds.
DIG_MUST_CHECK enum dig_status dig_machine_side_trace(struct dig_machine_side *side,
                                                      double false_alarm, uint64_t seed,
                                                      struct dig_machine_finding *finding);

/// Leaves in measured[].lasting what noise that free air shows to last (machine_noise.h) does to
/// each dig; nothing where it shows none. The trace goes on with the air as it is left then.
/// DIG_ENOMEM. Some tenths of a second.
DIG_MUST_CHECK enum dig_status dig_machine_side_tell_noise(struct dig_machine_side *side,
                                                           struct dig_measured      measured[]);

/// Which digs effects are applied to, and how carefully: ROUGHLY, to those fitted to, for
/// differences of two such.
enum dig_apply { DIG_APPLY_TO_ALL, DIG_APPLY_TO_FITTED, DIG_APPLY_ROUGHLY };

/// Writes into machine[], by dig, what these effects (those of the machine among them) and what the
/// file has wrong (NULL: nothing) add to the measured curves; a payload, in a dig that was traced
/// in, as much as that dig's was. Of a dig that they are not applied to nothing is written.
/// DIG_ENOMATCH: a dig is not told with them (a cylinder at its stop, a bucket off its path, a
/// value beyond its range); what was written by then is of no use. DIG_ENOMEM.
DIG_MUST_CHECK enum dig_status
dig_machine_side_apply(const struct dig_machine_side *side, size_t effects,
                       const struct dig_model_effect effect[], const double file[DIG_FILE_ERRORS],
                       enum dig_apply apply, const struct dig_measured measured[],
                       double machine[][DIG_FORCE_CHANNELS][DIG_CURVE_POINTS]);

#endif // DIG_CLOSED_LOOP_MACHINE_MACHINE_SIDE_H

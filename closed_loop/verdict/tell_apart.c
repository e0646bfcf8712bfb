#include "closed_loop/verdict/trace_work.h"

#include "closed_loop/verdict/air_motion.h"
#include "estimator/effects/effect.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { ENOUGH = 3, MORE_DIGS = 10 };

// Below this no number of repeats is worth the name.
static const double least_sigmas = 0.05;

static double repeats_of(const double sigmas)
{
    return fmax(ceil(pow(ENOUGH / fmax(sigmas, least_sigmas), 2.0)), 1.0);
}

// Takes it where it tells more than what was found before.
static void offer(struct dig_tell_apart *const tell, const bool in_air, const double sigmas,
                  const char *const how, const char *const which, const char *const more)
{
    const bool better =
        sigmas >= least_sigmas && (tell->how[0] == '\0' || repeats_of(sigmas) < tell->repeats ||
                                   (tell->in_air == in_air && sigmas > tell->sigmas));
    if (!better) {
        return;
    }
    tell->in_air  = in_air;
    tell->sigmas  = sigmas;
    tell->repeats = repeats_of(sigmas);
    (void)snprintf(tell->how, sizeof tell->how, "%s%s%s", how, which, more);
}

// What the next dig will be measured by: what those before were.
static bool is_measured(const struct dig_trace_work *const w, const size_t channel)
{
    bool any = false;
    for (size_t i = 0; i < w->digs; i++) {
        any = any || w->measured[i].measured[channel];
    }
    return any;
}

// Root mean square over the features that are measured, each over its scatter in one dig.
static double in_scatters(const struct dig_trace_work *const w, const size_t trajectory,
                          const double difference[DIG_FEATURES],
                          const double size[DIG_FORCE_CHANNELS])
{
    double sum   = 0.0;
    double count = 0.0;
    for (size_t f = 0; f < DIG_FEATURES; f++) {
        const size_t channel = f / DIG_FEATURE_BINS;
        const double off     = difference[f] / size[channel];
        if (is_measured(w, channel)) {
            sum += off * off / w->scatter->covariance[trajectory][f][f];
            count += 1.0;
        }
    }
    return count > 0.0 ? sqrt(sum / count) : 0.0;
}

// How far apart two fitted hypotheses are in one dig.
static double apart(const struct dig_trace_work *const w, const struct dig_fitted *const a,
                    const struct dig_fitted *const b, const struct dig_measured *const dig)
{
    double x[DIG_FEATURES];
    double y[DIG_FEATURES];
    double size[DIG_FORCE_CHANNELS];
    dig_fitted_features(w->soil, a, dig, x);
    dig_fitted_features(w->soil, b, dig, y);
    dig_features_amplitude(x, NULL, size);
    for (size_t f = 0; f < DIG_FEATURES; f++) {
        y[f] = x[f] - y[f];
    }
    return in_scatters(w, (size_t)dig->trajectory, y, size);
}

static const struct dig_fitted *rival_of(const struct dig_search *const s,
                                         const enum dig_effect_id       effect)
{
    for (size_t i = 0; i < s->rivals; i++) {
        if (s->rival[i].fitted.hypothesis.effect[0] == effect) {
            return &s->rival[i].fitted;
        }
    }
    return NULL;
}

// How fast a dig changes is known where one was recorded along its trajectory.
static bool take_rate(const struct dig_trace_work *const w, struct dig_measured *const dig)
{
    for (size_t i = 0; i < w->digs; i++) {
        const struct dig_measured *const like = &w->measured[i];
        if (like->trajectory == dig->trajectory && like->pace > 0.0) {
            for (size_t f = 0; f < DIG_FEATURES; f++) {
                dig->rate[f] = like->rate[f] * dig->pace / like->pace;
            }
            return true;
        }
    }
    return false;
}

// The plain dig comes first: what another way of digging does not change is told by it.
static void tell_soil(const struct dig_trace_work *const w, struct dig_tell_apart *const tell)
{
    static const struct {
        const char *how;
        unsigned    pass;
        double      pace;
        size_t      more;
    } way[] = { { "", 1, 1.0, 0 },
                { " at twice the pace", 1, 2.0, 0 },
                { " where it was dug before", 2, 1.0, 0 },
                { " after ten more digs", 1, 1.0, MORE_DIGS } };

    const struct dig_fitted *const a = rival_of(w->search, tell->effect[0]);
    const struct dig_fitted *const b = rival_of(w->search, tell->effect[1]);
    for (size_t i = 0; a != NULL && b != NULL && i < sizeof way / sizeof way[0]; i++) {
        for (size_t k = 0; k < w->set->trajectories; k++) {
            struct dig_measured dig  = { .trajectory = (int)k,
                                         .order      = w->digs + way[i].more,
                                         .pass       = way[i].pass,
                                         .pace       = way[i].pace };
            const bool          late = dig_effect_is_of_machine(tell->effect[0]) ||
                              dig_effect_is_of_machine(tell->effect[1]);
            if ((take_rate(w, &dig) || !late) && w->surface->known[k] &&
                dig_soil_knows(w->soil, tell->effect[0], k) &&
                dig_soil_knows(w->soil, tell->effect[1], k)) {
                offer(tell, false, apart(w, a, b, &dig), "a dig along ", w->set->trajectory[k].name,
                      way[i].how);
            }
        }
    }
}

// A candidate of the machine: what it corrects, and what that does to the recorded digs.
struct of_machine {
    bool                    known;
    struct dig_model_effect effect;
    struct dig_correction   correction;
    double                  feature[DIG_MEASURED_MAX][DIG_FEATURES];
};

static enum dig_status work_out(const struct dig_trace_work *const w, const enum dig_effect_id id,
                                struct of_machine *const made)
{
    const struct dig_machine_finding *const air = w->air;
    memset(made, 0, sizeof *made);
    for (size_t i = 0; i < air->candidates; i++) {
        if (air->candidate[i].as.effect == id) {
            made->known  = true;
            made->effect = air->candidate[i].as;
        }
    }
    double value[DIG_MODEL_PARAMETERS_MAX];
    if (!made->known || dig_effect_values(&made->effect, value) != DIG_OK) {
        made->known = false;
        return DIG_OK;
    }
    dig_effect_of(id)->correct(value, &made->correction);
    double                machine[DIG_MEASURED_MAX][DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
    const enum dig_status status = dig_machine_side_apply(w->machine, 1, &made->effect, NULL,
                                                          DIG_APPLY_TO_ALL, w->measured, machine);
    for (size_t i = 0; i < w->digs && status == DIG_OK; i++) {
        dig_features_of((const double(*)[DIG_CURVE_POINTS])machine[i], made->feature[i]);
    }
    // One that leaves a dig untold is compared in free air alone.
    return status == DIG_ENOMATCH ? DIG_OK : status;
}

// The motion in which two corrections differ most; beside: how else it is to be made.
static enum dig_status offer_motion(const struct dig_machine_side *const side,
                                    const struct dig_correction *const   a,
                                    const struct dig_correction *const b, const char *const beside,
                                    struct dig_tell_apart *const tell)
{
    struct dig_motion     motion;
    double                sigmas = 0.0;
    char                  how[64];
    const enum dig_status status =
        dig_motion_best(dig_machine_side_machine(side), a, b, &motion, &sigmas);
    if (status == DIG_OK) {
        (void)snprintf(how, sizeof how, " to and fro %s in free air%s, %.0f s",
                       motion.fast ? "fast" : "slowly", beside, DIG_MOTION_s);
        offer(tell, true, sigmas, "moving the ", dig_joint_name(motion.joint), how);
    }
    return status;
}

// What a bucket carries over from the dig before can be shaken out of it; nothing else can.
static enum dig_status offer_clean_bucket(const struct dig_machine_side *const side,
                                          const struct of_machine *const       a,
                                          const struct of_machine *const       b,
                                          struct dig_tell_apart *const         tell)
{
    static const struct dig_correction none = { .delay_s = 0.0 };

    const bool of_a = tell->effect[0] == DIG_EFFECT_PAYLOAD;
    const bool of_b = tell->effect[1] == DIG_EFFECT_PAYLOAD;
    return of_a || of_b ? offer_motion(side, of_a ? &none : &a->correction,
                                       of_b ? &none : &b->correction, ", the bucket clean", tell)
                        : DIG_OK;
}

static enum dig_status tell_machine(const struct dig_trace_work *const w,
                                    const struct of_machine *const     a,
                                    const struct of_machine *const     b,
                                    struct dig_tell_apart *const       tell)
{
    if (!a->known || !b->known) {
        return DIG_OK;
    }
    enum dig_status status = offer_motion(w->machine, &a->correction, &b->correction, "", tell);
    if (status == DIG_OK) {
        status = offer_clean_bucket(w->machine, a, b, tell);
    }
    for (size_t i = 0; i < w->digs && status == DIG_OK; i++) {
        const size_t k = (size_t)w->measured[i].trajectory;
        double       plain[DIG_FEATURES];
        double       size[DIG_FORCE_CHANNELS];
        double       difference[DIG_FEATURES];
        if (w->measured[i].use == DIG_USE_HOLDOUT) {
            continue;
        }
        dig_features_of((const double(*)[DIG_CURVE_POINTS])w->measured[i].value, plain);
        dig_features_amplitude(plain, NULL, size);
        for (size_t f = 0; f < DIG_FEATURES; f++) {
            difference[f] = a->feature[i][f] - b->feature[i][f];
        }
        offer(tell, false, in_scatters(w, k, difference, size), "a dig along ",
              w->set->trajectory[k].name, "");
    }
    return status;
}

// Pairs in the order of the sets, those with what was chosen first.
static void list_pairs(struct dig_trace *const trace)
{
    trace->tells = 0;
    for (size_t s = 0; s < trace->sets; s++) {
        const struct dig_candidate_set *const set = &trace->set[s];
        for (size_t a = 0; a < set->effects; a++) {
            for (size_t b = a + 1; b < set->effects && trace->tells < DIG_TRACE_TELLS_MAX; b++) {
                trace->tell[trace->tells++] =
                    (struct dig_tell_apart){ .effect = { set->effect[a], set->effect[b] } };
            }
        }
    }
}

static enum dig_status tell_machines(const struct dig_trace_work *const w,
                                     struct dig_trace *const            trace)
{
    enum dig_status status = DIG_OK;
    for (size_t i = 0; i < trace->tells && status == DIG_OK; i++) {
        struct dig_tell_apart *const tell = &trace->tell[i];
        struct of_machine            made[2];
        if (!dig_effect_is_of_machine(tell->effect[0])) {
            continue;
        }
        for (size_t e = 0; e < 2 && status == DIG_OK; e++) {
            status = work_out(w, tell->effect[e], &made[e]);
        }
        if (status == DIG_OK) {
            status = tell_machine(w, &made[0], &made[1], tell);
        }
    }
    return status;
}

enum dig_status dig_tell_apart(const struct dig_trace_work *const w, struct dig_trace *const trace)
{
    assert(w != NULL && trace != NULL);
    list_pairs(trace);
    for (size_t i = 0; i < trace->tells; i++) {
        if (w->machine == NULL || !dig_effect_is_of_machine(trace->tell[i].effect[0])) {
            tell_soil(w, &trace->tell[i]);
        }
    }
    return w->machine != NULL ? tell_machines(w, trace) : DIG_OK;
}

void dig_tell_apart_say(const struct dig_tell_apart *const tell, const size_t size, char text[])
{
    assert(tell != NULL && text != NULL && size > 0);
    const char *const a = dig_effect_name(tell->effect[0]);
    const char *const b = dig_effect_name(tell->effect[1]);
    if (tell->how[0] == '\0') {
        (void)snprintf(text, size, "%s and %s: nothing that was tried tells them apart", a, b);
        return;
    }
    char times[24] = "one";
    if (tell->repeats > 1.5) {
        (void)snprintf(times, sizeof times, "%.0f of them", tell->repeats);
    }
    (void)snprintf(text, size, "%s and %s differ most by %s: %.2g %s; %s would tell them apart", a,
                   b, tell->how, tell->sigmas,
                   tell->in_air ? "sigmas of the sensors" : "scatters of one dig", times);
}

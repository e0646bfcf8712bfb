// Traces effects of the machine in free air: sets up its equations, and reports the effects that
// explain them.

#include "closed_loop/machine/machine_search.h"
#include "core/chance.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { BOOTSTRAPS = 200 };

void dig_machine_search_finish(struct dig_machine_search *const s)
{
    free(s->all.row);
    dig_fit_finish(&s->fit);
    dig_air_finish(&s->air);
}

// The bucket's weight is an effect, and no error of the file.
static void tolerance_of(const struct dig_air *const air, double scale[DIG_FILE_ERRORS])
{
    const struct dig_machine *const m = &air->machine;
    memset(scale, 0, DIG_FILE_ERRORS * sizeof scale[0]);
    for (size_t j = 0; j < DIG_JOINT_BUCKET; j++) {
        double *const sigma = &scale[(size_t)DIG_FILE_LINKS + 3 * j];
        sigma[0]            = m->tolerance.mass_share * m->link[j].mass_kg;
        sigma[1]            = m->tolerance.com_share * m->link[j].length_m * m->link[j].mass_kg;
        sigma[2]            = sigma[1];
    }
    // A machine that says how it is pitched knows.
    if (air->points > 0 && !air->point[0].sample.valid[DIG_SIGNAL_PITCH_rad]) {
        scale[DIG_FILE_LEVEL_rad] = DIG_FILE_LEVEL_SIGMA_rad;
    }
}

// Begins with the air of the digs to trace in, once: its noise is asked for first, then its
// effects.
static enum dig_status begin(struct dig_machine_side *const side)
{
    struct dig_machine_search *const s = &side->search;
    double                           scale[DIG_FILE_ERRORS];
    if (side->begun) {
        return DIG_OK;
    }
    *s = (struct dig_machine_search){ .set = 0 };
    enum dig_status status =
        dig_air_make(&side->machine, side->digs, side->dig, side->used, &s->air);
    if (status == DIG_OK) {
        tolerance_of(&s->air, scale);
        status = dig_fit_make(&s->air, scale, &s->fit);
    }
    const size_t rows = s->air.rows;
    s->all.row        = status == DIG_OK ? malloc(2 * (rows + 1) * sizeof *s->all.row) : NULL;
    if (s->all.row == NULL) {
        dig_machine_search_finish(s);
        return DIG_ENOMEM;
    }
    s->kept.row = s->all.row + rows + 1;
    dig_slew_rows_save(&s->air, &s->all);
    if (rows > 0) {
        dig_machine_begin(s);
    }
    side->begun = true;
    return DIG_OK;
}

// What a drive's push that is off by so much does to a dig: rms of each channel, squared.
static enum dig_status add_push(const struct dig_machine_side *const side, const size_t dig,
                                const int joint, const double push_N,
                                const struct dig_measured *const as_it_is,
                                double                           square[DIG_FORCE_CHANNELS])
{
    const struct dig_cylinder *const cylinder = &side->machine.cylinder[joint];
    struct dig_measured              off      = *as_it_is;
    struct dig_correction            by       = { .delay_s = 0.0 };
    by.offset_Pa[joint][DIG_CHAMBER_HEAD] =
        push_N / (cylinder->count * dig_cylinder_head_m2(cylinder));
    const enum dig_status status = dig_machine_dig_measure(
        &side->machine, side->set, &side->dig[dig], &by, DIG_MEASURE_ROUGHLY, &off);
    for (size_t c = 0; c < DIG_FORCE_CHANNELS && status == DIG_OK; c++) {
        for (size_t k = 0; k < DIG_CURVE_POINTS && off.measured[c] && as_it_is->measured[c]; k++) {
            square[c] += pow(off.value[c][k] - as_it_is->value[c][k], 2.0) / DIG_CURVE_POINTS;
        }
    }
    return status;
}

// Lasting noise of one dig.
static enum dig_status lasting_of(const struct dig_machine_side *const  side,
                                  const struct dig_machine_noise *const noise, const size_t dig,
                                  struct dig_measured *const measured)
{
    static const struct dig_correction none                       = { .delay_s = 0.0 };
    struct dig_measured                rough                      = *measured;
    double                             square[DIG_FORCE_CHANNELS] = { 0.0 };
    enum dig_status status = dig_machine_dig_measure(&side->machine, side->set, &side->dig[dig],
                                                     &none, DIG_MEASURE_ROUGHLY, &rough);
    for (int j = 0; j < DIG_JOINTS && status == DIG_OK; j++) {
        if (noise->sigma_N[dig][j] > 0.0) {
            status = add_push(side, dig, j, noise->sigma_N[dig][j], &rough, square);
        }
    }
    if (status == DIG_OK) {
        measured->lasting.memory_s = noise->memory_s * measured->pace / sqrt(side->dig[dig].lambda);
        for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
            measured->lasting.sigma[c] = sqrt(square[c]);
        }
    }
    return status == DIG_ENOMATCH ? DIG_OK : status; // a drive at its stop: not told
}

enum dig_status dig_machine_side_tell_noise(struct dig_machine_side *const side,
                                            struct dig_measured            measured[])
{
    assert(side != NULL && (side->digs == 0 || measured != NULL));
    const struct dig_machine_noise *const noise  = &side->search.noise;
    enum dig_status                       status = begin(side);
    for (size_t d = 0; d < side->digs && status == DIG_OK && noise->memory_s > 0.0; d++) {
        status = lasting_of(side, noise, d, &measured[d]);
    }
    return status;
}

// How often each effect is chosen when the digs are drawn anew.
static void bootstrap(struct dig_machine_search *const s, uint64_t seed,
                      double inclusion[DIG_MACHINE_EFFECTS])
{
    memset(inclusion, 0, DIG_MACHINE_EFFECTS * sizeof inclusion[0]);
    for (int b = 0; b < BOOTSTRAPS; b++) {
        double weight[DIG_MEASURED_MAX] = { 0.0 };
        for (size_t d = 0; d < s->fit.lines.digs; d++) {
            weight[dig_chance_index(&seed, s->fit.lines.digs)] += 1.0;
        }
        dig_fit_sum(&s->fit, weight);
        const unsigned set = dig_fit_select(&s->fit, s->least, 0);
        for (int e = 0; e < DIG_MACHINE_EFFECTS; e++) {
            inclusion[e] += (double)((set >> e) & 1U) / BOOTSTRAPS;
        }
    }
    dig_fit_sum(&s->fit, NULL);
}

// The log evidence of the set and of what the file has wrong, against a machine as filed: of what
// that leaves in truth, which is not where the lines lead from here.
static double evidence_of_all(const struct dig_machine_search *const s)
{
    const double left2 = dig_lines_rest2(&s->fit.lines, s->fit.lines.absent);
    return s->fit.log_none + dig_fit_evidence(&s->fit, s->set) +
           0.5 * (left2 - s->fit.rest2) / s->fit.s2;
}

// Every effect as it competed: by itself, or in the set found.
static void write_candidates(struct dig_machine_search *const s, const double inclusion[],
                             struct dig_machine_finding *const finding)
{
    finding->candidates = 0;
    for (int e = 0; e < DIG_MACHINE_EFFECTS; e++) {
        const struct dig_fit_answer answer = dig_fit_solve(&s->fit, 1U << e, DIG_FIT_COVARIANCE);
        size_t                      to     = finding->candidates++;
        for (; to > 0 && finding->candidate[to - 1].log_evidence < answer.log_evidence; to--) {
            finding->candidate[to] = finding->candidate[to - 1];
        }
        finding->candidate[to] = (struct dig_candidate){
            .as           = dig_machine_effect(s, (enum dig_effect_id)e, inclusion[e]),
            .log_evidence = answer.log_evidence,
            .p_fit = answer.rest2 > s->noise2 * DIG_MACHINE_UNCLEAR_REST2 * s->fit.rows ? 0.0 : 1.0,
            .error = (double)NAN,
            .seen_in = DIG_PART_AIR,
        };
    }
}

static void write_effects(struct dig_machine_search *const s, const double inclusion[],
                          struct dig_machine_finding *const finding)
{
    (void)dig_fit_solve(&s->fit, s->set, DIG_FIT_COVARIANCE);
    memcpy(s->fit.at, s->fit.lines.at, s->fit.lines.columns * sizeof(double));
    finding->effects = 0;
    for (int e = 0; e < DIG_MACHINE_EFFECTS; e++) {
        if (((s->set >> e) & 1U) == 0) {
            continue;
        }
        size_t to = finding->effects++;
        for (; to > 0 && finding->effect[to - 1].probability < inclusion[e]; to--) {
            finding->effect[to] = finding->effect[to - 1];
        }
        finding->effect[to] = dig_machine_effect(s, (enum dig_effect_id)e, inclusion[e]);
    }
}

// Soil falls out or stays as it likes: what each dig carried beyond what the digs have in common,
// by the air before it. With payload alone where the set has none.
static void write_own_payload(struct dig_machine_search *const s, double own_kg[DIG_MEASURED_MAX])
{
    static const unsigned carries = 1U << DIG_EFFECT_PAYLOAD;
    if ((s->set & carries) != 0) {
        memcpy(s->fit.at, s->fit.lines.at, s->fit.lines.columns * sizeof(double));
    } else {
        (void)dig_fit_solve(&s->fit, carries, DIG_FIT_VALUES);
    }
    for (size_t d = 0; d < DIG_MEASURED_MAX; d++) {
        own_kg[d] = 0.0;
    }
    for (size_t c = 0; c < s->fit.lines.columns; c++) {
        const struct dig_lines_column *const column = &s->fit.lines.column[c];
        if (column->segment >= 0 && !s->air.segment[column->segment].after) {
            own_kg[s->air.segment[column->segment].dig] = column->scale * s->fit.at[c];
        }
    }
}

// Effects that would do in the place of one of the set.
static void write_sets(const struct dig_machine_search *const s,
                       struct dig_machine_finding *const      finding)
{
    const double found = dig_fit_evidence(&s->fit, s->set);
    finding->sets      = 0;
    for (unsigned e = 0; e < DIG_MACHINE_EFFECTS; e++) {
        if (((s->set >> e) & 1U) == 0 || finding->sets == DIG_TRACE_SETS_MAX) {
            continue;
        }
        struct dig_candidate_set like = { .effects = 1, .effect = { (enum dig_effect_id)e } };
        for (unsigned f = 0; f < DIG_MACHINE_EFFECTS; f++) {
            const unsigned instead = (s->set & ~(1U << e)) | (1U << f);
            if (((s->set >> f) & 1U) == 0 &&
                dig_fit_evidence(&s->fit, instead) > found - DIG_MACHINE_TIE) {
                like.effect[like.effects++] = (enum dig_effect_id)f;
            }
        }
        if (like.effects > 1) {
            finding->set[finding->sets++] = like;
        }
    }
}

// Where pressures that drift explain no less than the effects found, these have no claim to it.
static void doubt_names(struct dig_machine_search *const s)
{
    s->drift = dig_machine_drift_ask(&s->fit.lines, s->fit.s2);
    if (s->set == 0 || !(s->drift.log_lead > DIG_MACHINE_TIE) ||
        s->drift.log_evidence < evidence_of_all(s)) {
        s->drift.follows = NULL;
    }
}

// Where a file that is wrong in one thing by more than it allows explains no less than the effects
// found, these have no claim to it.
static void doubt_file(struct dig_machine_search *const s)
{
    s->unlike = dig_machine_unlike_ask(&s->fit, s->level);
    if (s->set != 0 &&
        s->unlike.log_evidence < s->fit.log_none + dig_fit_evidence(&s->fit, s->set)) {
        s->unlike.is = false;
    }
}

static void write_unlike(const struct dig_machine_search *const s,
                         struct dig_machine_finding *const      finding)
{
    const struct dig_lines_column *const of = &s->fit.lines.column[s->unlike.column];
    finding->effects                        = 0;
    finding->sets                           = 0;
    finding->unexplained                    = true;
    finding->follows = dig_file_error_text((enum dig_file_error)of->parameter);
    finding->unlike  = (struct dig_machine_unlike_file){
         .is           = true,
         .log_evidence = s->unlike.log_evidence - s->fit.log_none,
         .error        = (enum dig_file_error)of->parameter,
         .value        = finding->none.file[of->parameter],
         .allowed      = of->scale,
    };
}

static void write_finding(struct dig_machine_search *const s, const uint64_t seed,
                          double                            own_payload_kg[DIG_MEASURED_MAX],
                          struct dig_machine_finding *const finding)
{
    double inclusion[DIG_MACHINE_EFFECTS];
    doubt_names(s);
    const bool unclear = dig_machine_is_unclear(s) || s->drift.follows != NULL;
    if (!unclear) {
        doubt_file(s);
    }
    *finding = (struct dig_machine_finding){ .unexplained  = unclear,
                                             .follows      = s->drift.follows,
                                             .residual_air = s->residual };
    memcpy(finding->residual_air_of, s->residual_of, sizeof s->residual_of);
    finding->significant = s->set != 0 || unclear || s->unlike.is;
    bootstrap(s, seed, inclusion);
    write_candidates(s, inclusion, finding);
    write_own_payload(s, own_payload_kg);
    if (!unclear) {
        dig_machine_write_none(s, finding);
        write_effects(s, inclusion, finding);
        write_sets(s, finding);
        if (s->unlike.is) {
            write_unlike(s, finding);
        }
        dig_machine_write_answers(s, finding);
    }
    finding->p_complete =
        fmin(s->unlike.is ? s->unlike.p : 1.0,
             DIG_MACHINE_EFFECTS * exp(-fmax(finding->candidate[0].log_evidence, 0.0)));
}

enum dig_status dig_machine_side_trace(struct dig_machine_side *const side,
                                       const double false_alarm, const uint64_t seed,
                                       struct dig_machine_finding *const finding)
{
    assert(side != NULL && finding != NULL && false_alarm > 0.0);
    struct dig_machine_search *const s      = &side->search;
    const enum dig_status            status = begin(side);
    if (status != DIG_OK) {
        return status;
    }
    s->level = false_alarm;
    s->least = log(DIG_MACHINE_EFFECTS / false_alarm);
    if (s->air.rows > 0) {
        dig_machine_select(s);
        write_finding(s, seed, side->own_payload_kg, finding);
    } else {
        *finding = (struct dig_machine_finding){ .p_complete   = 1.0,
                                                 .no_air       = true,
                                                 .residual_air = (double)NAN };
        for (size_t d = 0; d < DIG_MEASURED_MAX; d++) {
            finding->residual_air_of[d] = (double)NAN;
        }
    }
    dig_machine_search_finish(s);
    side->begun = false;
    return DIG_OK;
}

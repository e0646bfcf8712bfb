// Effects join one after the other, and after each the equations are made linear again where it has
// led.

#include "closed_loop/machine/machine_search.h"

#include <math.h>
#include <string.h>

enum { REFINEMENTS = 8, ROUNDS = 6 };

// Air is not understood, either, whose means over segments leave so many sigmas of chi-squared
// more.
static const double unclear_sigmas = 5.0;

// Of noise told by the air itself, that of both may be more: it is known from some dozens of
// blocks, and may still move from one to the next.
static const double own_noise = 1.4;

static void make_linear(struct dig_machine_search *const s)
{
    dig_lines_update(&s->fit.lines, DIG_LINES_ALL);
    dig_fit_sum(&s->fit, NULL);
}

// Rows are trusted as they may be where the lines stand, and are made linear there.
static void stand(struct dig_machine_search *const s)
{
    s->slow  = dig_lines_judge(&s->fit.lines);
    s->rest2 = dig_lines_rest2(&s->fit.lines, s->fit.lines.at);
    make_linear(s);
}

// Gauss-Newton of the set's parameters from where they are; steps that do not help are halved.
static void refine(struct dig_machine_search *const s)
{
    for (int i = 0; i < REFINEMENTS; i++) {
        const double s2 = s->fit.s2;
        double       widths[DIG_LINES_COLUMNS_MAX];
        dig_lines_update(&s->fit.lines, s->set | DIG_LINES_OF_FILE);
        dig_fit_sum(&s->fit, NULL);
        dig_fit_set_noise(&s->fit, s2); // of all effects together, which these are not
        const double wide = dig_fit_solve(&s->fit, s->set, DIG_FIT_VALUES).width;
        dig_fit_widths(&s->fit, ~0U, wide, widths); // of those that have left the set, too
        if (dig_fit_step(&s->fit, widths) * wide < 0.005) {
            break;
        }
    }
    stand(s);
}

// Leaves out what slewing pulls, or the ground, beside all effects as the trusted rows have them.
static bool leave_out(struct dig_machine_search *const s, const enum dig_slew which)
{
    make_linear(s);
    (void)dig_fit_solve(&s->fit, DIG_MACHINE_ALL_EFFECTS, DIG_FIT_VALUES);
    return dig_slew_leave_out(&s->fit.lines, s->fit.at, which);
}

void dig_machine_begin(struct dig_machine_search *const s)
{
    for (int round = 0; round < ROUNDS && leave_out(s, DIG_SLEW_LONG); round++) {
    }
    dig_machine_noise_tell(&s->fit.lines, s->fit.at, &s->noise);
}

// The equations without any effect, rows as far as their own scatter lets them be known.
static void settle(struct dig_machine_search *const s)
{
    const bool widened = dig_machine_noise_widen(&s->noise, &s->air);
    s->noise2          = widened ? own_noise : 1.0;
    if (widened) {
        make_linear(s);
    }
    // Only beyond that noise a block tells of the ground.
    for (int round = 0; round < ROUNDS && leave_out(s, DIG_SLEW_TOUCHES); round++) {
    }
    s->slow = dig_lines_judge(&s->fit.lines);
}

// What is left of the rows without any effect, and what they scatter by, dig by dig: for a report.
static void write_residuals(struct dig_machine_search *const s)
{
    double *const rest                    = s->fit.lines.work;
    double        count[DIG_MEASURED_MAX] = { 0.0 };
    double        sum[DIG_MEASURED_MAX]   = { 0.0 };
    double        alone[DIG_MEASURED_MAX] = { 0.0 };
    double        all                     = 0.0;
    s->rest2                              = dig_lines_rest2(&s->fit.lines, s->fit.lines.at);
    for (size_t r = 0; r < s->air.rows; r++) {
        const struct dig_air_row *const row = &s->air.row[r];
        const size_t                    d   = s->air.segment[row->segment].dig;
        sum[d] += pow(s->fit.lines.trust[r] * rest[r], 2.0);
        count[d] += 1.0;
        alone[d] += row->alone * row->alone;
        all += row->alone * row->alone;
    }
    s->residual = sqrt(s->rest2 / all);
    for (size_t d = 0; d < DIG_MEASURED_MAX; d++) {
        s->residual_of[d] =
            count[d] > 0.0 ? sqrt(sum[d] / count[d]) * sqrt(count[d] / alone[d]) : (double)NAN;
    }
}

// In scales.
static double common_payload(const struct dig_machine_search *const s)
{
    return s->fit.lines.at[dig_lines_first(&s->fit.lines, DIG_EFFECT_PAYLOAD)];
}

// More effects than one trusts to be there at once share out the form of a cause that has none of
// theirs; so does a payload that weighs less than nothing.
static bool is_makeshift(const struct dig_machine_search *const s)
{
    return __builtin_popcount(s->set) > DIG_MACHINE_AT_ONCE || common_payload(s) < 0.0;
}

bool dig_machine_is_unclear(const struct dig_machine_search *const s)
{
    const double rows  = (double)s->air.rows;
    const double means = (double)(DIG_JOINTS * s->air.segments);
    return s->rest2 > s->noise2 * DIG_MACHINE_UNCLEAR_REST2 * rows || is_makeshift(s) ||
           s->slow > s->noise2 * (means + unclear_sigmas * sqrt(2.0 * means));
}

// A first dig that carried more than the others looks like a bucket that is heavier and carries
// less than nothing.
static void take_weight_for_payload(struct dig_machine_search *const s)
{
    static const unsigned weighs = 1U << DIG_EFFECT_BUCKET_WEIGHT;
    if ((s->set & weighs) == 0 || !(common_payload(s) < 0.0)) {
        return;
    }
    s->set &= ~weighs;
    for (size_t c = 0; c < s->fit.lines.columns; c++) {
        const bool gone = s->fit.lines.column[c].effect == DIG_EFFECT_BUCKET_WEIGHT ||
                          s->fit.lines.column[c].effect == DIG_EFFECT_PAYLOAD;
        s->fit.lines.at[c] = gone ? 0.0 : s->fit.lines.at[c];
    }
    refine(s);
}

// What is not of the set has no value: else its leavings explain what the set does not.
static void keep_to_set(struct dig_machine_search *const s)
{
    for (size_t c = 0; c < s->fit.lines.columns; c++) {
        const enum dig_effect_id effect = s->fit.lines.column[c].effect;
        if (effect != DIG_EFFECT_UNLISTED && ((s->set >> effect) & 1U) == 0) {
            s->fit.lines.at[c] = s->fit.lines.absent[c];
        }
    }
}

// Effects join until none earns its place, `first` before all others.
static void join(struct dig_machine_search *const s, const unsigned first)
{
    s->set = first;
    for (int round = 1; round < ROUNDS; round++) {
        keep_to_set(s);
        refine(s);
        // Where the first steps have led, others may do better, and some may not be needed.
        const unsigned before = s->set;
        const unsigned anew   = dig_fit_select(&s->fit, s->least, 0);
        const unsigned more   = dig_fit_select(&s->fit, s->least, before);
        s->set = dig_fit_evidence(&s->fit, anew) >= dig_fit_evidence(&s->fit, more) - s->least
                     ? anew
                     : more;
        if (s->set == before) {
            break;
        }
    }
    take_weight_for_payload(s);
}

static void begin_again(struct dig_machine_search *const s)
{
    memset(s->fit.lines.at, 0, s->fit.lines.columns * sizeof(double));
    stand(s);
}

// The one of the set that explains most alone.
static unsigned leader_of(const struct dig_machine_search *const s, const unsigned set)
{
    double   most = -INFINITY;
    unsigned best = 0;
    for (unsigned e = 0; e < DIG_MACHINE_EFFECTS; e++) {
        const unsigned one = set & (1U << e);
        if (one != 0 && dig_fit_evidence(&s->fit, one) > most) {
            most = dig_fit_evidence(&s->fit, one);
            best = one;
        }
    }
    return best;
}

// Where the search has come to.
struct reached {
    unsigned set;
    double   at[DIG_LINES_COLUMNS_MAX];
    double   merit;
    bool     clear;
};

// The log evidence of the set, of rows as far as they are trusted where it stands, less what its
// effects must bring.
static double merit_of(const struct dig_machine_search *const s)
{
    double trust = 0.0;
    for (size_t r = 0; r < s->air.rows; r++) {
        trust += log(s->fit.lines.trust[r]);
    }
    return dig_fit_evidence(&s->fit, s->set) + s->fit.log_none - 0.5 * s->fit.rest2 / s->fit.s2 -
           0.5 * (double)s->air.rows * log(s->fit.s2) + trust -
           s->least * __builtin_popcount(s->set);
}

static void reach(struct dig_machine_search *const s, struct reached *const reached)
{
    *reached = (struct reached){ .set   = s->set,
                                 .merit = merit_of(s),
                                 .clear = !dig_machine_is_unclear(s) };
    memcpy(reached->at, s->fit.lines.at, sizeof reached->at);
}

// Begins with these, and stays with what is better: that, or what was reached before.
static void try_with(struct dig_machine_search *const s, const unsigned first,
                     struct reached *const best)
{
    struct reached now;
    begin_again(s);
    join(s, first);
    reach(s, &now);
    if (now.clear == best->clear ? now.merit > best->merit : now.clear) {
        *best = now;
        return;
    }
    s->set = best->set;
    memcpy(s->fit.lines.at, best->at, sizeof best->at);
    stand(s);
}

static void select_effects(struct dig_machine_search *const s)
{
    settle(s);
    write_residuals(s);
    const unsigned first = dig_fit_select(&s->fit, s->least, 0);
    // Where one leads, the others may not be needed: they explain what its slope there does not.
    // But alone it may take what is another's for its own, and then stays there.
    unsigned       leads  = leader_of(s, first);
    unsigned       others = first & ~leads;
    struct reached best;
    join(s, leads);
    reach(s, &best);
    if (others != 0) {
        try_with(s, first, &best);
    }
    while (others != 0 && !best.clear) {
        begin_again(s);
        leads = leader_of(s, others);
        others &= ~leads;
        try_with(s, leads, &best);
    }
}

// Nothing is explained, and only the rows of the air before digs are trusted, or of that after.
static void trust_only(struct dig_machine_search *const s, const bool after)
{
    memset(s->fit.lines.at, 0, s->fit.lines.columns * sizeof(double));
    for (size_t i = 0; i < s->air.segments; i++) {
        const struct dig_air_segment *const segment = &s->air.segment[i];
        for (size_t r = segment->first_row; r < segment->first_row + segment->rows; r++) {
            s->fit.lines.trust[r] = segment->after == after ? 1.0 : 0.0;
        }
    }
}

static void trust_all(struct dig_machine_search *const s)
{
    for (size_t r = 0; r < s->air.rows; r++) {
        s->fit.lines.trust[r] = 1.0;
    }
}

// All effects together may take what slewing pulls for their own, where it goes with the same
// motion in every dig. Where air is not understood, what slewing would be beside the effects of the
// air before digs alone, or of that after, is left out - if the rest is understood then. An effect
// that explains all air is believed: what it pulls may look like slewing to half of the air.
void dig_machine_select(struct dig_machine_search *const s)
{
    select_effects(s);
    dig_slew_rows_save(&s->air, &s->kept);
    const struct dig_machine_search found = *s;
    bool                            clear = !dig_machine_is_unclear(s);
    const bool                      asked = !clear;
    for (int after = 0; after < 2 && !clear; after++) {
        dig_slew_rows_restore(&s->all, &s->air);
        trust_only(s, after > 0);
        if (leave_out(s, DIG_SLEW_LONG)) {
            trust_all(s);
            dig_machine_begin(s);
            select_effects(s);
            clear = !dig_machine_is_unclear(s);
        }
    }
    if (asked && !clear) {
        *s = found;
        dig_slew_rows_restore(&s->kept, &s->air);
        stand(s);
    }
}

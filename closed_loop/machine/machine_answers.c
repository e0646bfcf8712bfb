#include "closed_loop/machine/machine_search.h"

#include "closed_loop/numeric/dense.h"
#include "estimator/effects/effect.h"

#include <math.h>
#include <string.h>

// 5 % and 95 % of a normal distribution, in its sigmas.
static const double ninety = 1.645;

// In a parameter's scale squared: as good as none.
static const double least_variance = 1e-10;

// In its scale: what is off by no more changes no gravel.
static const double least_far = 0.02;

struct dig_model_effect dig_machine_effect(const struct dig_machine_search *const s,
                                           const enum dig_effect_id id, const double probability)
{
    const struct dig_effect *const effect = dig_effect_of(id);
    const size_t                   first  = dig_lines_first(&s->fit.lines, id);
    const size_t                   n      = s->fit.lines.columns;
    struct dig_model_effect        made   = { .effect      = id,
                                              .probability = probability,
                                              .parameters  = effect->parameters };
    for (size_t i = 0; i < effect->parameters; i++) {
        const struct dig_effect_parameter *const of = &effect->parameter[i];
        struct dig_model_parameter *const        p  = &made.parameter[i];

        const double value = of->absent + of->scale * s->fit.at[first + i];
        const double wide =
            ninety * of->scale * sqrt(fmax(s->fit.covariance[(n + 1) * (first + i)], 0.0));
        memcpy(p->name, of->name, strlen(of->name) + 1);
        p->value = fmin(fmax(value, of->low), of->high);
        p->low   = value - wide;
        p->high  = value + wide;
    }
    return made;
}

// The numbers of an answer in their order: their columns, and their scales; 0: it has no column.
struct numbers {
    size_t n;
    size_t column[DIG_MACHINE_NUMBERS];
    double scale[DIG_MACHINE_NUMBERS];
};

static void add_number(const size_t column, const double scale, struct numbers *const to)
{
    to->column[to->n]  = column;
    to->scale[to->n++] = scale;
}

static void list_numbers(const struct dig_lines *const lines, const size_t effects,
                         const struct dig_model_effect effect[], struct numbers *const numbers)
{
    numbers->n = 0;
    for (size_t e = 0; e < effects; e++) {
        const struct dig_effect *const of = dig_effect_of(effect[e].effect);
        for (size_t i = 0; i < of->parameters; i++) {
            add_number(dig_lines_first(lines, of->id) + i, of->parameter[i].scale, numbers);
        }
    }
    const size_t first = numbers->n;
    for (size_t f = 0; f < DIG_FILE_ERRORS; f++) {
        add_number(0, 0.0, numbers);
    }
    for (size_t c = 0; c < lines->columns; c++) {
        if (lines->column[c].effect == DIG_EFFECT_UNLISTED) {
            numbers->column[first + lines->column[c].parameter] = c;
            numbers->scale[first + lines->column[c].parameter]  = lines->column[c].scale;
        }
    }
}

// A square root of the covariance of an answer's numbers, as last solved.
static void write_steps(const struct dig_machine_search *const s,
                        const struct numbers *const            numbers,
                        struct dig_machine_answer *const       answer)
{
    double       lower[DIG_MACHINE_NUMBERS * DIG_MACHINE_NUMBERS];
    const size_t n   = numbers->n;
    bool         any = false;
    for (size_t i = 0; i < n; i++) {
        for (size_t j = 0; j <= i; j++) {
            const size_t at    = numbers->column[i] * s->fit.lines.columns + numbers->column[j];
            const bool   known = numbers->scale[i] > 0.0 && numbers->scale[j] > 0.0;
            lower[i * n + j]   = known ? s->fit.covariance[at] : 0.0;
        }
        lower[i * n + i] += least_variance; // of one that is not fitted
        any = any || numbers->scale[i] > 0.0;
    }
    if (!any || dig_cholesky(n, lower) != DIG_OK) {
        return;
    }
    answer->numbers = n;
    for (size_t k = 0; k < n; k++) {
        for (size_t i = k; i < n; i++) {
            answer->step[k][i] = numbers->scale[i] * lower[i * n + k];
        }
    }
}

// One number of an effect beside an answer, as free air has it.
struct beside {
    size_t column;
    double log_weight; // against the answer
    double far;        // from absent, root mean square in its scale
};

// Solves for it beside an answer's effects, whose priors are so wide: the log evidence.
static double solve_beside(const struct dig_machine_search *const s, const double widths[],
                           const size_t column)
{
    double with[DIG_LINES_COLUMNS_MAX];
    memcpy(with, widths, s->fit.lines.columns * sizeof with[0]);
    with[column] = 1.0;
    return dig_fit_solve_each(&s->fit, with, DIG_FIT_COVARIANCE).log_evidence;
}

// All such numbers; how many.
static size_t find_beside(struct dig_machine_search *const s, const double widths[],
                          struct beside beside[DIG_LINES_COLUMNS_MAX])
{
    const size_t n       = s->fit.lines.columns;
    const double without = dig_fit_solve_each(&s->fit, widths, DIG_FIT_NOTHING).log_evidence;
    size_t       found   = 0;
    for (size_t c = 0; c < n; c++) {
        const struct dig_lines_column *const column = &s->fit.lines.column[c];
        if (widths[c] > 0.0 || column->segment >= 0 || dig_lines_is_bent(&s->fit.lines, c)) {
            continue;
        }
        const double with = solve_beside(s, widths, c);
        beside[found++]   = (struct beside){
              .column     = c,
              .log_weight = with - without - log((double)dig_effect_of(column->effect)->parameters),
              .far        = hypot(s->fit.at[c], sqrt(s->fit.covariance[(n + 1) * c])),
        };
    }
    return found;
}

// Makes far what it is in the mixture, and leaves the farthest first.
static void mix(const size_t n, struct beside beside[])
{
    double most = 0.0; // of the answer itself
    double sum  = 0.0;
    for (size_t i = 0; i < n; i++) {
        most = fmax(most, beside[i].log_weight);
    }
    for (size_t i = 0; i < n; i++) {
        sum += exp(beside[i].log_weight - most);
    }
    for (size_t i = 0; i < n; i++) {
        struct beside now = beside[i];
        size_t        to  = i;
        now.far *= sqrt(exp(now.log_weight - most) / (exp(-most) + sum));
        for (; to > 0 && beside[to - 1].far < now.far; to--) {
            beside[to] = beside[to - 1];
        }
        beside[to] = now;
    }
}

// What of the effects that an answer lacks free air leaves open beside it. Overwrites what was last
// solved.
static void write_others(struct dig_machine_search *const s, const struct numbers *const numbers,
                         const double widths[], struct dig_machine_answer *const answer)
{
    const size_t  n = s->fit.lines.columns;
    struct beside beside[DIG_LINES_COLUMNS_MAX];
    const size_t  found = find_beside(s, widths, beside);
    mix(found, beside);
    for (size_t i = 0; i < found && answer->others < DIG_MACHINE_OTHERS; i++) {
        const size_t                         c      = beside[i].column;
        const struct dig_lines_column *const column = &s->fit.lines.column[c];
        struct dig_machine_other *const      other  = &answer->other[answer->others];
        if (!(beside[i].far > least_far)) {
            break;
        }
        (void)solve_beside(s, widths, c);
        *other = (struct dig_machine_other){ .effect    = column->effect,
                                             .parameter = column->parameter,
                                             .value     = column->scale * beside[i].far };
        for (size_t k = 0; k < numbers->n; k++) {
            const double slope =
                s->fit.covariance[numbers->column[k] * n + c] / s->fit.covariance[(n + 1) * c];
            other->with[k] = numbers->scale[k] * slope * beside[i].far;
        }
        answer->others++;
    }
}

// One answer by the narrow priors or the wide ones: its values, and what is open of them. False
// where the wide ones are the narrow ones.
static bool write_answer(struct dig_machine_search *const s, const size_t effects,
                         const struct dig_model_effect effect[], const bool wide,
                         struct dig_machine_answer *const answer)
{
    struct numbers numbers;
    double         widths[DIG_LINES_COLUMNS_MAX];
    size_t         n   = 0;
    unsigned       set = 0;
    for (size_t e = 0; e < effects; e++) {
        set |= 1U << (unsigned)effect[e].effect;
    }
    struct dig_fit_answer solved = dig_fit_solve(&s->fit, set, DIG_FIT_COVARIANCE);
    if (wide) {
        const double narrow = solved.width;
        solved              = dig_fit_solve_wide(&s->fit, set, DIG_FIT_COVARIANCE);
        if (!(solved.width > narrow)) {
            return false;
        }
    }
    *answer = (struct dig_machine_answer){ .effects      = effects,
                                           .wide         = wide,
                                           .log_evidence = solved.log_evidence };
    list_numbers(&s->fit.lines, effects, effect, &numbers);
    dig_fit_widths(&s->fit, set, solved.width, widths);
    if (s->unlike.is && effects == 0) {
        widths[s->unlike.column] = DIG_UNLIKE_WIDTH;
        (void)dig_fit_solve_each(&s->fit, widths, DIG_FIT_COVARIANCE);
    }
    for (size_t e = 0; e < effects; e++) {
        const struct dig_model_effect now = dig_machine_effect(s, effect[e].effect, 0.0);
        answer->effect[e]                 = effect[e];
        for (size_t i = 0; i < now.parameters; i++) {
            answer->value[n++] = now.parameter[i].value;
        }
    }
    dig_lines_file(&s->fit.lines, s->fit.at, answer->file);
    memcpy(&answer->value[n], answer->file, sizeof answer->file);
    write_steps(s, &numbers, answer);
    if (answer->numbers > 0) {
        write_others(s, &numbers, widths, answer);
    }
    return true;
}

void dig_machine_write_none(struct dig_machine_search *const  s,
                            struct dig_machine_finding *const finding)
{
    (void)write_answer(s, 0, NULL, false, &finding->none);
}

static void write_both(struct dig_machine_search *const s, const size_t effects,
                       const struct dig_model_effect     effect[],
                       struct dig_machine_finding *const finding)
{
    for (int wide = 0; wide < 2; wide++) {
        finding->answers +=
            write_answer(s, effects, effect, wide > 0, &finding->answer[finding->answers]) ? 1 : 0;
    }
}

// The set found, where it is of several, and every candidate alone.
void dig_machine_write_answers(struct dig_machine_search *const  s,
                               struct dig_machine_finding *const finding)
{
    finding->answers = 0;
    if (finding->effects > 1) {
        write_both(s, finding->effects, finding->effect, finding);
    }
    for (size_t i = 0; i < finding->candidates; i++) {
        const struct dig_model_effect *const alone = &finding->candidate[i].as;
        const bool found = finding->effects == 1 && finding->effect[0].effect == alone->effect;
        write_both(s, 1, found ? &finding->effect[0] : alone, finding);
    }
}

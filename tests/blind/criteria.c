#include "tests/blind/criteria.h"

#include <math.h>
#include <string.h>

#define SURE 0.5

// What the rows ask: digs of our DEM or of another code, and size in all or in the soil alone.
enum { ANY = -1, ANOTHER, OURS };
enum { ALL, SOIL };

struct blind_share blind_share_of(const size_t k, const size_t n)
{
    if (n == 0) {
        return (struct blind_share){ k, n, 0.0, 1.0 };
    }
    const double z      = 1.96;
    const double p      = (double)k / (double)n;
    const double zz     = z * z / (double)n;
    const double middle = (p + zz / 2.0) / (1.0 + zz);
    const double half   = z * sqrt(p * (1.0 - p) / (double)n + zz / (4.0 * (double)n)) / (1.0 + zz);
    return (struct blind_share){ k, n, fmax(middle - half, 0.0), fmin(middle + half, 1.0) };
}

// An effect of the catalogue, claimed with a probability above one half.
static bool is_sure(const struct blind_result *const r, const size_t i)
{
    return r->verdict.probability[i] > SURE && strcmp(r->verdict.effect[i], "unlisted") != 0;
}
static size_t sure_of_any(const struct blind_result *const r)
{
    bool is = false;
    for (size_t i = 0; i < r->verdict.effects; i++) {
        is = is || is_sure(r, i);
    }
    return is;
}
// One that is not there.
static size_t sure_of_wrong(const struct blind_result *const r)
{
    bool is = false;
    for (size_t i = 0; i < r->verdict.effects; i++) {
        is = is || (is_sure(r, i) && !blind_justified(r, r->verdict.effect[i]));
    }
    return is;
}

static size_t alarmed(const struct blind_result *const r)
{
    return !blind_says(r, "none");
}
static size_t is_right(const struct blind_result *const r)
{
    return blind_answer_of(r) == BLIND_RIGHT || blind_answer_of(r) == BLIND_IN_SET;
}
static size_t has_both(const struct blind_result *const r)
{
    return blind_found(r, &r->order.effect[0]) && blind_found(r, &r->order.effect[1]);
}
static size_t is_unlisted(const struct blind_result *const r)
{
    return blind_says(r, "unlisted");
}
static size_t has_after(const struct blind_result *const r)
{
    return isfinite(r->verdict.after);
}
static size_t is_near_oracle(const struct blind_result *const r)
{
    return r->verdict.after <= 1.15 * r->truth.error;
}
static size_t has_errors(const struct blind_result *const r)
{
    return isfinite(r->verdict.before) && isfinite(r->verdict.after);
}
static size_t made_worse(const struct blind_result *const r)
{
    return r->verdict.after > r->verdict.before * (1.0 + 1e-9);
}
static size_t whole(const struct blind_result *const r)
{
    (void)r;
    return 1;
}
static size_t traced(const struct blind_result *const r)
{
    return r->state == BLIND_TRACED;
}
static size_t is_quick(const struct blind_result *const r)
{
    return r->cpu_s <= 10.0 && r->peak_B <= 500e6;
}

// Ground whose gravel a trace is to find: the rate's formula changes the size of a dig as density
// does, and a pair's effects are of two kinds.
static bool has_gravel(const struct blind_result *const r)
{
    return r->order.kind == BLIND_NONE || (r->order.kind == BLIND_SINGLE &&
                                           strcmp(r->order.effect[0].name, "rate_dependence") != 0);
}
static bool is_soil_effect(const struct blind_result *const r)
{
    return r->order.kind == BLIND_SINGLE && r->order.effect[0].how != BLIND_BY_MACHINE;
}
static size_t plain_gravel(const struct blind_result *const r)
{
    return has_gravel(r) && !is_soil_effect(r) ? DIG_AXES : 0;
}
// Beside an effect that was found: of one that was not, the gravel is told wrongly with reason.
static size_t gravel_beside(const struct blind_result *const r)
{
    return has_gravel(r) && is_soil_effect(r) && is_right(r) ? DIG_AXES : 0;
}
static size_t gravel_held(const struct blind_result *const r)
{
    size_t held = 0;
    for (int a = 0; a < DIG_AXES; a++) {
        held += r->gravel.value[a] >= r->verdict.gravel_low.value[a] &&
                        r->gravel.value[a] <= r->verdict.gravel_high.value[a]
                    ? 1
                    : 0;
    }
    return held;
}
// Which effect of the verdict is the one that is there; the number of effects when none is.
static size_t named(const struct blind_result *const r)
{
    size_t i = 0;
    while (i < r->verdict.effects && strcmp(r->verdict.effect[i], r->order.effect[0].name) != 0) {
        i++;
    }
    return i;
}
// Compaction has no magnitude of its own: it is what passes before did.
static size_t magnitude(const struct blind_result *const r)
{
    return is_soil_effect(r) && strcmp(r->order.effect[0].name, "compaction") != 0 &&
           strcmp(r->order.effect[0].name, "rate_dependence") != 0 && named(r) < r->verdict.effects;
}
static size_t magnitude_held(const struct blind_result *const r)
{
    const size_t i = named(r);
    return r->magnitude >= r->verdict.low[i] && r->magnitude <= r->verdict.high[i] ? 1 : 0;
}

const struct blind_criterion blind_criterion[BLIND_CRITERIA] = {
    { "no effect: false alarms", BLIND_NONE, ANY, ALL, ANY, whole, alarmed, 0.02, false },
    { "one effect, size 3 and more: named or in a small set", BLIND_SINGLE, 3, ALL, ANY, whole,
      is_right, 0.95, true },
    { "one effect, size about 1.5: named or in a small set", BLIND_SINGLE, 1, ALL, ANY, whole,
      is_right, 0.70, true },
    { "one effect, size below 1: something named with p > .5", BLIND_SINGLE, 0, ALL, ANY, whole,
      sure_of_any, 0.05, false },
    { "the same by the size in the soil alone: 3 and more", BLIND_SINGLE, 3, SOIL, ANY, whole,
      is_right, 0.95, true },
    { "  about 1.5", BLIND_SINGLE, 1, SOIL, ANY, whole, is_right, 0.70, true },
    { "  below 1: something named with p > .5", BLIND_SINGLE, 0, SOIL, ANY, whole, sure_of_any,
      0.05, false },
    { "pairs, each of size 3 and more: both named", BLIND_PAIR, 3, ALL, ANY, whole, has_both, 0.80,
      true },
    { "outside the catalogue: a wrong name with p > .5", BLIND_OUTSIDE, ANY, ALL, ANY, whole,
      sure_of_wrong, 0.05, false },
    { "outside the catalogue, size 3 and more: unlisted", BLIND_OUTSIDE, 3, ALL, ANY, whole,
      is_unlisted, 0.80, true },
    { "  the same by the size in the soil alone", BLIND_OUTSIDE, 3, SOIL, ANY, whole, is_unlisted,
      0.80, true },
    { "one effect, size 3 and more: error after <= 1.15 of the oracle's", BLIND_SINGLE, 3, ALL, ANY,
      has_after, is_near_oracle, 0.50, true },
    { "holdout error made worse", ANY, ANY, ALL, ANY, has_errors, made_worse, 0.02, false },
    { "plain gravel or machine: 90 % intervals of the gravel hold, our DEM", ANY, ANY, ALL, OURS,
      plain_gravel, gravel_held, 0.85, true },
    { "  another code", ANY, ANY, ALL, ANOTHER, plain_gravel, gravel_held, 0.75, true },
    { "beside an effect of the soil that was found: of the gravel, our DEM", ANY, ANY, ALL, OURS,
      gravel_beside, gravel_held, 0.85, true },
    { "  another code", ANY, ANY, ALL, ANOTHER, gravel_beside, gravel_held, 0.75, true },
    { "  of its magnitude, our DEM", ANY, ANY, ALL, OURS, magnitude, magnitude_held, 0.85, true },
    { "  another code", ANY, ANY, ALL, ANOTHER, magnitude, magnitude_held, 0.75, true },
    { "traced in 10 s of one core and 500 MB", ANY, ANY, ALL, ANY, traced, is_quick, 1.0, true },
};

static bool fits(const int wanted, const int is)
{
    return wanted == ANY || wanted == is;
}

// A refusal tells no gravel, no error and no time; of what there is it says nothing right.
static bool answers(const struct blind_criterion *const c, const struct blind_result *const r)
{
    return r->state == BLIND_TRACED || (r->state == BLIND_REFUSED && c->about == whole);
}

static size_t about(const struct blind_criterion *const c, const struct blind_result *const r)
{
    const double size = c->in_soil ? blind_size_in_soil(r) : blind_size_of(r);
    const int    code = strcmp(r->source, "ours") == 0 ? OURS : ANOTHER;
    const bool   is   = answers(c, r) && fits(c->kind, (int)r->order.kind) &&
                    fits(c->class, blind_class_of_size(size)) && fits(c->code, code);
    return is ? c->about(r) : 0;
}

struct blind_share blind_criterion_judge(const struct blind_criterion *const c, const size_t n,
                                         const struct blind_result result[])
{
    size_t of     = 0;
    size_t counts = 0;
    for (size_t i = 0; i < n; i++) {
        const size_t things = about(c, &result[i]);
        if (things > 0) {
            of += things;
            counts += c->counts(&result[i]);
        }
    }
    return blind_share_of(counts, of);
}

const char *blind_criterion_holds(const struct blind_criterion *const c,
                                  const struct blind_share *const     s)
{
    if (s->n == 0) {
        return "not tried";
    }
    const double share = (double)s->k / (double)s->n;
    return (c->at_least ? share >= c->bound : share <= c->bound) ? "holds" : "DOES NOT HOLD";
}

#include "tests/blind/criteria.h"

#include <math.h>
#include <string.h>

#define SURE 0.5

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

// An effect of the catalogue that is not there, claimed with a probability above one half.
static bool sure_of_wrong(const struct blind_result *const r)
{
    bool is = false;
    for (size_t i = 0; i < r->verdict.effects; i++) {
        is = is ||
             (r->verdict.probability[i] > SURE && strcmp(r->verdict.effect[i], "unlisted") != 0 &&
              !blind_justified(r, r->verdict.effect[i]));
    }
    return is;
}

static bool sure_of_any(const struct blind_result *const r)
{
    bool is = false;
    for (size_t i = 0; i < r->verdict.effects; i++) {
        is = is ||
             (r->verdict.probability[i] > SURE && strcmp(r->verdict.effect[i], "unlisted") != 0);
    }
    return is;
}

static bool is_none(const struct blind_result *const r)
{
    return r->order.kind == BLIND_NONE;
}
static bool alarmed(const struct blind_result *const r)
{
    return !blind_says(r, "none");
}
static bool is_clear(const struct blind_result *const r)
{
    return r->order.kind == BLIND_SINGLE && blind_class_of(r) == 3;
}
static bool is_middling(const struct blind_result *const r)
{
    return r->order.kind == BLIND_SINGLE && blind_class_of(r) == 1;
}
static bool is_faint(const struct blind_result *const r)
{
    return r->order.kind == BLIND_SINGLE && blind_class_of(r) == 0;
}
static bool is_single_in_soil(const struct blind_result *const r, const int class)
{
    return r->order.kind == BLIND_SINGLE && blind_class_of_size(blind_size_in_soil(r)) == class;
}
static bool is_clear_in_soil(const struct blind_result *const r)
{
    return is_single_in_soil(r, 3);
}
static bool is_middling_in_soil(const struct blind_result *const r)
{
    return is_single_in_soil(r, 1);
}
static bool is_faint_in_soil(const struct blind_result *const r)
{
    return is_single_in_soil(r, 0);
}
static bool is_right(const struct blind_result *const r)
{
    return blind_answer_of(r) == BLIND_RIGHT || blind_answer_of(r) == BLIND_IN_SET;
}
static bool is_clear_pair(const struct blind_result *const r)
{
    return r->order.kind == BLIND_PAIR && blind_class_of(r) == 3;
}
static bool has_both(const struct blind_result *const r)
{
    return blind_found(r, &r->order.effect[0]) && blind_found(r, &r->order.effect[1]);
}
static bool is_outside(const struct blind_result *const r)
{
    return r->order.kind == BLIND_OUTSIDE;
}
static bool is_clear_outside(const struct blind_result *const r)
{
    return r->order.kind == BLIND_OUTSIDE && blind_class_of(r) == 3;
}
static bool is_clear_outside_in_soil(const struct blind_result *const r)
{
    return is_outside(r) && blind_class_of_size(blind_size_in_soil(r)) == 3;
}
static bool is_unlisted(const struct blind_result *const r)
{
    return blind_says(r, "unlisted");
}
static bool is_known(const struct blind_result *const r)
{
    return r->order.kind == BLIND_SINGLE && isfinite(r->verdict.after) && blind_class_of(r) == 3;
}
static bool is_near_oracle(const struct blind_result *const r)
{
    return r->verdict.after <= 1.15 * r->truth.error;
}
static bool has_errors(const struct blind_result *const r)
{
    return isfinite(r->verdict.before) && isfinite(r->verdict.after);
}
static bool made_worse(const struct blind_result *const r)
{
    return r->verdict.after > r->verdict.before * (1.0 + 1e-9);
}
static bool is_any(const struct blind_result *const r)
{
    (void)r;
    return true;
}
static bool is_quick(const struct blind_result *const r)
{
    return r->cpu_s <= 10.0 && r->peak_B <= 500e6;
}

const struct blind_criterion blind_criterion[BLIND_CRITERIA] = {
    { "no effect: false alarms", is_none, alarmed, 0.02, false },
    { "one effect, size 3 and more: named or in a small set", is_clear, is_right, 0.95, true },
    { "one effect, size about 1.5: named or in a small set", is_middling, is_right, 0.70, true },
    { "one effect, size below 1: something named with p > .5", is_faint, sure_of_any, 0.05, false },
    { "the same by the size in the soil alone: 3 and more", is_clear_in_soil, is_right, 0.95,
      true },
    { "  about 1.5", is_middling_in_soil, is_right, 0.70, true },
    { "  below 1: something named with p > .5", is_faint_in_soil, sure_of_any, 0.05, false },
    { "pairs, each of size 3 and more: both named", is_clear_pair, has_both, 0.80, true },
    { "outside the catalogue: a wrong name with p > .5", is_outside, sure_of_wrong, 0.05, false },
    { "outside the catalogue, size 3 and more: unlisted", is_clear_outside, is_unlisted, 0.80,
      true },
    { "  the same by the size in the soil alone", is_clear_outside_in_soil, is_unlisted, 0.80,
      true },
    { "one effect, size 3 and more: error after <= 1.15 of the oracle's", is_known, is_near_oracle,
      0.50, true },
    { "holdout error made worse", has_errors, made_worse, 0.02, false },
    { "traced in 10 s of one core and 500 MB", is_any, is_quick, 1.0, true },
};
struct blind_share blind_criterion_judge(const struct blind_criterion *const c, const size_t n,
                                         const struct blind_result result[])
{
    size_t about  = 0;
    size_t counts = 0;
    for (size_t i = 0; i < n; i++) {
        if (result[i].state == BLIND_TRACED && c->about(&result[i])) {
            about++;
            counts += c->counts(&result[i]) ? 1 : 0;
        }
    }
    return blind_share_of(counts, about);
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

#include "estimator/approach/approaches.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

// Tolerance of equal depths, and of equal angles in rad.
static const double same = 1e-9;

void dig_nodes_of(const struct dig_curve_set *const set, const size_t entry,
                  const size_t trajectory, struct dig_nodes *const nodes)
{
    assert(set != NULL && entry < set->entries && trajectory < set->trajectories && nodes != NULL);
    const struct dig_entry_set *const other = set->approaches;
    const size_t                      slot  = entry * set->trajectories + trajectory;
    nodes->nodes                            = 0;
    if (set->packings[slot] <= 0) {
        return;
    }
    nodes->approach[0] = dig_approach_plain();
    nodes->packings[0] = set->packings[slot];
    nodes->curve[0]    = &set->curve[slot];
    nodes->nodes       = 1;
    for (size_t i = 0; other != NULL && i < other->entries && nodes->nodes < DIG_NODES_MAX; i++) {
        const size_t at = i * other->trajectories + trajectory;
        if (other->packings[at] > 0 &&
            dig_gravel_is_same(&other->entry[i].gravel, &set->gravel[entry])) {
            nodes->approach[nodes->nodes] = other->entry[i].approach;
            nodes->packings[nodes->nodes] = other->packings[at];
            nodes->curve[nodes->nodes++]  = &other->curve[at];
        }
    }
}

// An approach as a point of the plane, the plain one at the origin.
struct point {
    double down_m, turn_m;
};

static struct point place_of(const struct dig_curve_set *const set, const size_t trajectory,
                             const struct dig_approach *const approach)
{
    const struct dig_approach wanted = dig_approach_normalized(approach);
    const double depth_m = set->approaches != NULL ? set->approaches->depth_m[trajectory] : 0.0;
    return (struct point){ depth_m * (wanted.depth - 1.0), set->tooth_m * wanted.attack_rad };
}

double dig_approach_distance_m(const struct dig_curve_set *const set, const size_t trajectory,
                               const struct dig_approach *const a,
                               const struct dig_approach *const b)
{
    const struct point x = place_of(set, trajectory, a);
    const struct point y = place_of(set, trajectory, b);
    return hypot(x.down_m - y.down_m, x.turn_m - y.turn_m);
}

static int compare(const void *const a, const void *const b)
{
    const struct point *const x = a;
    const struct point *const y = b;
    if (x->down_m < y->down_m || x->down_m > y->down_m) {
        return x->down_m < y->down_m ? -1 : 1;
    }
    return (x->turn_m > y->turn_m) - (x->turn_m < y->turn_m);
}

// Positive where c lies to the left of the line from a to b.
static double cross(const struct point *const a, const struct point *const b,
                    const struct point *const c)
{
    return (b->down_m - a->down_m) * (c->turn_m - a->turn_m) -
           (b->turn_m - a->turn_m) * (c->down_m - a->down_m);
}

// Andrew's monotone chain: the corners of the hull, counter-clockwise, of sorted points.
static size_t chain(const size_t n, const struct point point[], struct point hull[])
{
    size_t corners = 0;
    for (size_t half = 0; half < 2; half++) {
        const size_t least = corners + (half == 0 ? 1 : 0);
        for (size_t i = 0; i < n; i++) {
            const struct point *const p = &point[half == 0 ? i : n - 1 - i];
            if (half == 1 && i == 0) {
                continue; // the last of the first half
            }
            while (corners > least && cross(&hull[corners - 2], &hull[corners - 1], p) <= 0.0) {
                corners--;
            }
            hull[corners++] = *p;
        }
    }
    return corners > 1 ? corners - 1 : corners; // the first again
}

// The distinct points dug at by any gravel, the plain one included, sorted.
static size_t collect(const struct dig_curve_set *const set, const size_t trajectory,
                      struct point point[const DIG_NODES_MAX])
{
    const struct dig_entry_set *const other = set->approaches;
    size_t                            n     = 1;
    point[0]                                = (struct point){ 0.0, 0.0 };
    for (size_t i = 0; other != NULL && i < other->entries && n < DIG_NODES_MAX; i++) {
        const struct point p = place_of(set, trajectory, &other->entry[i].approach);
        bool new             = other->packings[i * other->trajectories + trajectory] > 0;
        for (size_t k = 0; new &&k < n; k++) {
            new =
                hypot(p.down_m - point[k].down_m, p.turn_m - point[k].turn_m) > same * set->tooth_m;
        }
        if (new) {
            point[n++] = p;
        }
    }
    qsort(point, n, sizeof *point, compare);
    return n;
}

// The point between a and b nearest to p.
static struct point nearest_between(const struct point *const a, const struct point *const b,
                                    const struct point *const p)
{
    const double x = b->down_m - a->down_m;
    const double y = b->turn_m - a->turn_m;
    const double l = x * x + y * y;
    const double f =
        l > 0.0 ? ((p->down_m - a->down_m) * x + (p->turn_m - a->turn_m) * y) / l : 0.0;
    const double g = fmin(fmax(f, 0.0), 1.0);
    return (struct point){ a->down_m + g * x, a->turn_m + g * y };
}

double dig_approach_clamp(const struct dig_curve_set *const set, const size_t trajectory,
                          const struct dig_approach *const approach,
                          struct dig_approach *const       nearest)
{
    assert(set != NULL && approach != NULL && nearest != NULL && trajectory < set->trajectories);
    struct point point[DIG_NODES_MAX];
    struct point hull[2 * DIG_NODES_MAX] = { { 0.0, 0.0 } };
    const size_t n                       = collect(set, trajectory, point);
    const size_t corners                 = chain(n, point, hull);

    const struct point p      = place_of(set, trajectory, approach);
    struct point       best   = hull[0];
    double             away_m = INFINITY;
    bool               inside = corners > 2;
    for (size_t i = 0; i < corners; i++) {
        const struct point *const next = &hull[(i + 1) % corners];
        const struct point        near = nearest_between(&hull[i], next, &p);
        const double              d_m  = hypot(p.down_m - near.down_m, p.turn_m - near.turn_m);
        inside                         = inside && cross(&hull[i], next, &p) >= 0.0;
        if (d_m < away_m) {
            away_m = d_m;
            best   = near;
        }
    }
    if (inside) {
        *nearest = dig_approach_normalized(approach);
        return 0.0;
    }
    const double depth_m = set->approaches != NULL ? set->approaches->depth_m[trajectory] : 0.0;
    *nearest             = (struct dig_approach){ depth_m > 0.0 ? 1.0 + best.down_m / depth_m : 1.0,
                                      best.turn_m / set->tooth_m };
    return away_m;
}

// The two nodes on one axis (the other plain) that a value lies between, and how far along; false
// when it lies beyond them all.
struct bracket {
    size_t low, high;
    double f;
};

double dig_approach_on_axis(const struct dig_approach *const approach, const bool attack)
{
    return attack ? approach->attack_rad : approach->depth;
}

static bool find_bracket(const struct dig_nodes *const nodes, const bool attack, const double value,
                         struct bracket *const bracket)
{
    const struct dig_approach plain = dig_approach_plain();
    const double              zero  = dig_approach_on_axis(&plain, !attack);
    size_t                    low   = DIG_NODES_MAX;
    size_t                    high  = DIG_NODES_MAX;
    for (size_t i = 0; i < nodes->nodes; i++) {
        const double at = dig_approach_on_axis(&nodes->approach[i], attack);
        if (fabs(dig_approach_on_axis(&nodes->approach[i], !attack) - zero) > same) {
            continue;
        }
        if (at <= value + same &&
            (low == DIG_NODES_MAX || at > dig_approach_on_axis(&nodes->approach[low], attack))) {
            low = i;
        }
        if (at >= value - same &&
            (high == DIG_NODES_MAX || at < dig_approach_on_axis(&nodes->approach[high], attack))) {
            high = i;
        }
    }
    if (low == DIG_NODES_MAX || high == DIG_NODES_MAX) {
        return false;
    }
    const double from = dig_approach_on_axis(&nodes->approach[low], attack);
    const double to   = dig_approach_on_axis(&nodes->approach[high], attack);
    const double f    = to - from > same ? (value - from) / (to - from) : 0.0;
    *bracket          = (struct bracket){ low, high, fmin(fmax(f, 0.0), 1.0) };
    return true;
}

bool dig_approach_span(const struct dig_nodes *const nodes, const bool attack, const double value,
                       double *const low, double *const high)
{
    struct bracket bracket;
    if (!find_bracket(nodes, attack, value, &bracket)) {
        return false;
    }
    *low  = dig_approach_on_axis(&nodes->approach[bracket.low], attack);
    *high = dig_approach_on_axis(&nodes->approach[bracket.high], attack);
    return true;
}

static size_t find_node(const struct dig_nodes *const nodes, const double depth,
                        const double attack_rad)
{
    size_t i = 0;
    while (i < nodes->nodes && (fabs(nodes->approach[i].depth - depth) > same ||
                                fabs(nodes->approach[i].attack_rad - attack_rad) > same)) {
        i++;
    }
    return i;
}

// Bilinear in the cell; false when one of its corners that weighs was not dug.
static bool weigh_cell(const struct dig_nodes *const nodes, const struct bracket *const depth,
                       const struct bracket *const attack, double weight[const DIG_NODES_MAX])
{
    for (unsigned corner = 0; corner < 4; corner++) {
        const bool   deep   = (corner & 1U) != 0;
        const bool   turned = (corner & 2U) != 0;
        const double w =
            (deep ? depth->f : 1.0 - depth->f) * (turned ? attack->f : 1.0 - attack->f);
        const size_t at =
            find_node(nodes, nodes->approach[deep ? depth->high : depth->low].depth,
                      nodes->approach[turned ? attack->high : attack->low].attack_rad);
        if (w > 0.0 && at == nodes->nodes) {
            return false;
        }
        if (w > 0.0) {
            weight[at] += w;
        }
    }
    return true;
}

bool dig_approach_weigh(const struct dig_nodes *const    nodes,
                        const struct dig_approach *const approach,
                        double                           weight[const DIG_NODES_MAX])
{
    assert(nodes != NULL && approach != NULL);
    const struct dig_approach wanted = dig_approach_normalized(approach);
    struct bracket            depth;
    struct bracket            attack;
    if (nodes->nodes == 0 || !find_bracket(nodes, false, wanted.depth, &depth) ||
        !find_bracket(nodes, true, wanted.attack_rad, &attack)) {
        return false;
    }
    double cell[DIG_NODES_MAX] = { 0.0 };
    if (weigh_cell(nodes, &depth, &attack, cell)) {
        for (size_t i = 0; i < nodes->nodes; i++) {
            weight[i] = cell[i];
        }
        return true;
    }
    for (size_t i = 0; i < nodes->nodes; i++) {
        weight[i] = i == 0 ? -1.0 : 0.0; // the plain one stands on both axes
    }
    weight[depth.low] += 1.0 - depth.f;
    weight[depth.high] += depth.f;
    weight[attack.low] += 1.0 - attack.f;
    weight[attack.high] += attack.f;
    return true;
}

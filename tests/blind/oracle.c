#include "tests/blind/oracle.h"

#include "estimator/approach/interpolate.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define FINE_FRICTION 13
#define FINE_ROLLING  13
#define FINE_DENSITY  9
#define FINE          ((size_t)FINE_FRICTION * FINE_ROLLING * FINE_DENSITY)

struct point {
    bool               there;
    struct blind_curve mean[BLIND_PATHS];
    struct blind_curve sd[BLIND_PATHS]; // of one dig
    double             inverse_packings[BLIND_PATHS];
};

struct blind_oracle {
    const struct dig_curve_set  *set;
    const struct dig_trajectory *trajectory[BLIND_PATHS];
    size_t                       index[BLIND_PATHS];  // of the trajectory in the set
    struct blind_curve           weight[BLIND_PATHS]; // seconds of rig time a point stands for
    struct point                *point;               // [FINE]
};

static bool fill(const struct dig_curve_set *const set, const struct dig_gravel *const gravel,
                 const size_t trajectory[BLIND_PATHS], struct point *const point)
{
    for (int p = 0; p < BLIND_PATHS; p++) {
        struct dig_cell cell;
        if (dig_cell_find(set, gravel, trajectory[p], &cell) != DIG_OK) {
            return false;
        }
        point->inverse_packings[p] = cell.inverse_packings;
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            point->mean[p].y[k] = dig_cell_mean(&cell, DIG_CHANNEL_MY_Nm, k);
            point->sd[p].y[k]   = dig_cell_sd(&cell, DIG_CHANNEL_MY_Nm, k);
        }
    }
    return true;
}

static void fill_weight(struct blind_oracle *const o, const int p)
{
    double last = 0.0;
    for (int k = 1; k < DIG_CURVE_POINTS; k++) {
        const double t_s = dig_trajectory_time_s(o->trajectory[p], o->set->tooth_m,
                                                 (double)k / (DIG_CURVE_POINTS - 1));
        o->weight[p].y[k - 1] += 0.5 * (t_s - last);
        o->weight[p].y[k] += 0.5 * (t_s - last);
        last = t_s;
    }
}

enum dig_status blind_oracle_create(const struct dig_curve_set *const set,
                                    struct blind_oracle **const       oracle,
                                    struct dig_error *const           error)
{
    static const double steps[DIG_AXES] = { FINE_FRICTION - 1, FINE_ROLLING - 1, FINE_DENSITY - 1 };

    struct blind_oracle *const o = calloc(1, sizeof *o);
    if (o != NULL) {
        o->point = calloc(FINE, sizeof *o->point);
    }
    if (o == NULL || o->point == NULL) {
        blind_oracle_destroy(o);
        return dig_error_set(error, DIG_ENOMEM, "out of memory");
    }
    o->set = set;
    for (int p = 0; p < BLIND_PATHS; p++) {
        size_t t = 0;
        while (t < set->trajectories &&
               strcmp(set->trajectory[t].name, blind_path_name((enum blind_path)p)) != 0) {
            t++;
        }
        if (t == set->trajectories) {
            blind_oracle_destroy(o);
            return dig_error_set(error, DIG_EINVAL, "the table has no trajectory %s",
                                 blind_path_name((enum blind_path)p));
        }
        o->index[p]      = t;
        o->trajectory[p] = &set->trajectory[t];
        fill_weight(o, p);
    }
    for (size_t i = 0; i < FINE; i++) {
        const double      at[DIG_AXES] = { (double)(i / (FINE_ROLLING * FINE_DENSITY)),
                                           (double)(i / FINE_DENSITY % FINE_ROLLING),
                                           (double)(i % FINE_DENSITY) };
        struct dig_gravel gravel;
        for (int a = 0; a < DIG_AXES; a++) {
            gravel.value[a] = dig_axis_value(set, (enum dig_axis)a, at[a] / steps[a]);
        }
        o->point[i].there = fill(set, &gravel, o->index, &o->point[i]);
    }
    *oracle = o;
    return DIG_OK;
}

void blind_oracle_destroy(struct blind_oracle *const oracle)
{
    if (oracle != NULL) {
        free(oracle->point);
        free(oracle);
    }
}

// Integral of (a - b)^2 over rig time.
static double apart(const struct blind_curve *const weight, const struct blind_curve *const a,
                    const struct blind_curve *const b)
{
    double sum = 0.0;
    for (int k = 0; k < DIG_CURVE_POINTS; k++) {
        sum += weight->y[k] * (a->y[k] - b->y[k]) * (a->y[k] - b->y[k]);
    }
    return sum;
}

// Mean curves of the digs that may be fitted, by path.
struct means {
    size_t             digs[BLIND_PATHS];
    struct blind_curve y[BLIND_PATHS];
};

static void add(struct means *const m, const enum blind_path path,
                const struct blind_curve *const curve)
{
    m->digs[path]++;
    for (int k = 0; k < DIG_CURVE_POINTS; k++) {
        m->y[path].y[k] += (curve->y[k] - m->y[path].y[k]) / (double)m->digs[path];
    }
}

// The point of the fine grid nearest to these means.
static const struct point *nearest(const struct blind_oracle *const o, const struct means *const m,
                                   double *const least)
{
    const struct point *best = NULL;
    for (size_t i = 0; i < FINE; i++) {
        double sum = 0.0;
        for (int p = 0; p < BLIND_PATHS && o->point[i].there; p++) {
            sum += (double)m->digs[p] * apart(&o->weight[p], &o->point[i].mean[p], &m->y[p]);
        }
        if (o->point[i].there && (best == NULL || sum < *least)) {
            best   = &o->point[i];
            *least = sum;
        }
    }
    return best;
}

// Mean of a group's beds along a path at the table's speed, and its scatter's integral.
static enum dig_status group_mean(const struct blind_oracle *const o,
                                  const struct blind_group *const group, const enum blind_path path,
                                  const int without_bed, struct blind_curve *const mean,
                                  double *const scatter)
{
    struct means       m      = { .digs = { 0 } };
    struct blind_curve sq     = { { 0.0 } };
    enum dig_status    status = DIG_OK;
    for (size_t b = 0; b < group->beds && status == DIG_OK; b++) {
        struct blind_curve curve;
        if ((int)b == without_bed) {
            continue;
        }
        status = blind_curve_of(o->trajectory[path], o->set->tooth_m, 1.0, &group->bed[b].dig[path],
                                &curve);
        for (int k = 0; k < DIG_CURVE_POINTS && status == DIG_OK; k++) {
            sq.y[k] += curve.y[k] * curve.y[k];
        }
        if (status == DIG_OK) {
            add(&m, path, &curve);
        }
    }
    *mean          = m.y[path];
    *scatter       = 0.0;
    const double n = (double)m.digs[path];
    for (int k = 0; k < DIG_CURVE_POINTS && n > 1.0; k++) {
        const double y = m.y[path].y[k];
        *scatter += o->weight[path].y[k] * fmax(sq.y[k] / n - y * y, 0.0) / (n - 1.0);
    }
    return status;
}

// What effect e adds along each path, and the square that noise alone would make of it.
static enum dig_status difference(const struct blind_oracle *const   o,
                                  const struct blind_campaign *const c, const size_t e,
                                  const struct means *const alone,
                                  const struct means *const without, struct means *const d,
                                  double *const noise)
{
    const bool   in_pool = c->order.effect[e].how == BLIND_BY_POOL;
    struct point table;
    // Without plain beds of this gravel the table's own means stand for them.
    if (in_pool && c->plain == NULL && !fill(o->set, &c->group->gravel, o->index, &table)) {
        return DIG_ENOMATCH;
    }
    *noise = 0.0;
    *d     = *alone;
    for (int p = 0; p < BLIND_PATHS; p++) {
        struct blind_curve there = without->y[p];
        struct blind_curve plain = without->y[p];
        double             a     = 0.0;
        double             b     = 0.0;
        if (alone->digs[p] == 0) {
            continue;
        }
        if (in_pool) {
            const enum blind_path path   = (enum blind_path)p;
            enum dig_status       status = group_mean(o, c->group, path, -1, &there, &a);
            if (status == DIG_OK && c->plain != NULL) {
                status = group_mean(o, c->plain, path, -1, &plain, &b);
            } else if (status == DIG_OK) {
                plain = table.mean[p];
            }
            if (status != DIG_OK) {
                return status;
            }
        }
        *noise += (double)alone->digs[p] * (a + b);
        for (int k = 0; k < DIG_CURVE_POINTS; k++) {
            d->y[p].y[k] = alone->y[p].y[k] - without->y[p].y[k] + there.y[k] - plain.y[k];
        }
    }
    return DIG_OK;
}

static double floor_square(const struct blind_oracle *const o, const struct means *const m,
                           const struct point *const at)
{
    const struct blind_curve zero = { { 0.0 } };
    double                   sum  = 0.0;
    for (int p = 0; p < BLIND_PATHS; p++) {
        if (m->digs[p] == 0) {
            continue;
        }
        const double one = apart(&o->weight[p], &at->sd[p], &zero);
        sum += (double)m->digs[p] * one * (1.0 / (double)m->digs[p] + at->inverse_packings[p]);
    }
    return sum;
}

static enum dig_status size_of(const struct blind_oracle *const   o,
                               const struct blind_campaign *const c, const size_t e,
                               const struct means *const alone, const struct means *const without,
                               double *const size)
{
    struct means    d;
    double          noise  = 0.0;
    double          least  = 0.0;
    struct means    base   = *without;
    enum dig_status status = difference(o, c, e, alone, without, &d, &noise);
    for (int p = 0; p < BLIND_PATHS && c->plain != NULL && status == DIG_OK; p++) {
        double scatter = 0.0;
        if (without->digs[p] == 0) {
            continue;
        }
        status = group_mean(o, c->plain, (enum blind_path)p, -1, &base.y[p], &scatter);
    }
    const struct point *const plain = status == DIG_OK ? nearest(o, &base, &least) : NULL;
    if (plain == NULL) {
        return status == DIG_OK ? DIG_ENOMATCH : status;
    }
    for (int p = 0; p < BLIND_PATHS; p++) {
        for (int k = 0; k < DIG_CURVE_POINTS; k++) {
            d.y[p].y[k] += plain->mean[p].y[k];
        }
    }
    (void)nearest(o, &d, &least);
    *size = sqrt(fmax(least - noise, 0.0) / floor_square(o, alone, plain));
    return DIG_OK;
}

// The held out digs, with the effect known: by formula what it did to that very dig, in the pool
// what it did to the other beds.
static enum dig_status known_error(const struct blind_oracle *const   o,
                                   const struct blind_campaign *const c,
                                   const struct means *const without, double *const error)
{
    double                    least   = 0.0;
    double                    wrong   = 0.0;
    double                    whole   = 0.0;
    const struct blind_curve  zero    = { { 0.0 } };
    const struct point *const gravel  = nearest(o, without, &least);
    const bool                in_pool = c->group->effect[0] != '\0';
    if (gravel == NULL) {
        return DIG_ENOMATCH;
    }
    bool ground = false;
    for (size_t e = 0; e < c->order.effects; e++) {
        ground = ground || c->order.effect[e].how == BLIND_BY_GROUND;
    }
    for (size_t d = 0; d < c->digs; d++) {
        const struct blind_dig *const dig = &c->dig[d];
        if (dig->role != 2) {
            continue;
        }
        struct blind_curve predicted = gravel->mean[dig->path];
        double             scatter   = 0.0;
        if (in_pool && !dig->plain_bed && c->group->beds > 2) {
            const enum dig_status status =
                group_mean(o, c->group, dig->path, (int)dig->bed, &predicted, &scatter);
            if (status != DIG_OK) {
                return status;
            }
        }
        wrong += apart(&o->weight[dig->path], &dig->without, &predicted);
        // A formula that scales a dig scales its scatter with it.
        whole += apart(&o->weight[dig->path], ground ? &dig->without : &dig->with, &zero);
    }
    *error = sqrt(wrong / whole);
    return DIG_OK;
}

enum dig_status blind_oracle_judge(const struct blind_oracle *const   oracle,
                                   const struct blind_campaign *const campaign,
                                   struct blind_truth *const          truth)
{
    struct means       without = { .digs = { 0 } };
    struct blind_truth t       = { .error = 0.0 };
    for (size_t d = 0; d < campaign->digs; d++) {
        if (campaign->dig[d].role != 2) {
            add(&without, campaign->dig[d].path, &campaign->dig[d].without);
        }
    }
    enum dig_status status = known_error(oracle, campaign, &without, &t.error);
    for (size_t e = 0; e < campaign->order.effects && status == DIG_OK; e++) {
        struct means alone = { .digs = { 0 } };
        double       air2  = 0.0;
        for (size_t d = 0; d < campaign->digs; d++) {
            const struct blind_dig *const dig = &campaign->dig[d];
            if (dig->role != 2) {
                add(&alone, dig->path, &dig->alone[e]);
                air2 += dig->air[e] * dig->air[e];
            }
        }
        t.size_air[e] = sqrt(air2);
        status        = size_of(oracle, campaign, e, &alone, &without, &t.size[e]);
    }
    if (status == DIG_OK) {
        *truth = t;
    }
    return status;
}

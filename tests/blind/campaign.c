#include "tests/blind/campaign.h"

#include "files/recording_csv.h"
#include "tests/blind/base.h"
#include "tests/blind/front.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define AIR_MARGIN_s 0.5 // around load and release, where smoothing mixes them

static const char *const role_name[] = { "identify", "fit", "holdout" };

// A random group with these digs; NULL when there is none.
static const struct blind_group *pick_group(const struct blind_pool *const pool,
                                            const char *const effect, const size_t beds,
                                            struct blind_draw *const draw)
{
    const struct blind_group *found = NULL;
    size_t                    seen  = 0;
    for (size_t g = 0; g < pool->groups; g++) {
        const struct blind_group *const group = &pool->group[g];
        if (strcmp(group->effect, effect) == 0 && group->beds >= beds) {
            seen++;
            found = blind_below(draw, seen) == 0 ? group : found;
        }
    }
    return found;
}

static bool has(const struct blind_order *const order, const enum blind_how how)
{
    bool is = false;
    for (size_t e = 0; e < order->effects; e++) {
        is = is || order->effect[e].how == how;
    }
    return is;
}

static bool has_rate(const struct blind_order *const order)
{
    bool is = false;
    for (size_t e = 0; e < order->effects; e++) {
        is = is || (order->effect[e].how == BLIND_BY_GROUND &&
                    order->effect[e].which == BLIND_RATE_DEPENDENCE);
    }
    return is;
}

// Which ground, which machine, which effects at which size.
static enum dig_status draw_subject(const struct blind_site *const  site,
                                    const struct blind_order *const order,
                                    struct blind_draw *const draw, struct blind_campaign *const c,
                                    struct dig_error *const error)
{
    const char *effect = "";
    for (size_t e = 0; e < order->effects; e++) {
        const struct blind_choice *const choice = &order->effect[e];
        switch (choice->how) {
        case BLIND_BY_POOL: effect = choice->name; break;
        case BLIND_BY_MACHINE:
            c->fault[e] =
                blind_fault_draw(draw, (enum blind_machine_effect)choice->which, order->strength);
            break;
        case BLIND_BY_GROUND:
        default:
            c->ground[e] =
                blind_ground_draw(draw, (enum blind_soil_effect)choice->which, order->strength);
            break;
        }
    }
    c->group = pick_group(site->pool, effect, effect[0] == '\0' ? 3 : 2, draw);
    if (c->group == NULL) {
        return dig_error_set(error, DIG_ENOMATCH, "the pool has no digs with \"%s\"", effect);
    }
    c->plain      = blind_pool_plain(site->pool, c->group);
    c->by_machine = has(order, BLIND_BY_MACHINE) ||
                    blind_uniform(draw) < (order->kind == BLIND_NONE ? 0.4 : 0.25);
    const size_t m = blind_uniform(draw) < 0.3 ? 1 : 0;
    c->machine     = site->machine[m];
    (void)snprintf(c->machine_path, sizeof c->machine_path, "%s", site->machine_path[m]);
    return DIG_OK;
}

// n beds along a path, in random order, those of the plain group first when it is about passes.
static void draw_path(struct blind_campaign *const c, const enum blind_path path, const size_t n,
                      struct blind_draw *const draw)
{
    size_t index[BLIND_BEDS_MAX];
    for (size_t b = 0; b < c->group->beds; b++) {
        index[b] = b;
    }
    blind_shuffle(draw, c->group->beds, index);
    const bool passes = strcmp(c->group->effect, "compaction") == 0 && c->plain != NULL;
    for (size_t i = 0; i < n; i++) {
        struct blind_dig *const dig = &c->dig[c->digs++];
        *dig =
            (struct blind_dig){ .bed = index[i], .path = path, .role = 1, .pass = 1, .pace = 1.0 };
        if (passes && i % 2 == 0 && index[i] < c->plain->beds) {
            dig->plain_bed = true;
        } else if (passes) {
            dig->pass = 1 + (unsigned)lround(fmax(c->group->magnitude, 1.0));
        }
    }
}

// In a third of the campaigns whose beds were dug along the other simple path too, every other
// simple dig goes along it, or each.
static void vary_path(struct blind_campaign *const c, const size_t simple,
                      struct blind_draw *const draw)
{
    const double which = blind_uniform(draw);
    const bool   can   = blind_group_has(c->group, BLIND_OTHER_SIMPLE) &&
                     (c->plain == NULL || blind_group_has(c->plain, BLIND_OTHER_SIMPLE));
    for (size_t i = 0; can && i < simple; i++) {
        if (which < 1.0 / 6.0 || (which < 1.0 / 3.0 && i % 2 == 1)) {
            c->dig[i].path = BLIND_OTHER_SIMPLE;
        }
    }
}

// Simple digs and real ones mixed, a simple one first that identifies, real ones last held out.
static void draw_digs(struct blind_campaign *const c, struct blind_draw *const draw)
{
    const size_t most   = c->group->beds < 5 ? c->group->beds : 5;
    const size_t simple = 2 + blind_below(draw, most - 1);
    const size_t actual = 2 + blind_below(draw, most - 1);
    draw_path(c, BLIND_SIMPLE, simple, draw);
    vary_path(c, simple, draw);
    draw_path(c, BLIND_ACTUAL, actual, draw);

    size_t           index[BLIND_DIGS_MAX];
    struct blind_dig as_drawn[BLIND_DIGS_MAX];
    memcpy(as_drawn, c->dig, sizeof as_drawn);
    for (size_t d = 0; d < c->digs; d++) {
        index[d] = d;
    }
    blind_shuffle(draw, c->digs - 1, index + 1);
    size_t       hold  = actual >= 4 ? 2 : 1;
    const double hurry = blind_between(draw, 1.4, 2.0);
    const bool   rates =
        has_rate(&c->order) || (c->order.kind == BLIND_NONE && blind_uniform(draw) < 0.15);
    size_t turn[BLIND_PATHS] = { 0 };
    for (size_t d = 0; d < c->digs; d++) {
        c->dig[d] = as_drawn[index[d]];
        if (rates && turn[c->dig[d].path]++ % 2 == 1) {
            c->dig[d].pace = hurry;
        }
    }
    c->dig[0].role = 0;
    for (size_t d = c->digs; d > 1 && hold > 0; d--) {
        if (c->dig[d - 1].path == BLIND_ACTUAL) {
            c->dig[d - 1].role = 2;
            hold--;
        }
    }
}

static enum dig_status copy_dig(const struct dig_recording *const from,
                                struct dig_recording *const       to)
{
    struct dig_force_row *const row = calloc(from->rows, sizeof *row);
    if (row == NULL) {
        return DIG_ENOMEM;
    }
    memcpy(row, from->row, from->rows * sizeof *row);
    *to = (struct dig_recording){ from->rows, row };
    return DIG_OK;
}

// Moment of each drive about its joint, as the machine's file has it, row by row.
static void moments(const struct dig_machine *const           machine,
                    const struct dig_machine_recording *const recording,
                    double (*const moment_Nm)[DIG_JOINTS])
{
    for (size_t i = 0; i < recording->rows; i++) {
        const double *const v = recording->row[i].value;
        for (int j = 0; j < DIG_JOINTS; j++) {
            const double push =
                blind_push_N(&machine->cylinder[j], v[DIG_SIGNAL_BOOM_HEAD_Pa + 2 * j],
                             v[DIG_SIGNAL_BOOM_ROD_Pa + 2 * j]);
            moment_Nm[i][j] =
                push * blind_lever_m(machine, (enum dig_joint)j, &v[DIG_SIGNAL_BOOM_rad]);
        }
    }
}

// 1 sigma of a joint's moment by its pressure sensors and their steps, one sample.
static double sigma_Nm(const struct dig_machine *const machine, const int j,
                       const double angle_rad[DIG_JOINTS])
{
    const struct dig_cylinder *const c = &machine->cylinder[j];
    const double one_Pa = hypot(c->pressure_sigma_Pa, machine->pressure_step_Pa / sqrt(12.0));
    const double head_N = blind_push_N(c, one_Pa, 0.0);
    const double rod_N  = blind_push_N(c, 0.0, one_Pa);
    return hypot(head_N, rod_N) * fabs(blind_lever_m(machine, (enum dig_joint)j, angle_rad));
}

// Rms of a joint's added moment in free air, over what its sensors make of it.
static double air_share(const struct blind_campaign *const c, const struct blind_base *const base,
                        const int j, const double t_s[], const double smooth[])
{
    const double smooth_s = 2.0 * DIG_SMOOTH_HALF_s * sqrt(c->lambda);
    const double few      = sqrt(fmin(base->step_s / smooth_s, 1.0));
    double       sum      = 0.0;
    size_t       count    = 0;
    for (size_t i = 0; i < base->recording.rows; i++) {
        if (t_s[i] < base->contact_s - AIR_MARGIN_s || t_s[i] > base->released_s + AIR_MARGIN_s) {
            const double *const q = &base->recording.row[i].value[DIG_SIGNAL_BOOM_rad];
            sum += pow(smooth[i] / (few * sigma_Nm(&c->machine, j, q)), 2.0);
            count++;
        }
    }
    return count == 0 ? 0.0 : sqrt(sum / (double)count);
}

// What faults add: to the dig's moment at rig scale (into *curve), and in free air.
static enum dig_status weigh(const struct blind_site *const     site,
                             const struct blind_campaign *const c,
                             const struct blind_base *const base, const struct blind_dig *const dig,
                             double (*const was_Nm)[DIG_JOINTS], double (*const is_Nm)[DIG_JOINTS],
                             struct blind_curve *const curve, double *const air)
{
    const size_t  n     = base->recording.rows;
    const double  slow  = sqrt(c->lambda);
    const size_t  begin = (size_t)fmax(base->begin_s / base->step_s, 0.0);
    double *const t_s   = calloc(3 * n, sizeof *t_s);
    if (t_s == NULL) {
        return DIG_ENOMEM;
    }
    double *const   delta  = t_s + n;
    double *const   smooth = t_s + 2 * n;
    enum dig_status status = DIG_OK;
    *air                   = 0.0;
    for (int j = 0; j < DIG_JOINTS && status == DIG_OK; j++) {
        for (size_t i = 0; i < n; i++) {
            t_s[i]   = (double)i * base->step_s;
            delta[i] = is_Nm[i][j] - was_Nm[i][j];
        }
        dig_curve_smooth(n, t_s, delta, DIG_SMOOTH_HALF_s * slow, smooth);
        *air = fmax(*air, air_share(c, base, j, t_s, smooth));
        if (j == DIG_JOINT_BUCKET) {
            struct blind_curve add;
            status = blind_curve_of_samples(site->trajectory[dig->path], site->tooth_m, dig->pace,
                                            base->step_s / slow, n - begin, delta + begin, &add);
            // The cylinder's moment on the bucket is against the soil's; machine axes are the
            // rig's mirrored twice.
            for (int k = 0; k < DIG_CURVE_POINTS && status == DIG_OK; k++) {
                curve->y[k] -= add.y[k] / pow(c->lambda, 4.0);
            }
        }
    }
    free(t_s);
    return status;
}

static enum dig_status copy_recording(const struct dig_machine_recording *const from,
                                      struct dig_machine_recording *const       to)
{
    struct dig_sample *const row = calloc(from->rows, sizeof *row);
    if (row == NULL) {
        return DIG_ENOMEM;
    }
    memcpy(row, from->row, from->rows * sizeof *row);
    *to = (struct dig_machine_recording){ from->rows, row };
    return DIG_OK;
}

// Puts in the faults from first to last, weighs them, and leaves the recording in *base.
static enum dig_status inject_some(const struct blind_site *const site,
                                   struct blind_campaign *const c, const size_t d,
                                   const double start_s, const size_t first, const size_t last,
                                   struct blind_base *const base, struct blind_curve *const curve,
                                   double *const air)
{
    const size_t n                       = base->recording.rows;
    double(*const moment_Nm)[DIG_JOINTS] = calloc(2 * n, sizeof *moment_Nm);
    if (moment_Nm == NULL) {
        return DIG_ENOMEM;
    }
    const struct blind_place place  = { .order      = d,
                                        .start_s    = start_s,
                                        .contact_s  = base->contact_s,
                                        .released_s = base->released_s,
                                        .lambda     = c->lambda };
    enum dig_status          status = DIG_OK;
    moments(&c->machine, &base->recording, moment_Nm);
    for (size_t e = first; e < last && status == DIG_OK; e++) {
        if (c->order.effect[e].how == BLIND_BY_MACHINE) {
            status = blind_inject(&c->machine, &c->fault[e], &place, &base->recording);
        }
    }
    if (status == DIG_OK) {
        moments(&c->machine, &base->recording, moment_Nm + n);
        status = weigh(site, c, base, &c->dig[d], moment_Nm, moment_Nm + n, curve, air);
    }
    free(moment_Nm);
    return status;
}

static enum dig_status inject_all(const struct blind_site *const site,
                                  struct blind_campaign *const c, const size_t d,
                                  const double start_s, struct blind_base *const base)
{
    struct blind_dig *const dig    = &c->dig[d];
    enum dig_status         status = DIG_OK;
    double                  air    = 0.0;
    for (size_t e = 0; e < c->order.effects && status == DIG_OK; e++) {
        struct blind_base copy = *base;
        if (c->order.effect[e].how != BLIND_BY_MACHINE) {
            continue;
        }
        status = copy_recording(&base->recording, &copy.recording);
        if (status == DIG_OK) {
            status =
                inject_some(site, c, d, start_s, e, e + 1, &copy, &dig->alone[e], &dig->air[e]);
            blind_base_finish(&copy);
        }
    }
    if (status == DIG_OK && has(&c->order, BLIND_BY_MACHINE)) {
        status = inject_some(site, c, d, start_s, 0, c->order.effects, base, &dig->with, &air);
    }
    return status;
}

// The dig as the machine records it; the force recording lies at path.
static enum dig_status write_machine(const struct blind_site *const site,
                                     struct blind_campaign *const c, const size_t d,
                                     const bool plain_dig, const char *const path,
                                     const struct dig_recording *const dig, double *const start_s,
                                     struct blind_draw *const draw, struct dig_error *const error)
{
    char name[256];
    char folder[600];
    (void)snprintf(folder, sizeof folder, "%s", path);
    *strrchr(folder, '/') = '\0';
    if (plain_dig) {
        const struct dig_gravel *const g = &c->group->gravel;
        (void)snprintf(name, sizeof name, "%s_%s%g_%g_%g_%g_bed%u_%s_%s", c->group->source,
                       c->dig[d].plain_bed ? "" : c->group->effect,
                       c->dig[d].plain_bed ? 0.0 : c->group->magnitude, g->value[0], g->value[1],
                       g->value[2],
                       (c->dig[d].plain_bed ? c->plain : c->group)->bed[c->dig[d].bed].packing,
                       blind_path_name(c->dig[d].path), c->machine.name);
    } else {
        (void)snprintf(name, sizeof name, "exact%zu_%s", d,
                       c->machine.name); // it may be tried by two
    }
    struct blind_base base;
    enum dig_status   status =
        blind_base_make(site->digrig, c->machine_path, path, plain_dig ? site->cache : folder, name,
                        c->lambda, dig, &base, error);
    if (status != DIG_OK) {
        return status;
    }
    status = inject_all(site, c, d, *start_s, &base);
    if (status == DIG_OK) {
        *start_s += base.step_s * (double)base.recording.rows + 15.0;
        blind_sense(&c->machine, draw, &base.recording);
        status = dig_machine_recording_write(path, &base.recording, error);
    }
    blind_base_finish(&base);
    return status;
}

// The dig with one effect of the ground and no other.
static enum dig_status till_alone(const struct blind_site *const site,
                                  struct blind_campaign *const c, const size_t d, const size_t e,
                                  const struct dig_recording *const r)
{
    struct blind_dig *const dig    = &c->dig[d];
    struct dig_recording    copy   = { 0, NULL };
    enum dig_status         status = copy_dig(r, &copy);
    if (status == DIG_OK) {
        blind_ground_apply(&c->ground[e], d, &copy);
        status = blind_curve_of(site->trajectory[dig->path], site->tooth_m, dig->pace, &copy,
                                &dig->alone[e]);
    }
    dig_recording_finish(&copy);
    return status;
}

static enum dig_status write_dig(const struct blind_site *const site,
                                 struct blind_campaign *const c, const size_t d,
                                 const char *const folder, double *const start_s,
                                 struct blind_draw *const draw, struct dig_error *const error)
{
    struct blind_dig *const            dig   = &c->dig[d];
    const struct blind_group *const    group = dig->plain_bed ? c->plain : c->group;
    const struct dig_trajectory *const t     = site->trajectory[dig->path];
    struct dig_recording               r     = { 0, NULL };
    bool                               plain = dig->pace < 1.001;
    char                               path[600];
    enum dig_status                    status = copy_dig(&group->bed[dig->bed].dig[dig->path], &r);
    if (status != DIG_OK) {
        return status;
    }
    (void)snprintf(path, sizeof path, "%s/dig%zu.csv", folder, d + 1);
    blind_hurry(dig->pace, &r);
    status = blind_curve_of(t, site->tooth_m, dig->pace, &r, &dig->without);
    for (size_t e = 0; e < c->order.effects && status == DIG_OK; e++) {
        dig->alone[e] = dig->without;
        if (c->order.effect[e].how == BLIND_BY_GROUND) {
            status = till_alone(site, c, d, e, &r);
            plain  = false;
        }
    }
    for (size_t e = 0; e < c->order.effects; e++) {
        if (c->order.effect[e].how == BLIND_BY_GROUND) {
            blind_ground_apply(&c->ground[e], d, &r);
        }
    }
    if (status == DIG_OK) {
        status = blind_curve_of(t, site->tooth_m, dig->pace, &r, &dig->with);
    }
    if (status == DIG_OK) {
        status = dig_recording_write(path, &r, error);
    }
    if (status == DIG_OK && c->by_machine) {
        status = write_machine(site, c, d, plain, path, &r, start_s, draw, error);
    }
    dig_recording_finish(&r);
    return status;
}

static enum dig_status write_yaml(const struct blind_site *const     site,
                                  const struct blind_campaign *const c, const char *const folder,
                                  struct dig_error *const error)
{
    char path[600];
    (void)snprintf(path, sizeof path, "%s/campaign.yaml", folder);
    FILE *const file = fopen(path, "w");
    if (file == NULL) {
        return dig_error_set(error, DIG_EIO, "%s: cannot be written", path);
    }
    (void)fprintf(file, "scene: %s\n", site->scene);
    if (c->by_machine) {
        (void)fprintf(file, "machine: %s\n", c->machine_path);
    }
    (void)fputs("recordings:\n", file);
    for (size_t d = 0; d < c->digs; d++) {
        const struct blind_dig *const dig = &c->dig[d];
        (void)fprintf(file, "  - {file: dig%zu.csv, trajectory: %s, role: %s", d + 1,
                      blind_path_name(dig->path), role_name[dig->role]);
        (void)fprintf(file, dig->pass > 1 ? ", pass: %u}\n" : "}\n", dig->pass);
    }
    return fclose(file) == 0 ? DIG_OK : dig_error_set(error, DIG_EIO, "%s: disk", path);
}

static enum dig_status write_all(const struct blind_site *const site,
                                 struct blind_campaign *const c, const char *const folder,
                                 struct blind_draw *const draw, struct dig_error *const error)
{
    double          start_s = 0.0;
    enum dig_status status  = DIG_OK;
    c->lambda               = c->machine.link[DIG_JOINT_BUCKET].length_m / site->tooth_m;
    for (size_t d = 0; d < c->digs && status == DIG_OK; d++) {
        status = write_dig(site, c, d, folder, &start_s, draw, error);
    }
    return status;
}

enum dig_status blind_campaign_make(const struct blind_site *const  site,
                                    const struct blind_order *const order, const char *const folder,
                                    struct blind_campaign *const campaign,
                                    struct dig_error *const      error)
{
    struct blind_draw      draw   = blind_draw_init(order->seed, order->number);
    struct blind_campaign *c      = calloc(1, sizeof *c);
    enum dig_status        status = DIG_ENOMEM;
    if (c == NULL) {
        return dig_error_set(error, status, "out of memory");
    }
    c->order = *order;
    status   = draw_subject(site, order, &draw, c, error);
    if (status == DIG_OK) {
        draw_digs(c, &draw);
        status = write_all(site, c, folder, &draw, error);
    }
    if (status == DIG_EUNREACHABLE) {
        // The first machine can do every dig there is.
        c->machine = site->machine[0];
        (void)snprintf(c->machine_path, sizeof c->machine_path, "%s", site->machine_path[0]);
        status = write_all(site, c, folder, &draw, error);
    }
    if (status == DIG_EUNREACHABLE && !has(order, BLIND_BY_MACHINE)) {
        c->by_machine = false; // nobody can dig this but the rig
        status        = write_all(site, c, folder, &draw, error);
    }
    if (status == DIG_OK) {
        status = write_yaml(site, c, folder, error);
    }
    if (status == DIG_OK) {
        *campaign = *c;
    }
    free(c);
    return status;
}

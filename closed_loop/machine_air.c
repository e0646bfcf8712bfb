#include "closed_loop/machine_air.h"

#include "estimator/balance.h"
#include "estimator/dynamics.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

// The kernel's half is the rates'.
static const double half_s = 0.12;

// Points are so far apart, and this many make a block; so many more stand beside the air, where a
// delay may look for angles; the kernel reaches over so many.
static const double step_s = 0.025;
enum { POINTS_IN_BLOCK = 8, POINTS_BESIDE = 20, KERNEL = 4 };

// A rod this fast moves: friction is all there, against it.
static const double moves_mps = 5.0 * DIG_FRICTION_STILL_mps;

// Readings that are averaged: what a balance needs, and pitch and temperature.
enum { AVERAGED = DIG_SIGNAL_TEMPERATURE_degC + 1 };

// Kernel means of the readings around one time; the time that these are of, which is another where
// readings are missing. What a balance needs is told where every reading of it is.
static double average(const struct dig_machine_dig *const dig, const double time_s,
                      size_t *const from, struct dig_sample *const out)
{
    while (*from + 1 < dig->samples && dig->time_s[*from] < time_s - half_s) {
        ++*from;
    }
    double sum[AVERAGED]    = { 0.0 };
    double weight[AVERAGED] = { 0.0 };
    double all              = 0.0;
    double later_s          = 0.0;
    for (size_t i = *from; i < dig->samples && dig->time_s[i] < time_s + half_s; i++) {
        const struct dig_sample *const sample = &dig->sample[i];

        const double u = (dig->time_s[i] - time_s) / half_s;
        const double w = (1.0 - u * u) * (1.0 - u * u);
        all += w;
        later_s += w * (dig->time_s[i] - time_s);
        for (int s = 0; s < AVERAGED; s++) {
            sum[s] += sample->valid[s] ? w * sample->value[s] : 0.0;
            weight[s] += sample->valid[s] ? w : 0.0;
        }
    }
    for (int s = 0; s < AVERAGED; s++) {
        const double least = s < DIG_SIGNALS_NEEDED ? (1.0 - 1e-9) * all : 0.0;

        out->valid[s] = weight[s] > 0.0 && weight[s] >= least;
        out->value[s] = out->valid[s] ? sum[s] / weight[s] : 0.0;
    }
    return all > 0.0 ? time_s + later_s / all : time_s;
}

// What one reading of a chamber scatters by, from how samples differ from the mean of both beside
// them; never less than the file says.
static double scatter_Pa(const struct dig_machine *const     machine,
                         const struct dig_machine_dig *const dig, const int chamber)
{
    double sum = 0.0;
    for (size_t i = 1; i + 1 < dig->samples; i++) {
        const size_t s   = (size_t)DIG_SIGNAL_BOOM_HEAD_Pa + (size_t)chamber;
        const double off = dig->sample[i].value[s] -
                           0.5 * (dig->sample[i - 1].value[s] + dig->sample[i + 1].value[s]);
        sum += fmin(off * off, 1e14);
    }
    const double seen  = sqrt(sum / 1.5 / (double)(dig->samples - 2));
    const double filed = dig_reading_sigma(machine->pressure_step_Pa,
                                           machine->cylinder[chamber / 2].pressure_sigma_Pa);
    return fmax(seen, filed);
}

// Both, by chamber and by drive.
struct scatter {
    double Pa[DIG_JOINTS * DIG_CHAMBERS];
    double N[DIG_JOINTS];
};

static struct scatter scatter_of(const struct dig_machine *const     machine,
                                 const struct dig_machine_dig *const dig)
{
    struct scatter s;
    for (int j = 0; j < DIG_JOINTS; j++) {
        const struct dig_cylinder *const cylinder = &machine->cylinder[j];
        double *const                    Pa       = &s.Pa[(size_t)DIG_CHAMBERS * (size_t)j];

        Pa[DIG_CHAMBER_HEAD] = scatter_Pa(machine, dig, DIG_CHAMBERS * j + DIG_CHAMBER_HEAD);
        Pa[DIG_CHAMBER_ROD]  = scatter_Pa(machine, dig, DIG_CHAMBERS * j + DIG_CHAMBER_ROD);
        s.N[j] = cylinder->count * hypot(dig_cylinder_head_m2(cylinder) * Pa[DIG_CHAMBER_HEAD],
                                         dig_cylinder_rod_m2(cylinder) * Pa[DIG_CHAMBER_ROD]);
    }
    return s;
}

static void fill_means(struct dig_air_segment *const segment, const struct dig_air_point point[],
                       const size_t points)
{
    for (size_t p = 0; p < points; p++) {
        for (size_t c = 0; c < (size_t)DIG_JOINTS * DIG_CHAMBERS; c++) {
            segment->mean_Pa[c] +=
                point[p].sample.value[(size_t)DIG_SIGNAL_BOOM_HEAD_Pa + c] / (double)points;
        }
    }
}

// Sigma of a block of one joint, or not positive where the joint cannot be told.
static double block_sigma_N(const struct dig_machine *const machine,
                            const struct dig_air_point point[], const size_t points,
                            const int joint, const double push_N, const double per_point)
{
    static const struct dig_correction none = { .delay_s = 0.0 };
    double                             slow = 0.0;
    double                             turn = 0.0;
    for (size_t p = 0; p < points; p++) {
        struct dig_readings readings;
        if (dig_readings_take(machine, &none, &point[p].sample, &point[p].rates, &readings) !=
            DIG_OK) {
            return 0.0;
        }
        const struct dig_front   front   = dig_front_place(machine, readings.joint_rad);
        const struct dig_balance balance = dig_balance_solve(machine, &readings, &front);
        const struct dig_lever  *lever   = &balance.lever[joint];
        if (!balance.lever_ok[joint] || !readings.push[joint].valid ||
            !dig_cylinder_is_clear(&machine->cylinder[joint], lever->length_m)) {
            return 0.0;
        }
        double inertia_kgm2[DIG_JOINTS][DIG_JOINTS];
        dig_dynamics_inertia_kgm2(machine, &front, inertia_kgm2);
        slow = readings.push[joint].slow_N;
        for (int k = 0; k < DIG_JOINTS; k++) {
            turn += pow(inertia_kgm2[joint][k] / lever->arm_m, 2.0) / (double)points;
        }
    }
    // A block's mean acceleration is the difference of two speeds.
    const double turn_radps2 =
        fmin(point[0].rates.acceleration_sigma,
             sqrt(2.0) * point[0].rates.velocity_sigma / (step_s * (double)points));
    const double white_N = push_N / sqrt(per_point * (double)points);
    return hypot(hypot(white_N, slow), sqrt(turn) * turn_radps2);
}

static void add_rows(struct dig_air *const air, const size_t first, const size_t points,
                     const size_t segment, const double sigma_N[DIG_JOINTS], const double per_point)
{
    for (int j = 0; j < DIG_JOINTS; j++) {
        const double sigma =
            block_sigma_N(&air->machine, &air->point[first], points, j, sigma_N[j], per_point);
        if (sigma > 0.0) {
            air->row[air->rows++] =
                (struct dig_air_row){ segment, (enum dig_joint)j, first, points, sigma };
        }
    }
}

// The rates so far of the way from a to b.
static struct dig_rates rates_between(const struct dig_rates *const a,
                                      const struct dig_rates *const b, const double f)
{
    struct dig_rates out = *a;
    for (int j = 0; j < DIG_JOINTS; j++) {
        out.velocity_radps[j] += f * (b->velocity_radps[j] - a->velocity_radps[j]);
        out.acceleration_radps2[j] += f * (b->acceleration_radps2[j] - a->acceleration_radps2[j]);
    }
    return out;
}

// The rates at a time, straight between the samples beside it: those of the sample before would be
// half a sample old on average, which at 50 Hz looks like a delay of 10 ms.
static struct dig_rates rates_at(const struct dig_machine_dig *const dig, const double time_s,
                                 const size_t from)
{
    size_t i = from + 1 < dig->samples ? from : dig->samples - 2;
    while (i + 2 < dig->samples && dig->time_s[i + 1] <= time_s) {
        i++;
    }
    const double f = (time_s - dig->time_s[i]) / (dig->time_s[i + 1] - dig->time_s[i]);
    return rates_between(&dig->rates[i], &dig->rates[i + 1], fmin(fmax(f, 0.0), 1.0));
}

static void add_point(struct dig_air *const air, const struct dig_machine_dig *const dig,
                      const double time_s, size_t *const near)
{
    struct dig_air_point *const point = &air->point[air->points++];
    *point                            = (struct dig_air_point){ .sample = { .time_ns = 0 } };
    const double mean_s               = average(dig, time_s, near, &point->sample);
    point->sample.time_ns             = llround(1e9 * mean_s);
    point->rates                      = rates_at(dig, mean_s, *near);
}

static void add_segment(struct dig_air *const air, const struct dig_machine_dig *const dig,
                        const size_t which, const bool after)
{
    const size_t from = after ? dig->after : 0;
    const size_t to   = after ? dig->samples : dig->before_end;
    if (to < from + 2) {
        return;
    }
    const struct scatter scatter = scatter_of(&air->machine, dig);
    const double         begin_s = dig->time_s[from] + half_s;
    const double         end_s   = dig->time_s[to - 1] - half_s;
    const double         last_s  = dig->time_s[dig->samples - 1];
    const double         rate_Hz = (double)(to - from) / (dig->time_s[to - 1] - dig->time_s[from]);

    // Points from beside the air to beside it, as far as there is a recording.
    const long   before = lround(floor(fmin(POINTS_BESIDE, begin_s / step_s)));
    const size_t first  = air->points;
    size_t       core   = 0;
    size_t       near   = 0;
    for (long k = -before;; k++) {
        const double time_s = begin_s + step_s * (double)k;
        if (time_s > fmin(end_s + POINTS_BESIDE * step_s, last_s)) {
            break;
        }
        core += k >= 0 && time_s <= end_s ? 1 : 0;
        add_point(air, dig, time_s, &near);
    }
    const size_t begin    = first + (size_t)before;
    const size_t segment  = air->segments++;
    air->segment[segment] = (struct dig_air_segment){ .dig         = which,
                                                      .after       = after,
                                                      .first_point = first,
                                                      .points      = air->points - first,
                                                      .first_row   = air->rows };
    fill_means(&air->segment[segment], &air->point[begin], core);
    for (size_t p = 0; p + POINTS_IN_BLOCK <= core; p += POINTS_IN_BLOCK) {
        add_rows(air, begin + p, POINTS_IN_BLOCK, segment, scatter.N, fmax(rate_Hz * step_s, 1e-3));
    }
    air->segment[segment].rows = air->rows - air->segment[segment].first_row;
}

enum dig_status dig_air_make(const struct dig_machine *const machine, const size_t digs,
                             const struct dig_machine_dig dig[], const bool used[],
                             struct dig_air *const air)
{
    assert(machine != NULL && air != NULL);
    size_t points = 1;
    for (size_t d = 0; d < digs; d++) {
        points += 4 * (size_t)POINTS_BESIDE + (size_t)(dig[d].time_s[dig[d].samples - 1] / step_s);
    }
    struct dig_air made = {
        .machine = *machine,
        .point   = malloc(points * sizeof *made.point),
        .row     = malloc(DIG_JOINTS * points * sizeof *made.row),
        .segment = malloc((2 * digs + 1) * sizeof *made.segment),
        .scratch = malloc((size_t)(3 * DIG_JOINTS) * points * sizeof *made.scratch),
    };
    if (made.point == NULL || made.row == NULL || made.segment == NULL || made.scratch == NULL) {
        dig_air_finish(&made);
        return DIG_ENOMEM;
    }
    for (size_t d = 0; d < digs; d++) {
        if (used[d]) {
            add_segment(&made, &dig[d], d, false);
            add_segment(&made, &dig[d], d, true);
        }
    }
    *air = made;
    return DIG_OK;
}

void dig_air_finish(struct dig_air *const air)
{
    if (air != NULL) {
        free(air->point);
        free(air->row);
        free(air->segment);
        free(air->scratch);
        *air = (struct dig_air){ .points = 0 };
    }
}

// A point with the angles and rates that the machine had delay_s before.
static struct dig_air_point delayed(const struct dig_air_point point[], const size_t points,
                                    const size_t at, const double delay_s)
{
    if (!(fabs(delay_s) > 0.0)) {
        return point[at];
    }
    const double back = fmin(fmax((double)at - delay_s / step_s, 0.0), (double)(points - 1));
    const size_t low  = (size_t)back;
    const size_t high = low + 1 < points ? low + 1 : low;
    const double f    = back - (double)low;
    struct dig_air_point        out = point[at];
    const struct dig_air_point *a   = &point[low];
    const struct dig_air_point *b   = &point[high];
    for (size_t j = 0; j < DIG_JOINTS; j++) {
        const size_t q = (size_t)DIG_SIGNAL_BOOM_rad + j;

        out.sample.value[q] = (1.0 - f) * a->sample.value[q] + f * b->sample.value[q];
    }
    out.rates = rates_between(&a->rates, &b->rates, f);
    return out;
}

// What friction may take more than the loss at a speed, either way: a rod that stands may still be
// held by all that it rubbed with when it last moved, or by less.
static double held_N(const struct dig_friction *const friction, const double push_N,
                     const double rod_mps, const double loss_N)
{
    if (!(fabs(rod_mps) < moves_mps)) {
        return 0.0;
    }
    return fabs(dig_friction_loss_N(friction, push_N, copysign(moves_mps, rod_mps)) - loss_N);
}

// What is left of the joints at one point, N at the rods, what friction takes of it, and what it
// may take more.
static void rest_at(const struct dig_machine *const    corrected,
                    const struct dig_correction *const correction,
                    struct dig_air_point *const point, const bool calm, double rest_N[DIG_JOINTS],
                    double loss_N[DIG_JOINTS], double more_N[DIG_JOINTS])
{
    struct dig_correction rigid = *correction;
    for (int j = 0; j < DIG_JOINTS; j++) {
        rigid.friction[j] = (struct dig_friction){ .coulomb_N = 0.0 };
    }
    for (size_t c = 0; calm && c < (size_t)DIG_JOINTS * DIG_CHAMBERS; c++) {
        point->sample.value[(size_t)DIG_SIGNAL_BOOM_HEAD_Pa + c] = point->calm_Pa[c];
    }
    struct dig_readings readings;
    const bool          read =
        dig_readings_take(corrected, &rigid, &point->sample, &point->rates, &readings) == DIG_OK;
    const struct dig_front   front   = read ? dig_front_place(corrected, readings.joint_rad)
                                            : (struct dig_front){ .attitude_rad = { 0.0 } };
    const struct dig_balance balance = read ? dig_balance_solve(corrected, &readings, &front)
                                            : (struct dig_balance){ .moment_ok = false };
    for (int j = 0; j < DIG_JOINTS; j++) {
        rest_N[j] = 0.0;
        loss_N[j] = 0.0;
        more_N[j] = 0.0;
        if (balance.lever_ok[j]) {
            const struct dig_friction *const friction = &correction->friction[j];

            const double arm_m   = balance.lever[j].arm_m;
            const double push_N  = readings.push[j].push_N;
            const double rod_mps = arm_m * point->rates.velocity_radps[j];
            rest_N[j]            = balance.rest_Nm[j] / arm_m;
            loss_N[j]            = dig_friction_loss_N(friction, push_N, rod_mps);
            more_N[j]            = held_N(friction, push_N, rod_mps, loss_N[j]);
        }
    }
}

// Friction turns about at once where a motion does; averaged over the kernel as all else is.
static double smooth_at(const double (*const loss_N)[DIG_JOINTS], const size_t points,
                        const size_t at, const size_t joint)
{
    double sum    = 0.0;
    double weight = 0.0;
    for (int k = -KERNEL; k <= KERNEL; k++) {
        const double u = (double)k * step_s / half_s;
        const double w = (1.0 - u * u) * (1.0 - u * u);
        const size_t i = at + (size_t)KERNEL + (size_t)(k + KERNEL);
        if (i >= 2 * (size_t)KERNEL && i - 2 * (size_t)KERNEL < points) {
            sum += w * loss_N[i - 2 * (size_t)KERNEL][joint];
            weight += w;
        }
    }
    return sum / weight;
}

// All of every point of a segment into the scratch: rests, losses, what may be lost more.
static void rest_of(const struct dig_air *const air, const size_t s,
                    const struct dig_correction *const correction, const bool calm)
{
    double(*const rest_N)[DIG_JOINTS]           = (double(*)[DIG_JOINTS])(void *)air->scratch;
    const struct dig_air_segment *const segment = &air->segment[s];
    const struct dig_air_point *const   point   = &air->point[segment->first_point];
    double(*const loss_N)[DIG_JOINTS]           = rest_N + segment->points;
    double(*const more_N)[DIG_JOINTS]           = loss_N + segment->points;
    const struct dig_machine corrected          = dig_correction_machine(&air->machine, correction);
    for (size_t p = 0; p < segment->points; p++) {
        struct dig_air_point at = delayed(point, segment->points, p, correction->delay_s);
        rest_at(&corrected, correction, &at, calm, rest_N[p], loss_N[p], more_N[p]);
    }
}

static double rest_of_point_N(const struct dig_air *const air, const size_t s, const size_t point,
                              const size_t joint)
{
    const double(*const rest_N)[DIG_JOINTS] = (const double(*)[DIG_JOINTS])(void *)air->scratch;
    const size_t points                     = air->segment[s].points;
    return rest_N[point][joint] - smooth_at(rest_N + points, points, point, joint);
}

void dig_air_calm(struct dig_air *const air, const struct dig_correction correction[])
{
    assert(air != NULL && correction != NULL);
    for (size_t s = 0; s < air->segments; s++) {
        const struct dig_air_segment *const segment = &air->segment[s];
        struct dig_air_point *const         point   = &air->point[segment->first_point];
        for (size_t p = 0; p < segment->points; p++) {
            for (size_t c = 0; c < (size_t)DIG_JOINTS * DIG_CHAMBERS; c++) {
                const bool returns  = segment->mean_Pa[c] < segment->mean_Pa[c ^ 1U];
                point[p].calm_Pa[c] = returns ? segment->mean_Pa[c]
                                              : point[p].sample.value[DIG_SIGNAL_BOOM_HEAD_Pa + c];
            }
        }
        rest_of(air, s, &correction[s], true);
        for (size_t j = 0; j < DIG_JOINTS; j++) {
            const struct dig_cylinder *const cylinder = &air->machine.cylinder[j];

            const double *const mean_Pa = &segment->mean_Pa[DIG_CHAMBERS * j];
            const bool          head    = !(mean_Pa[DIG_CHAMBER_HEAD] < mean_Pa[DIG_CHAMBER_ROD]);
            const size_t        c = DIG_CHAMBERS * j + (head ? DIG_CHAMBER_HEAD : DIG_CHAMBER_ROD);
            const double        m2 =
                head ? dig_cylinder_head_m2(cylinder) : -dig_cylinder_rod_m2(cylinder);
            for (size_t p = 0; p < segment->points; p++) {
                point[p].calm_Pa[c] -= rest_of_point_N(air, s, p, j) / (cylinder->count * m2);
            }
        }
    }
}

void dig_air_rest(const struct dig_air *const air, const struct dig_correction correction[],
                  const bool calm, double rest[])
{
    assert(air != NULL && correction != NULL && rest != NULL);
    for (size_t s = 0; s < air->segments; s++) {
        const struct dig_air_segment *const segment = &air->segment[s];
        rest_of(air, s, &correction[s], calm);
        for (size_t r = segment->first_row; r < segment->first_row + segment->rows; r++) {
            const struct dig_air_row *const row   = &air->row[r];
            const size_t                    first = row->first - segment->first_point;
            double                          sum_N = 0.0;
            for (size_t p = first; p < first + row->points; p++) {
                sum_N += rest_of_point_N(air, s, p, row->joint);
            }
            rest[r] = sum_N / (double)row->points / row->sigma_N;
        }
    }
}

void dig_air_held(const struct dig_air *const air, const struct dig_correction correction[],
                  double held[])
{
    assert(air != NULL && correction != NULL && held != NULL);
    for (size_t s = 0; s < air->segments; s++) {
        const struct dig_air_segment *const segment = &air->segment[s];
        const double(*const more_N)[DIG_JOINTS] =
            (const double(*)[DIG_JOINTS])(void *)air->scratch + 2 * segment->points;
        rest_of(air, s, &correction[s], false);
        for (size_t r = segment->first_row; r < segment->first_row + segment->rows; r++) {
            const struct dig_air_row *const row   = &air->row[r];
            const size_t                    first = row->first - segment->first_point;
            double                          sum_N = 0.0;
            for (size_t p = first; p < first + row->points; p++) {
                sum_N += smooth_at(more_N, segment->points, p, row->joint);
            }
            held[r] = sum_N / (double)row->points / row->sigma_N;
        }
    }
}

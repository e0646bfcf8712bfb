#include "closed_loop/check/drive_misfit.h"

#include "core/linkage.h"
#include "estimator/wrench/correction.h"
#include "estimator/wrench/cylinder.h"
#include "estimator/wrench/dynamics.h"
#include "estimator/wrench/statics.h"

#include <assert.h>
#include <math.h>

// What may be left of a load without anything being mixed up, and noise of averaged readings.
static const double allowed_share = 0.07;
static const double noise_share   = 0.03;

// Taken off before: 1 sigma of an offset and of a factor of the load, and how far that goes.
static const double offset_Pa  = 2e6;
static const double load_share = 0.25;
static const double most_share = 0.5;

static const double beyond_rad = 3.0 * DIG_RAD_PER_DEG; // of a joint's range

void dig_drive_loads(const struct dig_machine *const machine,
                     const struct dig_reading *const reading, const size_t n,
                     const struct dig_air_point at[], struct dig_drive_load load[])
{
    assert(machine != NULL && reading != NULL && at != NULL && load != NULL);
    for (size_t k = 0; k < n; k++) {
        struct dig_rates rates = at[k].rates;
        double           rad[DIG_JOINTS];
        double           mass_Nm[DIG_JOINTS];
        for (int j = 0; j < DIG_JOINTS; j++) {
            const double sign = reading->turned[j] ? -1.0 : 1.0;
            rad[j] = sign * at[k].sample.value[DIG_SIGNAL_BOOM_rad + j] - reading->zero_rad[j];
            rates.velocity_radps[j] *= sign;
            rates.acceleration_radps2[j] *= sign;
        }
        const struct dig_front front     = dig_front_place(machine, rad);
        const bool             pitched   = at[k].sample.valid[DIG_SIGNAL_PITCH_rad];
        const double           pitch_rad = pitched ? at[k].sample.value[DIG_SIGNAL_PITCH_rad] : 0.0;
        dig_dynamics_Nm(machine, &front, &rates, pitch_rad, mass_Nm);
        for (size_t j = 0; j < DIG_JOINTS; j++) {
            const struct dig_link *const link = &machine->link[j];
            struct dig_lever             lever;
            const bool                   stands =
                rad[j] > link->min_rad - beyond_rad && rad[j] < link->max_rad + beyond_rad &&
                dig_lever_solve(machine, (enum dig_joint)j, rad[j], &lever) == DIG_OK;
            load[n * j + k] = (struct dig_drive_load){
                .load_N = stands ? -mass_Nm[j] / lever.arm_m : (double)NAN,
                .rubs   = stands
                              ? tanh(lever.arm_m * rates.velocity_radps[j] / DIG_FRICTION_STILL_mps)
                              : 0.0,
            };
        }
    }
}

// Sums over instants of a load, of the direction of friction and of the push of one pair of
// chambers.
struct sums {
    double n, l, ll, p, pp, lp, t, tt, lt, pt;
    double chambers; // of the squares of what either chamber pushes
};

static struct sums add_up(const struct dig_drive_read *const read, const size_t n,
                          const struct dig_air_point at[], const struct dig_drive_load load[])
{
    const double head_m2 = read->cylinder->count * dig_cylinder_head_m2(read->cylinder);
    const double rod_m2  = read->cylinder->count * dig_cylinder_rod_m2(read->cylinder);
    struct sums  sums    = { .n = 0.0 };
    for (size_t k = 0; k < n; k++) {
        const double l = load[k].load_N;
        const double t = load[k].rubs;
        if (isfinite(l)) {
            const double head_N = head_m2 * at[k].sample.value[read->head];
            const double rod_N  = rod_m2 * at[k].sample.value[read->rod];
            const double p      = head_N - rod_N;
            sums.chambers += head_N * head_N + rod_N * rod_N;
            sums.n += 1.0;
            sums.l += l;
            sums.ll += l * l;
            sums.p += p;
            sums.pp += p * p;
            sums.lp += l * p;
            sums.t += t;
            sums.tt += t * t;
            sums.lt += l * t;
            sums.pt += p * t;
        }
    }
    return sums;
}

// Of e = push - load, less offset + share * load + friction, with normal priors, the share within
// its bounds and friction against the motion. What may be left is a share of the push and some
// noise of its chambers: of what is read, whatever the factor.
static double misfit(const struct dig_cylinder *const cylinder, const struct sums *const sums,
                     const double instants, const double poses, const double factor)
{
    enum { ROUNDS = 8 };
    const double each     = poses / instants; // poses an instant
    const double nothing  = 1.0 / (allowed_share * allowed_share);
    const double missing  = (instants - sums->n) * each * nothing;
    const double offset_N = cylinder->count * dig_cylinder_head_m2(cylinder) * offset_Pa;
    const double seal_N   = dig_cylinder_seal_N(cylinder);
    if (!(sums->n > 0.0)) {
        return missing;
    }
    const double p  = factor * sums->p;
    const double pp = factor * factor * sums->pp;
    const double lp = factor * sums->lp;
    const double pt = factor * sums->pt;
    const double read_N2 =
        allowed_share * allowed_share * sums->pp + noise_share * noise_share * sums->chambers;
    const double w = each * sums->n / fmax(factor * factor * read_N2, 1e-9);

    // Each with its own best offset.
    const double e  = p - sums->l;
    const double oo = w * sums->n + 1.0 / (offset_N * offset_N);
    const double ee = w * (pp - 2.0 * lp + sums->ll) - w * e * w * e / oo;
    const double el = w * (lp - sums->ll) - w * e * w * sums->l / oo;
    const double et = w * (pt - sums->lt) - w * e * w * sums->t / oo;
    const double lt = w * sums->lt - w * sums->l * w * sums->t / oo;
    const double ll =
        w * sums->ll - w * sums->l * w * sums->l / oo + 1.0 / (load_share * load_share);
    const double tt     = w * sums->tt - w * sums->t * w * sums->t / oo + 1.0 / (seal_N * seal_N);
    double       share  = 0.0;
    double       rubs_N = 0.0;
    for (int round = 0; round < ROUNDS; round++) {
        share  = fmin(fmax((el - lt * rubs_N) / ll, -most_share), most_share);
        rubs_N = fmax((et - lt * share) / tt, 0.0);
    }
    const double chi2 = ee - 2.0 * share * el - 2.0 * rubs_N * et + ll * share * share +
                        2.0 * lt * share * rubs_N + tt * rubs_N * rubs_N;
    return 0.5 * (fmax(chi2, 0.0) + missing);
}

void dig_drive_misfits(const struct dig_drive_read *read, const size_t n,
                       const struct dig_air_point at[], const struct dig_drive_load load[],
                       const double poses, const size_t factors, const double factor[],
                       double misfits[])
{
    assert(read != NULL && at != NULL && load != NULL && factor != NULL && misfits != NULL);
    const struct sums sums = add_up(read, n, at, load);
    for (size_t f = 0; f < factors; f++) {
        misfits[f] = misfit(read->cylinder, &sums, (double)n, poses, factor[f]);
    }
}

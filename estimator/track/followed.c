#include "estimator/track/followed.h"

#include "estimator/track/ending.h"
#include "estimator/track/track.h"

#include <assert.h>
#include <math.h>

void dig_followed_sample(struct dig_followed *const followed, const bool open,
                         const int64_t time_ns, const double hole_s)
{
    assert(followed != NULL);
    const double step_s = 1e-9 * (double)(time_ns - followed->last_ns);
    followed->missing |= open && step_s > hole_s;
    followed->last_ns = time_ns;
}

void dig_followed_on(struct dig_followed *const followed, const int trajectory,
                     const double progress, const double off_path_m, const double limit_m,
                     const struct dig_path *const path)
{
    assert(followed != NULL && path != NULL);
    if (off_path_m <= 0.5 * limit_m) {
        followed->any        = true;
        followed->trajectory = trajectory;
        followed->progress   = progress;
        followed->path_m     = (double)path->vertices * path->spacing_m;
    }
    followed->left = !(off_path_m <= limit_m);
}

void dig_followed_off(struct dig_followed *const followed)
{
    assert(followed != NULL);
    followed->left = true;
}

bool dig_followed_was_aborted(const struct dig_followed *const followed, const size_t routes,
                              const struct dig_route route[], const struct dig_path *const path,
                              const double limit_m)
{
    assert(followed != NULL && route != NULL && path != NULL);
    if (!followed->any || !followed->left || followed->missing ||
        !(followed->progress >= DIG_ENDING_LEAST && followed->progress < DIG_ENDING_WHOLE_FROM)) {
        return false;
    }
    struct dig_path until = *path;
    until.end             = (size_t)fmin((double)path->end, followed->path_m / path->spacing_m);
    if (until.end <= until.contact) {
        return false;
    }
    struct dig_track fitted[DIG_TRAJECTORY_MAX];
    return dig_track_fit_all(routes, route, &until, limit_m, fitted) == followed->trajectory;
}

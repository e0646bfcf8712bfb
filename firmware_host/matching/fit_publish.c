#include "firmware_host/matching/fit_publish.h"

#include "firmware_host/matching/gravel_state.h"

#include <assert.h>
#include <stdarg.h>
#include <stdio.h>

void dig_fit_log(struct dig_fit *const fit, const char *const format, ...)
{
    assert(fit != NULL && format != NULL);
    struct dig_log_line line;
    va_list             args;
    va_start(args, format);
    // NOLINTNEXTLINE(clang-analyzer-valist.Uninitialized): va_start is the line above
    (void)vsnprintf(line.text, sizeof line.text, format, args);
    va_end(args);
    dig_latest_put(&fit->handoffs->fit_log, &line);
}

void dig_fit_publish_basis(struct dig_fit *const fit, const struct dig_gravel_track *const track)
{
    assert(fit != NULL && track != NULL);
    const struct dig_matcher *const    matcher = &fit->matcher;
    struct dig_prediction_basis *const basis   = &fit->basis;
    basis->set                                 = matcher->set;
    basis->generation                          = matcher->generation;
    basis->known                               = track->valid;
    basis->outside                             = track->match.outside;
    basis->dig_count                           = track->match.dig_count;
    basis->expires_ns                          = track->any ? track->expires_ns : 0;
    dig_forecast_make(matcher->set, matcher->lambda, &track->match, &basis->forecast);

    dig_latest_put(dig_matcher_is_of_tick(matcher) ? &fit->handoffs->basis : &fit->handoffs->table,
                   basis);
    fit->basis_as_dug = false;
}

void dig_fit_publish_basis_as_dug(struct dig_fit *const                fit,
                                  const struct dig_gravel_track *const track,
                                  const size_t trajectory, const struct dig_observation *const dig)
{
    assert(fit != NULL && track != NULL);
    struct dig_matcher *const  matcher  = &fit->matcher;
    struct dig_expected *const expected = &fit->basis.forecast.expected[trajectory];
    if (!track->valid || (dig == NULL && expected->off_table) || !dig_matcher_is_of_tick(matcher)) {
        return;
    }
    if (dig != NULL) {
        dig_matcher_expect(matcher, &track->match, trajectory, &dig->approach, expected);
        dig_forecast_along_plain(matcher->set, trajectory, dig->approach.depth, expected);
    } else {
        expected->valid     = false;
        expected->off_table = true;
    }
    dig_latest_put(&fit->handoffs->basis, &fit->basis);
    fit->basis_as_dug = true;
}

void dig_fit_publish_track(struct dig_fit *const fit)
{
    assert(fit != NULL);
    const struct dig_matcher *const matcher = &fit->matcher;
    dig_fit_publish_basis(fit, &fit->track);
    if (!fit->track.any) {
        return;
    }
    struct dig_fit_result result = { .track = fit->track };
    const int             hint   = fit->track.valid
                                       ? dig_gravel_track_hint(matcher->set, &fit->basis.forecast,
                                                               matcher->lambda, &result.hint_J_per_kg)
                                       : -1;
    if (hint >= 0) {
        (void)snprintf(result.hint_trajectory, sizeof result.hint_trajectory, "%s",
                       matcher->set->trajectory[hint].name);
    }
    (void)dig_ring_push(&fit->handoffs->results, &result);
}

void dig_fit_save_state(struct dig_fit *const fit)
{
    assert(fit != NULL);
    const char *const path  = fit->config->match_state.text;
    struct dig_error  error = { "" };
    if (path[0] != '\0' &&
        dig_gravel_state_write(path, &fit->track, fit->matcher.set, &fit->pool, &error) != DIG_OK) {
        dig_fit_log(fit, "%s", error.text);
    }
}

#include "firmware_host/publish/publish_log.h"

#include "core/text.h"
#include "core/units.h"
#include "estimator/match/match.h"

#include <assert.h>
#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>

__attribute__((format(printf, 2, 0))) static void put_line(const struct dig_publisher *const p,
                                                           const char *const format, va_list args)
{
    char line[512];
    (void)vsnprintf(line, sizeof line, format, args);
    p->say(line);
}

__attribute__((format(printf, 2, 3))) void dig_publisher_log(const struct dig_publisher *const p,
                                                             const char *const format, ...)
{
    va_list args;
    va_start(args, format);
    // NOLINTNEXTLINE(clang-analyzer-valist.Uninitialized): va_start is the line above
    put_line(p, format, args);
    va_end(args);
}

void dig_publisher_log_held(const struct dig_publisher *const p, const int64_t held)
{
    if (held > 0) {
        dig_publisher_log(p, "lines held back, as too many came at once: %" PRId64, held);
    }
}

__attribute__((format(printf, 2, 3))) void dig_publisher_log_limited(struct dig_publisher *const p,
                                                                     const char *const format, ...)
{
    if (!dig_log_limit_allows(&p->log_limit, dig_input_now_ns())) {
        return;
    }
    dig_publisher_log_held(p, dig_log_limit_held(&p->log_limit));
    va_list args;
    va_start(args, format);
    // NOLINTNEXTLINE(clang-analyzer-valist.Uninitialized): va_start is the line above
    put_line(p, format, args);
    va_end(args);
}

// Depth and attack of the dig; those it was matched at, where they differ. "" where not measured.
static void approach_text(const struct dig_gravel_track *const k, const size_t size, char text[])
{
    static const double       shown   = 0.005; // half of a depth's last digit
    const struct dig_approach matched = dig_approach_normalized(&k->matched);
    const struct dig_approach made    = k->made;
    text[0]                           = '\0';
    if (!(made.depth > 0.0)) {
        return;
    }
    const int length = snprintf(text, size, ", depth %.2f, attack %.1f deg", made.depth,
                                made.attack_rad / DIG_RAD_PER_DEG);
    if (fabs(matched.depth - made.depth) > shown ||
        fabs(matched.attack_rad - made.attack_rad) > shown) {
        (void)snprintf(text + length, size - (size_t)length, ", matched at %.2f and %.1f deg",
                       matched.depth, matched.attack_rad / DIG_RAD_PER_DEG);
    }
}

void dig_publisher_log_match(const struct dig_publisher *const p)
{
    const struct dig_gravel_track *const k = &p->result.track;
    const struct dig_match *const        m = &k->match;
    if (!k->valid) {
        dig_publisher_log(p, "no gravel known: %s", k->wanted);
        return;
    }
    char        which[32] = "from before";
    char        how[96];
    char        untold[DIG_UNTOLD_SIZE];
    char        digs[48]     = "";
    char        weighted[96] = "";
    const char *forces       = m->forces ? ", by moment and forces" : ", by the moment alone";
    if (!k->restored) {
        (void)snprintf(which, sizeof which, "dig %" PRIu32, m->dig_count);
    }
    if (m->digs > 1) {
        (void)snprintf(digs, sizeof digs, ", %zu digs together", m->digs);
    }
    if (m->weighted >= 0) {
        (void)snprintf(weighted, sizeof weighted,
                       ", noise-weighted entry %.2f / %.2f / %.0f at %.2f",
                       k->weighted.value[DIG_AXIS_FRICTION], k->weighted.value[DIG_AXIS_ROLLING],
                       k->weighted.value[DIG_AXIS_DENSITY_kgpm3], m->weighted_distance);
    }
    approach_text(k, sizeof how, how);
    dig_match_unresolved(m, untold);
    dig_axes_without_units(untold);
    dig_publisher_log(
        p,
        "%s (%s%s): friction %.2f (%.2f … %.2f), rolling %.2f (%.2f … %.2f), density %.0f "
        "(%.0f … %.0f) kg/m3, distance %.3f, noise floor %.3f%s%s%s%s%s%s",
        which, k->trajectory, how, m->gravel.value[DIG_AXIS_FRICTION],
        m->low.value[DIG_AXIS_FRICTION], m->high.value[DIG_AXIS_FRICTION],
        m->gravel.value[DIG_AXIS_ROLLING], m->low.value[DIG_AXIS_ROLLING],
        m->high.value[DIG_AXIS_ROLLING], m->gravel.value[DIG_AXIS_DENSITY_kgpm3],
        m->low.value[DIG_AXIS_DENSITY_kgpm3], m->high.value[DIG_AXIS_DENSITY_kgpm3], m->distance,
        m->noise_floor, weighted, forces, digs,
        m->outside ? "; OUTSIDE the table: none of its gravels" : "",
        untold[0] != '\0' ? "; a FAMILY of gravels, not told: " : "", untold);
}

void dig_publisher_log_drops(struct dig_publisher *const p, const int64_t now_ns)
{
    const struct dig_drops *const d         = &p->health.tick_status.drops;
    const struct dig_input *const in        = p->health.input;
    const int64_t                 malformed = atomic_load(&in->malformed);
    const int64_t                 checksum  = atomic_load(&in->checksum);
    const int64_t                 timeouts  = atomic_load(&in->timeouts);
    const int64_t                 all =
        d->nan + d->not_available + d->out_of_range + d->frozen + malformed + p->health.lost;
    if (all > p->logged_drops && now_ns >= p->next_drops_ns) {
        p->logged_drops  = all;
        p->next_drops_ns = now_ns + 10 * DIG_NS_PER_S;
        const struct {
            int64_t     count;
            const char *of;
        } drop[] = {
            { d->not_available, "not available" },
            { d->out_of_range, "out of range" },
            { d->frozen, "frozen" },
            { d->nan, "NaN" },
            { malformed, "malformed" },
            { checksum, "wrong checksums" },
            { d->repeated, "repeated" },
            { d->jump, "jumps" },
            { d->stuck, "stuck" },
            { d->missed, "missed" },
            { timeouts, "timeouts" },
            { p->health.lost, "lost" },
        };
        char text[400] = "";
        for (size_t i = 0; i < sizeof drop / sizeof drop[0]; i++) {
            if (drop[i].count > 0) {
                dig_text_add(sizeof text, text, "%s%" PRId64 " %s", text[0] == '\0' ? "" : ", ",
                             drop[i].count, drop[i].of);
            }
        }
        dig_publisher_log(p, "dropped so far: %s", text);
    }
}

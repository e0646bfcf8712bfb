// Writes an identity: one half of files/identity_json.h.

#include "core/markup.h"
#include "core/units.h"
#include "files/identity_json.h"

#include <assert.h>
#include <math.h>

// Depths, and attacks in rad, nearer than this are one.
static const double alike = 1e-9;

static void put_named(FILE *const to, const char *const name, const struct dig_gravel *const g)
{
    dig_json_put(to, "%s: {", name);
    dig_json_gravel(to, g);
    (void)fputs("},\n ", to);
}

// Behind what stands before, on a line of its own.
static void put_numbers(FILE *const to, const char *const before, const char *const name,
                        const double number[])
{
    (void)fprintf(to, "%s\n   \"%s\": [", before, name);
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        (void)fprintf(to, "%s%.7g", k == 0 ? "" : k % 16 == 0 ? ",\n    " : ", ", number[k]);
    }
    (void)fputs("]", to);
}

static void put_forces(FILE *const to, const struct dig_observation *const dig)
{
    put_numbers(to, ",\n   \"force\": {", "x_N", dig->force_N[0]);
    put_numbers(to, ",", "z_N", dig->force_N[1]);
    put_numbers(to, ",", "sigma_x_N", dig->force_sigma_N[0]);
    put_numbers(to, ",", "sigma_z_N", dig->force_sigma_N[1]);
    (void)fputs("}", to);
}

static void put_approach(FILE *const to, const char *const prefix,
                         const struct dig_approach *const approach)
{
    const struct dig_approach normalized = dig_approach_normalized(approach);
    (void)fprintf(to, "\"%sdepth\": %.9g, \"%sattack_deg\": %.9g", prefix, normalized.depth, prefix,
                  normalized.attack_rad / DIG_RAD_PER_DEG);
}

static void put_dig(FILE *const to, const struct dig_identity_dig *const named)
{
    const struct dig_observation *const dig = &named->seen;
    dig_json_put(to, "{\"trajectory\": %s, \"first\": %.9g, \"last\": %.9g", named->trajectory,
                 dig->first, dig->last);
    if (!dig_approach_is_plain(&dig->approach)) {
        (void)fputs(", ", to);
        put_approach(to, "", &dig->approach);
    }
    put_numbers(to, ",", "moment_Nm", dig->moment_Nm);
    put_numbers(to, ",", "sigma_Nm", dig->sigma_Nm);
    if (dig->forces) {
        put_forces(to, dig);
    }
    (void)fputs("}", to);
}

// How the dig was made; what it was matched at, where that is another.
static void put_made(FILE *const to, const struct dig_identity *const identity)
{
    const struct dig_approach *const made    = &identity->made;
    const struct dig_approach        matched = dig_approach_normalized(&identity->matched);
    if (!(made->depth > 0.0)) {
        return;
    }
    put_approach(to, "", made);
    if (fabs(matched.depth - made->depth) > alike ||
        fabs(matched.attack_rad - made->attack_rad) > alike) {
        (void)fputs(", ", to);
        put_approach(to, "matched_", &matched);
    }
    (void)fputs(",\n ", to);
}

void dig_identity_write(FILE *const to, const struct dig_identity *const identity)
{
    assert(to != NULL && identity != NULL);
    const struct dig_match *const match = &identity->match;
    dig_json_put(to, "{\"scene_hash\": %s,\n \"trajectory\": %s, \"digs\": %zu, \"forces\": %i,\n ",
                 identity->scene_hash, identity->trajectory, match->digs, match->forces);
    put_made(to, identity);
    put_named(to, "gravel", &match->gravel);
    put_named(to, "mean", &match->mean);
    put_named(to, "low", &match->low);
    put_named(to, "high", &match->high);
    put_named(to, "nearest", &identity->nearest);
    if (match->weighted >= 0) {
        put_named(to, "weighted_nearest", &identity->weighted_nearest);
        dig_json_put(to, "\"weighted_distance\": %.9g, ", match->weighted_distance);
    }
    dig_json_put(to,
                 "\"distance\": %.9g, \"nearest_distance\": %.9g, \"noise_floor\": %.9g,\n "
                 "\"outside\": %i, \"family\": %i,\n \"samples\": [",
                 match->distance, match->nearest_distance, match->noise_floor, match->outside,
                 identity->family);
    for (size_t i = 0; i < match->samples; i++) {
        (void)fputs(i == 0 ? "{" : ",\n  {", to);
        dig_json_gravel(to, &match->sample[i]);
        (void)fputs("}", to);
    }
    (void)fputs(identity->recorded > 0 ? "],\n \"recorded\": [" : "]", to);
    for (size_t i = 0; i < identity->recorded; i++) {
        (void)fputs(i == 0 ? "" : ",\n  ", to);
        put_dig(to, &identity->recording[i]);
    }
    (void)fputs(identity->recorded > 0 ? "]}\n" : "}\n", to);
}

#include "files/identity_json.h"

#include "core/name.h"
#include "core/units.h"
#include "files/yaml/yaml.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#define SAMPLES_MAX 64 // the first DIG_MATCH_SAMPLES are taken

// Depth 0: not given.
struct identity_text {
    struct dig_identity identity; // but for the samples
    size_t              samples;
    struct dig_gravel   sample[SAMPLES_MAX];
    bool                weighted; // false: from before there was a weighted distance
};

static const struct identity_text defaults = {
    .identity.match = { .valid = true, .weighted_distance = (double)NAN },
};

static const struct dig_yaml_field sample = ENTRY(dig_gravel, dig_yaml_gravel);
static const struct dig_yaml_field sigma  = {
     .kind = DIG_YAML_NUMBER, .size = sizeof(double), .low = 0.0, .high = 1e300
};

#define SEEN(kind, key, member, ...) FIELD(kind, key, dig_identity_dig, seen.member, __VA_ARGS__)
#define CURVE(key, member)           SEEN(LIST, key, member, REQUIRED, .of = &dig_yaml_number)
#define SIGMAS(key, member)          SEEN(LIST, key, member, REQUIRED, .of = &sigma)
#define DEGREES                      OPTIONAL, .factor = DIG_RAD_PER_DEG, .low = -45.0, .high = 45.0

static const struct dig_yaml_field force_fields[] = {
    CURVE("x_N", force_N[0]),
    CURVE("z_N", force_N[1]),
    SIGMAS("sigma_x_N", force_sigma_N[0]),
    SIGMAS("sigma_z_N", force_sigma_N[1]),
    END,
};

static const struct dig_yaml_field dig_fields[] = {
    TEXT(dig_identity_dig, trajectory),
    SEEN(NUMBER, "first", first, REQUIRED, .low = 0.0, .high = 1.0),
    SEEN(NUMBER, "last", last, REQUIRED, .low = 0.0, .high = 1.0),
    CURVE("moment_Nm", moment_Nm),
    SIGMAS("sigma_Nm", sigma_Nm),
    SEEN(NUMBER, "depth", approach.depth, OPTIONAL),
    SEEN(NUMBER, "attack_deg", approach.attack_rad, DEGREES),
    { .key  = "force",
      .kind = DIG_YAML_MAPPING,
      OPTIONAL,
      .of = force_fields,
      GIVEN(dig_identity_dig, seen.forces) },
    END,
};

static const struct dig_yaml_field recorded = ENTRY(dig_identity_dig, dig_fields);

#define OF(kind, key, member, ...) FIELD(kind, key, identity_text, identity.member, __VA_ARGS__)
#define GRAVEL(key, member)        OF(MAPPING, key, member, REQUIRED, .of = dig_yaml_gravel)
#define DISTANCE(name)             OF(NUMBER, #name, match.name, REQUIRED)

static const struct dig_yaml_field fields[] = {
    OF(TEXT, "scene_hash", scene_hash, REQUIRED, .least = 64),
    OF(TEXT, "trajectory", trajectory, REQUIRED, .least = 1),
    OF(COUNT, "digs", match.digs, REQUIRED),
    OF(BOOL, "forces", match.forces, OPTIONAL),
    OF(NUMBER, "depth", made.depth, OPTIONAL),
    OF(NUMBER, "attack_deg", made.attack_rad, DEGREES),
    OF(NUMBER, "matched_depth", matched.depth, OPTIONAL),
    OF(NUMBER, "matched_attack_deg", matched.attack_rad, DEGREES),
    GRAVEL("gravel", match.gravel),
    GRAVEL("mean", match.mean),
    GRAVEL("low", match.low),
    GRAVEL("high", match.high),
    GRAVEL("nearest", nearest),
    OF(MAPPING, "weighted_nearest", weighted_nearest, OPTIONAL, .of = dig_yaml_gravel,
       GIVEN(identity_text, weighted)),
    OF(NUMBER, "weighted_distance", match.weighted_distance, OPTIONAL),
    DISTANCE(distance),
    DISTANCE(nearest_distance),
    DISTANCE(noise_floor),
    OF(BOOL, "outside", match.outside, REQUIRED),
    OF(BOOL, "family", family, OPTIONAL),
    LIST("samples", REQUIRED, identity_text, sample, samples, &sample, 0),
    LIST("recorded", OPTIONAL, identity_text, identity.recording, identity.recorded, &recorded, 0),
    END,
};

static const struct dig_yaml_file schema = { .of       = fields,
                                             .size     = sizeof(struct identity_text),
                                             .kept     = sizeof(struct dig_identity),
                                             .defaults = &defaults };

static bool is_gravel(const struct dig_gravel *const g)
{
    return g->value[DIG_AXIS_FRICTION] >= 0.0 && g->value[DIG_AXIS_ROLLING] >= 0.0 &&
           g->value[DIG_AXIS_DENSITY_kgpm3] > 0.0;
}

// Depth 0 is none given.
static bool is_approach(const struct dig_approach *const approach)
{
    const struct dig_approach normalized = dig_approach_normalized(approach);
    return normalized.depth >= DIG_APPROACH_DEPTH_LEAST &&
           normalized.depth <= DIG_APPROACH_DEPTH_MOST;
}

// No attack comes without a depth.
static void check_approach(const char *const key, const struct dig_approach *const approach,
                           struct dig_conditions *const c)
{
    dig_require(
        c, is_approach(approach) && (approach->depth > 0.0 || fabs(approach->attack_rad) <= 0.0),
        "%s: expected a depth of 0.2 to 3 with an attack of at most 45 deg either way", key);
}

static void take(const char *const path, void *const loaded, struct dig_conditions *const c)
{
    struct identity_text *const text = loaded;
    struct dig_identity *const  read = &text->identity;
    struct dig_match *const     m    = &read->match;
    (void)path;
    check_approach("depth", &read->made, c);
    check_approach("matched_depth", &read->matched, c);
    if (!(read->matched.depth > 0.0)) {
        read->matched = read->made;
    }
    m->weighted = text->weighted ? 0 : -1;
    m->samples  = text->samples < DIG_MATCH_SAMPLES ? text->samples : DIG_MATCH_SAMPLES;
    memcpy(m->sample, text->sample, m->samples * sizeof m->sample[0]);
    dig_require(
        c, !text->weighted || (is_gravel(&read->weighted_nearest) && m->weighted_distance >= 0.0),
        "weighted_nearest: no gravel, expected friction and rolling >= 0, density > 0, "
        "with a weighted_distance >= 0");
    m->weighted_distance = text->weighted ? m->weighted_distance : (double)NAN;
    for (size_t i = 0; i < text->samples; i++) {
        dig_require(
            c, is_gravel(&text->sample[i]),
            "samples: the %zu-th is no gravel, expected friction and rolling >= 0, density > 0",
            i + 1);
    }
    dig_require(c, dig_name_ok(read->trajectory), "trajectory: \"%s\", expected " DIG_NAME_RULE,
                read->trajectory);
    for (size_t i = 0; i < read->recorded; i++) {
        const struct dig_identity_dig *const dig = &read->recording[i];
        dig_require(c,
                    dig_name_ok(dig->trajectory) && dig->seen.last > dig->seen.first &&
                        is_approach(&dig->seen.approach),
                    "recorded: the %zu-th is no dig, expected a name, first < last, and a depth of "
                    "0.2 to 3",
                    i + 1);
    }
    dig_require(c, is_gravel(&m->gravel),
                "gravel: is no gravel, expected friction and rolling >= 0, density > 0");
}

// Depths, and attacks in rad, nearer than this are one.
static const double alike = 1e-9;

void dig_identity_write(FILE *const to, const struct dig_identity *const identity)
{
    assert(to != NULL && identity != NULL);
    const struct dig_approach *const made    = &identity->made;
    struct identity_text             text    = { .identity = *identity,
                                                 .samples  = identity->match.samples,
                                                 .weighted = identity->match.weighted >= 0 };
    struct dig_approach *const       matched = &text.identity.matched;
    memcpy(text.sample, identity->match.sample, text.samples * sizeof text.sample[0]);
    // Where it is another than the dig was made at.
    *matched = dig_approach_normalized(matched);
    if (!(made->depth > 0.0) || (fabs(matched->depth - made->depth) <= alike &&
                                 fabs(matched->attack_rad - made->attack_rad) <= alike)) {
        *matched = (struct dig_approach){ .depth = 0.0 };
    }
    if (!text.weighted) {
        text.identity.match.weighted_distance = (double)NAN;
    }
    dig_json_write(to, &schema, &text);
}

enum dig_status dig_identity_read(const char *const path, struct dig_identity *const identity,
                                  struct dig_error *const error)
{
    return dig_yaml_read(path, &schema, take, identity, error);
}

#include "files/identity_json.h"

#include "core/name.h"
#include "core/units.h"
#include "files/yaml/yaml.h"
#include "files/yaml/yaml_schema.h"

#include <math.h>
#include <string.h>

struct force_text {
    double x_N[DIG_CURVE_POINTS], z_N[DIG_CURVE_POINTS];
    double sigma_x_N[DIG_CURVE_POINTS], sigma_z_N[DIG_CURVE_POINTS];
};

struct dig_text {
    struct dig_identity_dig dig;   // but for its forces; attack in degrees, depth 0: not given
    struct force_text      *force; // NULL: not measured
};

#define SAMPLES_MAX 64 // the first DIG_MATCH_SAMPLES are taken

// Attacks in degrees, depth 0: not given.
struct identity_text {
    struct dig_identity identity; // but for the samples
    size_t              samples;
    struct dig_gravel   sample[SAMPLES_MAX];
    struct dig_gravel  *weighted_nearest; // NULL: from before there was one
    struct dig_text     recorded[DIG_IDENTITY_DIGS_MAX];
};

static const cyaml_schema_value_t sample = ENTRY(dig_gravel, dig_yaml_gravel);

#define CURVE(type, member) NUMBERS(#member, REQUIRED, type, member)

static const cyaml_schema_field_t force_fields[] = {
    CURVE(force_text, x_N),       CURVE(force_text, z_N), CURVE(force_text, sigma_x_N),
    CURVE(force_text, sigma_z_N), CYAML_FIELD_END,
};

#define NUMBER_PERHAPS(key, type, member) CYAML_FIELD_FLOAT(key, OPTIONAL, struct type, member)

static const cyaml_schema_field_t dig_fields[] = {
    CYAML_FIELD_STRING("trajectory", REQUIRED, struct dig_text, dig.trajectory, 1),
    CYAML_FIELD_FLOAT("first", REQUIRED, struct dig_text, dig.seen.first),
    CYAML_FIELD_FLOAT("last", REQUIRED, struct dig_text, dig.seen.last),
    NUMBERS("moment_Nm", REQUIRED, dig_text, dig.seen.moment_Nm),
    NUMBERS("sigma_Nm", REQUIRED, dig_text, dig.seen.sigma_Nm),
    NUMBER_PERHAPS("depth", dig_text, dig.seen.approach.depth),
    NUMBER_PERHAPS("attack_deg", dig_text, dig.seen.approach.attack_rad),
    CYAML_FIELD_MAPPING_PTR("force", OPTIONAL, struct dig_text, force, force_fields),
    CYAML_FIELD_END,
};

static const cyaml_schema_value_t recorded = ENTRY(dig_text, dig_fields);

#define GRAVEL(name, member)                                                                       \
    CYAML_FIELD_MAPPING(name, REQUIRED, struct identity_text, identity.member, dig_yaml_gravel)
#define DISTANCE(name) CYAML_FIELD_FLOAT(#name, REQUIRED, struct identity_text, identity.match.name)

static const cyaml_schema_field_t fields[] = {
    CYAML_FIELD_STRING("scene_hash", REQUIRED, struct identity_text, identity.scene_hash, 64),
    CYAML_FIELD_STRING("trajectory", REQUIRED, struct identity_text, identity.trajectory, 1),
    CYAML_FIELD_UINT("digs", REQUIRED, struct identity_text, identity.match.digs),
    CYAML_FIELD_BOOL("forces", OPTIONAL, struct identity_text, identity.match.forces),
    NUMBER_PERHAPS("depth", identity_text, identity.made.depth),
    NUMBER_PERHAPS("attack_deg", identity_text, identity.made.attack_rad),
    NUMBER_PERHAPS("matched_depth", identity_text, identity.matched.depth),
    NUMBER_PERHAPS("matched_attack_deg", identity_text, identity.matched.attack_rad),
    GRAVEL("gravel", match.gravel),
    GRAVEL("mean", match.mean),
    GRAVEL("low", match.low),
    GRAVEL("high", match.high),
    GRAVEL("nearest", nearest),
    CYAML_FIELD_MAPPING_PTR("weighted_nearest", OPTIONAL, struct identity_text, weighted_nearest,
                            dig_yaml_gravel),
    NUMBER_PERHAPS("weighted_distance", identity_text, identity.match.weighted_distance),
    DISTANCE(distance),
    DISTANCE(nearest_distance),
    DISTANCE(noise_floor),
    CYAML_FIELD_BOOL("outside", REQUIRED, struct identity_text, identity.match.outside),
    CYAML_FIELD_BOOL("family", OPTIONAL, struct identity_text, identity.family),
    LIST("samples", REQUIRED, identity_text, sample, samples, &sample, 0, SAMPLES_MAX),
    LIST("recorded", OPTIONAL, identity_text, recorded, identity.recorded, &recorded, 0,
         DIG_IDENTITY_DIGS_MAX),
    CYAML_FIELD_END,
};

static const cyaml_schema_value_t schema = FILE_OF(identity_text, fields);

static bool is_gravel(const struct dig_gravel *const g)
{
    return isfinite(g->value[0]) && isfinite(g->value[1]) && isfinite(g->value[2]) &&
           g->value[DIG_AXIS_FRICTION] >= 0.0 && g->value[DIG_AXIS_ROLLING] >= 0.0 &&
           g->value[DIG_AXIS_DENSITY_kgpm3] > 0.0;
}

static bool is_curve(const double value[DIG_CURVE_POINTS], const double sigma[DIG_CURVE_POINTS])
{
    bool is = true;
    for (size_t k = 0; is && k < DIG_CURVE_POINTS; k++) {
        is = isfinite(value[k]) && isfinite(sigma[k]) && sigma[k] >= 0.0;
    }
    return is;
}

// Depth 0 is none given.
static bool is_approach(const struct dig_approach *const approach)
{
    const struct dig_approach normalized = dig_approach_normalized(approach);
    return normalized.depth >= DIG_APPROACH_DEPTH_LEAST &&
           normalized.depth <= DIG_APPROACH_DEPTH_MOST &&
           fabs(normalized.attack_rad) <= DIG_APPROACH_ATTACK_MOST_rad;
}

static bool is_dig(const struct dig_observation *const dig)
{
    return is_approach(&dig->approach) && dig->first >= 0.0 && dig->last > dig->first &&
           dig->last <= 1.0 && is_curve(dig->moment_Nm, dig->sigma_Nm) &&
           is_curve(dig->force_N[0], dig->force_sigma_N[0]) &&
           is_curve(dig->force_N[1], dig->force_sigma_N[1]);
}

static void take_dig(const struct dig_text *const text, struct dig_identity_dig *const named)
{
    *named                            = text->dig;
    struct dig_observation *const dig = &named->seen;
    dig->approach.attack_rad *= DIG_RAD_PER_DEG;
    dig->forces = text->force != NULL;
    if (dig->forces) {
        memcpy(dig->force_N[0], text->force->x_N, sizeof dig->force_N[0]);
        memcpy(dig->force_N[1], text->force->z_N, sizeof dig->force_N[1]);
        memcpy(dig->force_sigma_N[0], text->force->sigma_x_N, sizeof dig->force_sigma_N[0]);
        memcpy(dig->force_sigma_N[1], text->force->sigma_z_N, sizeof dig->force_sigma_N[1]);
    }
}

// No attack comes without a depth.
static void take_approach(const char *const key, struct dig_approach *const approach,
                          struct dig_conditions *const c)
{
    const double attack_deg = approach->attack_rad;
    approach->attack_rad *= DIG_RAD_PER_DEG;
    dig_require(c, is_approach(approach) && (approach->depth > 0.0 || fabs(attack_deg) <= 0.0),
                "%s: expected a depth of 0.2 to 3 with an attack of at most 45 deg either way",
                key);
}

static void take(const char *const path, cyaml_data_t *const loaded, void *const into,
                 struct dig_conditions *const c)
{
    const struct identity_text *const text = loaded;
    struct dig_identity               read = text->identity;
    struct dig_match *const           m    = &read.match;
    (void)path;
    take_approach("depth", &read.made, c);
    take_approach("matched_depth", &read.matched, c);
    if (!(read.matched.depth > 0.0)) {
        read.matched = read.made;
    }
    m->valid    = true;
    m->weighted = text->weighted_nearest != NULL ? 0 : -1;
    m->samples  = text->samples < DIG_MATCH_SAMPLES ? text->samples : DIG_MATCH_SAMPLES;
    memcpy(m->sample, text->sample, m->samples * sizeof m->sample[0]);
    if (text->weighted_nearest != NULL) {
        read.weighted_nearest = *text->weighted_nearest;
        dig_require(c, is_gravel(&read.weighted_nearest) && m->weighted_distance >= 0.0,
                    "weighted_nearest: no gravel, expected friction and rolling >= 0, density > 0, "
                    "with a weighted_distance >= 0");
    } else {
        m->weighted_distance = (double)NAN;
    }
    for (size_t i = 0; i < text->samples; i++) {
        dig_require(
            c, is_gravel(&text->sample[i]),
            "samples: the %zu-th is no gravel, expected friction and rolling >= 0, density > 0",
            i + 1);
    }
    dig_require(c, dig_name_ok(read.trajectory), "trajectory: \"%s\", expected " DIG_NAME_RULE,
                read.trajectory);
    for (size_t i = 0; i < read.recorded; i++) {
        take_dig(&text->recorded[i], &read.recording[i]);
        dig_require(c, dig_name_ok(read.recording[i].trajectory) && is_dig(&read.recording[i].seen),
                    "recorded: the %zu-th is no dig, expected a name, 0 <= first < last <= 1, "
                    "finite moments and forces, sigmas >= 0",
                    i + 1);
    }
    dig_require(c, is_gravel(&m->gravel),
                "gravel: is no gravel, expected friction and rolling >= 0, density > 0");
    if (c->status == DIG_OK) {
        *(struct dig_identity *)into = read;
    }
}

enum dig_status dig_identity_read(const char *const path, struct dig_identity *const identity,
                                  struct dig_error *const error)
{
    return dig_yaml_read(path, &schema, take, identity, error);
}

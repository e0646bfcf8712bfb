#include "files/identity_json.h"

#include "core/name.h"
#include "core/units.h"
#include "files/yaml.h"

#include <assert.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

#define REQUIRED CYAML_FLAG_DEFAULT

struct gravel_text {
    double friction, rolling, density_kgpm3;
};

struct force_text {
    double x_N[DIG_CURVE_POINTS], z_N[DIG_CURVE_POINTS];
    double sigma_x_N[DIG_CURVE_POINTS], sigma_z_N[DIG_CURVE_POINTS];
};

struct dig_text {
    char               trajectory[DIG_NAME_SIZE];
    double             first, last;
    double             depth, attack_deg; // depth 0: not given
    double             moment_Nm[DIG_CURVE_POINTS];
    double             sigma_Nm[DIG_CURVE_POINTS];
    struct force_text *force; // NULL: not measured
};

struct identity_text {
    char                scene_hash[65];
    char                trajectory[DIG_NAME_SIZE];
    uint32_t            digs;
    bool                forces;
    double              depth, attack_deg;                 // depth 0: not given
    double              matched_depth, matched_attack_deg; // the same
    struct gravel_text  gravel, mean, low, high, nearest;
    struct gravel_text *weighted_nearest; // NULL: from before there was one
    double              weighted_distance;
    double              distance, nearest_distance, noise_floor;
    bool                outside;
    bool                family;
    struct gravel_text  samples[DIG_IDENTITY_SAMPLES_MAX];
    uint32_t            samples_count;

    struct dig_text recorded[DIG_IDENTITY_DIGS_MAX];
    uint32_t        recorded_count;
};

static const cyaml_schema_field_t gravel_fields[] = {
    CYAML_FIELD_FLOAT("friction", REQUIRED, struct gravel_text, friction),
    CYAML_FIELD_FLOAT("rolling", REQUIRED, struct gravel_text, rolling),
    CYAML_FIELD_FLOAT("density_kgpm3", REQUIRED, struct gravel_text, density_kgpm3),
    CYAML_FIELD_END,
};

static const cyaml_schema_value_t sample = { CYAML_VALUE_MAPPING(REQUIRED, struct gravel_text,
                                                                 gravel_fields) };

static const cyaml_schema_value_t number = { CYAML_VALUE_FLOAT(REQUIRED, double) };

#define NUMBERS(name, type)                                                                        \
    CYAML_FIELD_SEQUENCE_FIXED(#name, REQUIRED, type, name, &number, DIG_CURVE_POINTS)

static const cyaml_schema_field_t force_fields[] = {
    NUMBERS(x_N, struct force_text),
    NUMBERS(z_N, struct force_text),
    NUMBERS(sigma_x_N, struct force_text),
    NUMBERS(sigma_z_N, struct force_text),
    CYAML_FIELD_END,
};

static const cyaml_schema_field_t dig_fields[] = {
    CYAML_FIELD_STRING("trajectory", REQUIRED, struct dig_text, trajectory, 1),
    CYAML_FIELD_FLOAT("first", REQUIRED, struct dig_text, first),
    CYAML_FIELD_FLOAT("last", REQUIRED, struct dig_text, last),
    NUMBERS(moment_Nm, struct dig_text),
    NUMBERS(sigma_Nm, struct dig_text),
    CYAML_FIELD_FLOAT("depth", CYAML_FLAG_OPTIONAL, struct dig_text, depth),
    CYAML_FIELD_FLOAT("attack_deg", CYAML_FLAG_OPTIONAL, struct dig_text, attack_deg),
    CYAML_FIELD_MAPPING_PTR("force", CYAML_FLAG_OPTIONAL, struct dig_text, force, force_fields),
    CYAML_FIELD_END,
};

static const cyaml_schema_value_t recorded = { CYAML_VALUE_MAPPING(REQUIRED, struct dig_text,
                                                                   dig_fields) };

#define NUMBER_PERHAPS(name)                                                                       \
    CYAML_FIELD_FLOAT(#name, CYAML_FLAG_OPTIONAL, struct identity_text, name)

#define GRAVEL(name) CYAML_FIELD_MAPPING(#name, REQUIRED, struct identity_text, name, gravel_fields)

static const cyaml_schema_field_t fields[] = {
    CYAML_FIELD_STRING("scene_hash", REQUIRED, struct identity_text, scene_hash, 64),
    CYAML_FIELD_STRING("trajectory", REQUIRED, struct identity_text, trajectory, 1),
    CYAML_FIELD_UINT("digs", REQUIRED, struct identity_text, digs),
    CYAML_FIELD_BOOL("forces", CYAML_FLAG_OPTIONAL, struct identity_text, forces),
    NUMBER_PERHAPS(depth),
    NUMBER_PERHAPS(attack_deg),
    NUMBER_PERHAPS(matched_depth),
    NUMBER_PERHAPS(matched_attack_deg),
    GRAVEL(gravel),
    GRAVEL(mean),
    GRAVEL(low),
    GRAVEL(high),
    GRAVEL(nearest),
    CYAML_FIELD_MAPPING_PTR("weighted_nearest", CYAML_FLAG_OPTIONAL, struct identity_text,
                            weighted_nearest, gravel_fields),
    NUMBER_PERHAPS(weighted_distance),
    CYAML_FIELD_FLOAT("distance", REQUIRED, struct identity_text, distance),
    CYAML_FIELD_FLOAT("nearest_distance", REQUIRED, struct identity_text, nearest_distance),
    CYAML_FIELD_FLOAT("noise_floor", REQUIRED, struct identity_text, noise_floor),
    CYAML_FIELD_BOOL("outside", REQUIRED, struct identity_text, outside),
    CYAML_FIELD_BOOL("family", CYAML_FLAG_OPTIONAL, struct identity_text, family),
    CYAML_FIELD_SEQUENCE("samples", REQUIRED, struct identity_text, samples, &sample, 0,
                         DIG_IDENTITY_SAMPLES_MAX),
    CYAML_FIELD_SEQUENCE("recorded", CYAML_FLAG_OPTIONAL, struct identity_text, recorded, &recorded,
                         0, DIG_IDENTITY_DIGS_MAX),
    CYAML_FIELD_END,
};

static const cyaml_schema_value_t schema = { CYAML_VALUE_MAPPING(CYAML_FLAG_POINTER,
                                                                 struct identity_text, fields) };

static struct dig_gravel gravel_of(const struct gravel_text *const text)
{
    return (struct dig_gravel){ { text->friction, text->rolling, text->density_kgpm3 } };
}

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
    const struct dig_approach told = dig_approach_normalized(approach);
    return told.depth >= DIG_APPROACH_DEPTH_LEAST && told.depth <= DIG_APPROACH_DEPTH_MOST &&
           fabs(told.attack_rad) <= DIG_APPROACH_ATTACK_MOST_rad;
}

static bool is_dig(const struct dig_identity_dig *const dig)
{
    return dig_name_ok(dig->trajectory) && is_approach(&dig->approach) && dig->first >= 0.0 &&
           dig->last > dig->first && dig->last <= 1.0 && is_curve(dig->moment_Nm, dig->sigma_Nm) &&
           is_curve(dig->force_N[0], dig->force_sigma_N[0]) &&
           is_curve(dig->force_N[1], dig->force_sigma_N[1]);
}

static void take_dig(const struct dig_text *const text, struct dig_identity_dig *const dig)
{
    *dig =
        (struct dig_identity_dig){ .first    = text->first,
                                   .last     = text->last,
                                   .approach = { text->depth, text->attack_deg * DIG_RAD_PER_DEG },
                                   .forces   = text->force != NULL };
    memcpy(dig->trajectory, text->trajectory, sizeof dig->trajectory);
    memcpy(dig->moment_Nm, text->moment_Nm, sizeof dig->moment_Nm);
    memcpy(dig->sigma_Nm, text->sigma_Nm, sizeof dig->sigma_Nm);
    if (text->force != NULL) {
        memcpy(dig->force_N[0], text->force->x_N, sizeof dig->force_N[0]);
        memcpy(dig->force_N[1], text->force->z_N, sizeof dig->force_N[1]);
        memcpy(dig->force_sigma_N[0], text->force->sigma_x_N, sizeof dig->force_sigma_N[0]);
        memcpy(dig->force_sigma_N[1], text->force->sigma_z_N, sizeof dig->force_sigma_N[1]);
    }
}

// False when it is out of range, or an attack comes without a depth.
static bool take_approach(const double depth, const double attack_deg,
                          struct dig_approach *const approach)
{
    *approach = (struct dig_approach){ depth, attack_deg * DIG_RAD_PER_DEG };
    return is_approach(approach) && (depth > 0.0 || fabs(attack_deg) <= 0.0);
}

static enum dig_status take_made(const char *const path, const struct identity_text *const text,
                                 struct dig_identity *const identity, struct dig_error *const error)
{
    static const char expected[] =
        "expected a depth of 0.2 to 3 with an attack of at most 45 deg either way";
    if (!take_approach(text->depth, text->attack_deg, &identity->made)) {
        return dig_yaml_refuse(path, "depth", error, "%s", expected);
    }
    if (!take_approach(text->matched_depth, text->matched_attack_deg, &identity->matched)) {
        return dig_yaml_refuse(path, "matched_depth", error, "%s", expected);
    }
    if (!(text->matched_depth > 0.0)) {
        identity->matched = identity->made;
    }
    return DIG_OK;
}

enum dig_status dig_identity_read(const char *const path, struct dig_identity *const identity,
                                  struct dig_error *const error)
{
    assert(path != NULL && identity != NULL);
    cyaml_data_t   *data   = NULL;
    enum dig_status status = dig_yaml_load(path, &schema, &data, error);
    if (status != DIG_OK) {
        return status;
    }

    const struct identity_text *const text = data;
    struct dig_identity               read = {
                      .digs             = text->digs,
                      .forces           = text->forces,
                      .gravel           = gravel_of(&text->gravel),
                      .mean             = gravel_of(&text->mean),
                      .low              = gravel_of(&text->low),
                      .high             = gravel_of(&text->high),
                      .nearest          = gravel_of(&text->nearest),
                      .distance         = text->distance,
                      .nearest_distance = text->nearest_distance,
                      .noise_floor      = text->noise_floor,
                      .outside          = text->outside,
                      .family           = text->family,
                      .samples          = text->samples_count,
                      .recorded         = text->recorded_count,
    };
    memcpy(read.scene_hash, text->scene_hash, sizeof read.scene_hash);
    memcpy(read.trajectory, text->trajectory, sizeof read.trajectory);
    if (text->weighted_nearest != NULL) {
        read.weighted          = true;
        read.weighted_nearest  = gravel_of(text->weighted_nearest);
        read.weighted_distance = text->weighted_distance;
    }
    status = take_made(path, text, &read, error);
    if (status == DIG_OK && read.weighted &&
        !(is_gravel(&read.weighted_nearest) && read.weighted_distance >= 0.0)) {
        status = dig_yaml_refuse(path, "weighted_nearest", error,
                                 "no gravel, expected friction and rolling >= 0, density > 0, with "
                                 "a weighted_distance >= 0");
    }
    for (size_t i = 0; i < read.samples && status == DIG_OK; i++) {
        read.sample[i] = gravel_of(&text->samples[i]);
        if (!is_gravel(&read.sample[i])) {
            status = dig_yaml_refuse(path, "samples", error,
                                     "the %zu-th is no gravel, expected friction and rolling >= 0, "
                                     "density > 0",
                                     i + 1);
        }
    }
    if (status == DIG_OK && !dig_name_ok(read.trajectory)) {
        status = dig_yaml_refuse(path, "trajectory", error, "\"%s\", expected " DIG_NAME_RULE,
                                 read.trajectory);
    }
    for (size_t i = 0; i < read.recorded && status == DIG_OK; i++) {
        take_dig(&text->recorded[i], &read.recording[i]);
        if (!is_dig(&read.recording[i])) {
            status = dig_yaml_refuse(
                path, "recorded", error,
                "the %zu-th is no dig, expected a name, 0 <= first < last <= 1, finite "
                "moments and forces, sigmas >= 0",
                i + 1);
        }
    }
    if (status == DIG_OK && !is_gravel(&read.gravel)) {
        status = dig_yaml_refuse(path, "gravel", error,
                                 "is no gravel, expected friction and rolling >= 0, density > 0");
    }
    if (status == DIG_OK) {
        *identity = read;
    }
    dig_yaml_free(&schema, data);
    return status;
}

#include "files/identity_json.h"

#include "core/units.h"
#include "files/yaml.h"

#include <assert.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

static void put_gravel(FILE *const to, const struct dig_gravel *const g)
{
    for (int a = 0; a < DIG_AXES; a++) {
        (void)fprintf(to, "%s\"%s\": %.9g", a == 0 ? "{" : ", ", dig_axis_name((enum dig_axis)a),
                      g->value[a]);
    }
    (void)fputs("}", to);
}

static void put_named(FILE *const to, const char *const name, const struct dig_gravel *const g)
{
    (void)fprintf(to, "\"%s\": ", name);
    put_gravel(to, g);
    (void)fputs(",\n ", to);
}

static void put_numbers(FILE *const to, const char *const name, const double number[])
{
    (void)fprintf(to, "\n   \"%s\": [", name);
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        (void)fprintf(to, "%s%.7g", k == 0 ? "" : k % 16 == 0 ? ",\n    " : ", ", number[k]);
    }
    (void)fputs("]", to);
}

static void put_forces(FILE *const to, const struct dig_identity_dig *const dig)
{
    (void)fputs(",\n   \"force\": {", to);
    put_numbers(to, "x_N", dig->force_N[0]);
    (void)fputs(",", to);
    put_numbers(to, "z_N", dig->force_N[1]);
    (void)fputs(",", to);
    put_numbers(to, "sigma_x_N", dig->force_sigma_N[0]);
    (void)fputs(",", to);
    put_numbers(to, "sigma_z_N", dig->force_sigma_N[1]);
    (void)fputs("}", to);
}

static void put_dig(FILE *const to, const struct dig_identity_dig *const dig)
{
    (void)fprintf(to, "{\"trajectory\": \"%s\", \"first\": %.9g, \"last\": %.9g,", dig->trajectory,
                  dig->first, dig->last);
    if (!dig_approach_is_plain(&dig->approach)) {
        (void)fprintf(to, " \"depth\": %.9g, \"attack_deg\": %.9g,", dig->approach.depth,
                      dig->approach.attack_rad / DIG_RAD_PER_DEG);
    }
    put_numbers(to, "moment_Nm", dig->moment_Nm);
    (void)fputs(",", to);
    put_numbers(to, "sigma_Nm", dig->sigma_Nm);
    if (dig->forces) {
        put_forces(to, dig);
    }
    (void)fputs("}", to);
}

void dig_identity_write(FILE *const to, const struct dig_identity *const identity)
{
    assert(to != NULL && identity != NULL);
    (void)fprintf(
        to, "{\"scene_hash\": \"%s\",\n \"trajectory\": \"%s\", \"digs\": %zu, \"forces\": %s,\n ",
        identity->scene_hash, identity->trajectory, identity->digs,
        identity->forces ? "true" : "false");
    put_named(to, "gravel", &identity->gravel);
    put_named(to, "mean", &identity->mean);
    put_named(to, "low", &identity->low);
    put_named(to, "high", &identity->high);
    put_named(to, "nearest", &identity->nearest);
    (void)fprintf(to,
                  "\"distance\": %.9g, \"nearest_distance\": %.9g, \"noise_floor\": %.9g,\n "
                  "\"outside\": %s,\n \"samples\": [",
                  identity->distance, identity->nearest_distance, identity->noise_floor,
                  identity->outside ? "true" : "false");
    for (size_t i = 0; i < identity->samples; i++) {
        (void)fputs(i == 0 ? "" : ",\n  ", to);
        put_gravel(to, &identity->sample[i]);
    }
    (void)fputs(identity->recorded > 0 ? "],\n \"recorded\": [" : "]", to);
    for (size_t i = 0; i < identity->recorded; i++) {
        (void)fputs(i == 0 ? "" : ",\n  ", to);
        put_dig(to, &identity->recording[i]);
    }
    (void)fputs(identity->recorded > 0 ? "]}\n" : "}\n", to);
}

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
    char               scene_hash[65];
    char               trajectory[DIG_NAME_SIZE];
    uint32_t           digs;
    bool               forces;
    struct gravel_text gravel, mean, low, high, nearest;
    double             distance, nearest_distance, noise_floor;
    bool               outside;
    struct gravel_text samples[DIG_IDENTITY_SAMPLES_MAX];
    uint32_t           samples_count;

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

#define GRAVEL(name) CYAML_FIELD_MAPPING(#name, REQUIRED, struct identity_text, name, gravel_fields)

static const cyaml_schema_field_t fields[] = {
    CYAML_FIELD_STRING("scene_hash", REQUIRED, struct identity_text, scene_hash, 64),
    CYAML_FIELD_STRING("trajectory", REQUIRED, struct identity_text, trajectory, 1),
    CYAML_FIELD_UINT("digs", REQUIRED, struct identity_text, digs),
    CYAML_FIELD_BOOL("forces", CYAML_FLAG_OPTIONAL, struct identity_text, forces),
    GRAVEL(gravel),
    GRAVEL(mean),
    GRAVEL(low),
    GRAVEL(high),
    GRAVEL(nearest),
    CYAML_FIELD_FLOAT("distance", REQUIRED, struct identity_text, distance),
    CYAML_FIELD_FLOAT("nearest_distance", REQUIRED, struct identity_text, nearest_distance),
    CYAML_FIELD_FLOAT("noise_floor", REQUIRED, struct identity_text, noise_floor),
    CYAML_FIELD_BOOL("outside", REQUIRED, struct identity_text, outside),
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

static bool is_dig(const struct dig_identity_dig *const dig)
{
    const struct dig_approach made = dig_approach_told(&dig->approach);
    return made.depth >= DIG_APPROACH_DEPTH_LEAST && made.depth <= DIG_APPROACH_DEPTH_MOST &&
           fabs(made.attack_rad) <= DIG_APPROACH_ATTACK_MOST_rad && dig->first >= 0.0 &&
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
                      .samples          = text->samples_count,
                      .recorded         = text->recorded_count,
    };
    memcpy(read.scene_hash, text->scene_hash, sizeof read.scene_hash);
    memcpy(read.trajectory, text->trajectory, sizeof read.trajectory);
    for (size_t i = 0; i < read.samples && status == DIG_OK; i++) {
        read.sample[i] = gravel_of(&text->samples[i]);
        if (!is_gravel(&read.sample[i])) {
            status = dig_yaml_refuse(path, "samples", error,
                                     "the %zu-th is no gravel, expected friction and rolling >= 0, "
                                     "density > 0",
                                     i + 1);
        }
    }
    for (size_t i = 0; i < read.recorded && status == DIG_OK; i++) {
        take_dig(&text->recorded[i], &read.recording[i]);
        if (!is_dig(&read.recording[i])) {
            status =
                dig_yaml_refuse(path, "recorded", error,
                                "the %zu-th is no dig, expected 0 <= first < last <= 1, finite "
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

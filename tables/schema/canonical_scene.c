#include "tables/schema/canonical_scene.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

// What stands behind "key=" at or after *from, and *from behind that; NULL when there is no more.
// The text begins with the scene's name: every other key has a line before it.
static const char *find_value(const char **const from, const char *const key)
{
    for (const char *at = strchr(*from, '\n'); at != NULL; at = strchr(at + 1, '\n')) {
        const size_t length = strlen(key);
        if (strncmp(at + 1, key, length) == 0 && at[1 + length] == '=') {
            *from = at + 1;
            return at + 1 + length + 1;
        }
    }
    return NULL;
}

// Up to n numbers behind the first `key=`; those that are not there are NaN.
static void read_numbers(const char *const at, const size_t n, double value[const])
{
    const char *from = at;
    for (size_t i = 0; i < n; i++) {
        char *end = NULL;
        value[i]  = from != NULL ? strtod(from, &end) : (double)NAN;
        if (from != NULL && end == from) {
            value[i] = (double)NAN;
            from     = NULL;
        } else if (from != NULL) {
            from = end;
        }
    }
}

static void read_first(const char *const canonical, const char *const key, const size_t n,
                       double value[const])
{
    const char *from = canonical;
    read_numbers(find_value(&from, key), n, value);
}

// Rows of two numbers; returns how many there are, at most `most`.
static size_t read_pairs(const char *const canonical, const char *const key, const size_t most,
                         double x[const], double z[const])
{
    const char *from = canonical;
    size_t      n    = 0;
    for (const char *at; n < most && (at = find_value(&from, key)) != NULL; n++) {
        double pair[2];
        read_numbers(at, 2, pair);
        x[n] = pair[0];
        z[n] = pair[1];
    }
    return n;
}

static size_t read_sizes(const char *const canonical, struct dig_size size[const])
{
    double       diameter_m[DIG_SIZES_MAX];
    double       fraction[DIG_SIZES_MAX];
    const size_t n = read_pairs(canonical, "size", DIG_SIZES_MAX, diameter_m, fraction);
    for (size_t i = 0; i < n; i++) {
        size[i] = (struct dig_size){ diameter_m[i], fraction[i] };
    }
    return n;
}

static size_t read_material_pairs(const char *const canonical, struct dig_material_pair pair[const])
{
    const char *from = canonical;
    size_t      n    = 0;
    for (const char *at; n < DIG_PAIRS_MAX && (at = find_value(&from, "pair")) != NULL; n++) {
        double of[5];
        read_numbers(at, 5, of);
        const bool named = of[0] >= 0.0 && of[0] <= DIG_MATERIAL_WALLS && of[1] >= 0.0 &&
                           of[1] <= DIG_MATERIAL_WALLS;
        pair[n] = (struct dig_material_pair){ named ? (size_t)of[0] : 0, named ? (size_t)of[1] : 0,
                                              of[2], of[3], of[4] };
    }
    return n;
}

// Rows of a profile's number, x and z, under the y of each profile.
static void read_profiles(const char *const canonical, struct dig_bed_plan *const bed)
{
    const char *from = canonical;
    for (const char *at;
         bed->profiles < DIG_PROFILES_MAX && (at = find_value(&from, "ground_y_m")) != NULL;) {
        read_numbers(at, 1, &bed->profile[bed->profiles++].y_m);
    }
    from = canonical;
    for (const char *at; (at = find_value(&from, "ground_m")) != NULL;) {
        double row[3];
        read_numbers(at, 3, row);
        if (!(row[0] >= 0.0 && row[0] < (double)bed->profiles)) {
            continue;
        }
        struct dig_ground_profile *const p = &bed->profile[(size_t)row[0]];
        if (p->points < DIG_SURFACE_MAX) {
            p->x_m[p->points]   = row[1];
            p->z_m[p->points++] = row[2];
        }
    }
}

void dig_scene_from_canonical(const char *const canonical, struct dig_scene *const scene)
{
    assert(canonical != NULL && scene != NULL);
    struct dig_bucket *const   bucket = &scene->bucket;
    struct dig_bed_plan *const bed    = &scene->bed;
    double                     box[6];
    double                     material[5];
    read_first(canonical, "bucket_width_m", 1, &bucket->width_m);
    bucket->points = read_pairs(canonical, "profile_m", DIG_PROFILE_MAX, bucket->x_m, bucket->z_m);
    read_first(canonical, "box_m", 6, box);
    read_first(canonical, "material", 5, material);
    read_first(canonical, "gravity_mps2", 1, &scene->gravity_mps2);
    read_first(canonical, "time_step_s", 1, &scene->time_step_s);
    scene->box      = (struct dig_box){ box[0], box[1], box[2], box[3], box[4], box[5] };
    scene->material = (struct dig_material){ material[0], material[1], material[2],
                                             material[3], material[4], 0.0 };

    // What is not plain stands in the text only where it is so.
    bed->surface =
        read_pairs(canonical, "surface_m", DIG_SURFACE_MAX, bed->surface_x_m, bed->surface_z_m);
    read_profiles(canonical, bed);
    bed->sizes = read_sizes(canonical, bed->size);
    bed->pairs = read_material_pairs(canonical, bed->pair);
    if (strstr(canonical, "\nyoung_at_kgpm3=") != NULL) {
        read_first(canonical, "young_at_kgpm3", 1, &scene->material.young_at_kgpm3);
    }
    bed->periodic_y = strstr(canonical, "\nperiodic_y\n") != NULL;
    scene->laws.normal =
        strstr(canonical, "\nnormal=hertz\n") != NULL ? DIG_NORMAL_HERTZ : DIG_NORMAL_HOOKE;
}

// What LIGGGHTS-PUBLIC 3.8 computed, as the tests that compare with it read it: tests/data/liggghts
// holds the decks, the script that runs them and the CSV files.

#ifndef DIG_TESTS_LIGGGHTS_FIXTURE_H
#define DIG_TESTS_LIGGGHTS_FIXTURE_H

#include "tests/dem_fixture.h"

#include <math.h>
#include <stdio.h>

#define FOLDER  "tests/data/liggghts/"
#define LINES   4096
#define COLUMNS 16

struct table {
    size_t rows, columns;
    double value[LINES][COLUMNS];
};

static inline struct table *read_table(const char *const path)
{
    struct table *const table = calloc(1, sizeof *table);
    FILE *const         file  = fopen(path, "r");
    assert_non_null(table);
    if (file == NULL) {
        fail_msg("%s is missing", path);
    }
    char line[512];
    assert_non_null(fgets(line, sizeof line, file)); // the header
    while (fgets(line, sizeof line, file) != NULL) {
        assert_true(table->rows < LINES);
        size_t column = 0;
        for (char *p = line; *p != '\0' && *p != '\n'; p += *p == ',') {
            assert_true(column < COLUMNS);
            table->value[table->rows][column++] = strtod(p, &p);
        }
        table->columns = column;
        table->rows++;
    }
    (void)fclose(file);
    assert_true(table->rows > 0); // of nothing, every comparison would hold
    return table;
}

/// A world of like grains where the table's first three columns are.
static inline struct dig_world world_of(const struct table *const     start,
                                        const struct dig_law_material material)
{
    double(*const x)[3] = calloc(start->rows, sizeof *x);
    assert_non_null(x);
    for (size_t i = 0; i < start->rows; i++) {
        memcpy(x[i], start->value[i], sizeof x[i]);
    }
    const struct dig_world world = dem_world(start->rows, (const double(*)[3])x, material);
    free(x);
    return world;
}

/// How far ours may be from theirs.
struct tolerance {
    double x_m, f_N, t_Nm;
};

/// The first grain against a CSV of every step: columns 1 ... 3 are its position, 10 ... 12 the
/// force and 13 ... 15 the torque LIGGGHTS found there. Ours are the changes of velocity and
/// rotation from one half step to the next.
static inline void follow(struct dig_world *const world, const char *const path,
                          const struct tolerance tolerance)
{
    print_message("%s\n", path);
    struct table *const         table = read_table(path);
    const struct dig_grain_type type  = world->grains.type[world->grains.type_of[0]];
    assert_true(table->rows > 40 && table->columns == 16);
    for (size_t s = 0; s < table->rows; s++) {
        const double *const     row    = table->value[s];
        const struct dig_motion before = *dem_grain(world, 0);
        assert_int_equal((int)row[0], (int)s);
        dem_run(world, 1);
        const struct dig_motion after  = *dem_grain(world, 0);
        const double            kick_s = s == 0 ? 0.5 * world->dt_s : world->dt_s;
        for (int k = 0; k < 3; k++) {
            const double force_N = type.mass_kg * (after.v_mps[k] - before.v_mps[k]) / kick_s;
            const double torque_Nm =
                type.inertia_kgm2 * (after.w_radps[k] - before.w_radps[k]) / kick_s;
            assert_close(before.x_m[k], row[1 + k], tolerance.x_m);
            assert_close(force_N, row[10 + k], tolerance.f_N);
            assert_close(torque_Nm, row[13 + k], tolerance.t_Nm);
        }
    }
    free(table);
}

#endif // DIG_TESTS_LIGGGHTS_FIXTURE_H

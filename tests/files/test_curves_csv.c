// Tests for files/curves_csv.c and curve_map_yaml.c

#include "files/curves_csv.h"

#include "tests/scratch.h"

struct seen {
    size_t                 digs;
    struct dig_foreign_dig dig[4];
    struct dig_force_row   first[4], last[4];
};

static enum dig_status see(void *const context, const struct dig_foreign_dig *const dig,
                           struct dig_error *const error)
{
    (void)error;
    struct seen *const s = context;
    assert_true(s->digs < 4);
    s->dig[s->digs]   = *dig;
    s->first[s->digs] = dig->recording.row[0];
    s->last[s->digs]  = dig->recording.row[dig->recording.rows - 1];
    s->digs++;
    return DIG_OK;
}

#define HEAD                                                                                       \
    "scene: rig.yaml\nengine: sensor\nversion: '3'\ncolumns:\n"                                    \
    "  friction: {column: mu}\n  rolling: {value: .25}\n  density_kgpm3: {column: rho, factor: "   \
    "1000}\n  trajectory: {column: dig}\n  t_s: {column: ms, factor: .001}\n  Fx_N: {column: X}\n" \
    "  Fz_N: {column: Z}\n"

static struct dig_curve_map map_of(const char *const text)
{
    struct dig_curve_map map;
    struct dig_error     error = { "" };
    assert_ok(dig_curve_map_read(scratch_write("map.yaml", text), &map, &error), error);
    return map;
}

static enum dig_status read_text(const char *const csv, const struct dig_curve_map *const map,
                                 struct seen *const seen, struct dig_error *const error)
{
    const struct dig_foreign_visitor visitor = { see, seen };
    return dig_curves_read(scratch_write("curves.csv", csv), map, &visitor, error);
}

// What is good.
static struct seen digs_of(const char *const csv, const struct dig_curve_map *const map)
{
    struct seen      seen  = { .digs = 0 };
    struct dig_error error = { "" };
    assert_ok(read_text(csv, map, &seen, &error), error);
    return seen;
}

TEST(the_example_of_the_formats_loads_as_it_is_written)
{
    struct dig_curve_map map;
    assert_int_equal(dig_curve_map_read("tests/data/formats/curve_map.yaml", &map, NULL), DIG_OK);
    assert_string_equal(map.scene, "tests/data/formats/scene.yaml");
    assert_string_equal(map.engine, "kernel");
    assert_string_equal(map.version, "imported");
    assert_string_equal(map.field[DIG_MAP_TRAJECTORY].value, "scrape");
    assert_string_equal(map.field[DIG_MAP_CARRIED_kg].column, "carried_kg");
    assert_close(map.field[DIG_MAP_FX_N].factor, 1.0, 0.0);
}

TEST(the_example_of_curves_is_two_digs)
{
    struct dig_curve_map             map;
    struct seen                      seen    = { .digs = 0 };
    struct dig_error                 error   = { "" };
    const struct dig_foreign_visitor visitor = { see, &seen };
    assert_int_equal(dig_curve_map_read("tests/data/formats/curve_map.yaml", &map, NULL), DIG_OK);
    assert_ok(dig_curves_read("tests/data/formats/curves.csv", &map, &visitor, &error), error);
    assert_int_equal(seen.digs, 2);
    for (size_t d = 0; d < 2; d++) {
        assert_close(seen.dig[d].gravel.value[DIG_AXIS_FRICTION], 0.3, 1e-12);
        assert_close(seen.dig[d].gravel.value[DIG_AXIS_ROLLING], d == 0 ? 0.1 : 0.2, 1e-12);
        assert_string_equal(seen.dig[d].trajectory, "scrape");
        assert_true(seen.last[d].t_s > seen.first[d].t_s + 1.0);
    }
}

TEST(columns_are_found_scaled_and_cut_into_digs)
{
    const struct dig_curve_map map  = map_of(HEAD "  My_Nm: {column: torque, factor: -1}\n");
    const struct seen          seen = digs_of("# from a rig\nnotes,dig,mu,rho,ms,torque,X,Z\r\n"
                                                       "a,pull,.3,2.5,0,-1,10,-20\n"
                                                       "b,pull,.3,2.5,5,-2,11,-21\n\n"
                                                       "c, push ,.3,2.5,0,-3,12,-22\n"
                                                       "d,push,.5,2.5,0,-4,13,-23\n",
                                              &map);
    assert_int_equal(seen.digs, 3);
    assert_int_equal(seen.dig[0].recording.rows, 2);
    assert_int_equal(seen.dig[1].recording.rows, 1);
    assert_string_equal(seen.dig[0].trajectory, "pull");
    assert_string_equal(seen.dig[1].trajectory, "push");
    assert_int_equal(seen.dig[1].line, 6);
    assert_close(seen.dig[2].gravel.value[DIG_AXIS_FRICTION], .5, 0.0);
    assert_close(seen.dig[0].gravel.value[DIG_AXIS_ROLLING], .25, 0.0);
    assert_close(seen.dig[0].gravel.value[DIG_AXIS_DENSITY_kgpm3], 2500.0, 0.0);
    assert_int_equal(seen.dig[0].packing, 0);
    assert_close(seen.last[0].t_s, 0.005, 1e-15);
    assert_close(seen.last[0].My_Nm, 2.0, 0.0);
    assert_close(seen.first[1].Fx_N, 12.0, 0.0);
    assert_close(seen.first[2].Fz_N, -23.0, 0.0);
    assert_true(isnan(seen.first[0].carried_kg));
}

TEST(a_dig_may_be_deeper_or_turned)
{
    const struct dig_curve_map map = map_of(
        HEAD
        "  My_Nm: {column: torque}\n  depth: {column: deep, factor: .5}\n  attack_deg: {column: "
        "turn}\n");
    const struct seen seen = digs_of("dig,mu,rho,ms,torque,X,Z,deep,turn\n"
                                     "pull,.3,2.5,0,1,1,1,,\n"
                                     "pull,.3,2.5,5,1,1,1,2,0\n"
                                     "pull,.3,2.5,0,1,1,1,2.4,0\n"
                                     "pull,.3,2.5,0,1,1,1,2.4,-30\n",
                                     &map);
    // No depth is depth 1: the first two lines are one dig.
    assert_int_equal(seen.digs, 3);
    assert_int_equal(seen.dig[0].recording.rows, 2);
    assert_true(dig_approach_is_plain(&seen.dig[0].approach));
    assert_close(seen.dig[1].approach.depth, 1.2, 1e-12);
    assert_close(seen.dig[1].approach.attack_rad, 0.0, 0.0);
    assert_close(seen.dig[2].approach.depth, 1.2, 1e-12);
    assert_close(seen.dig[2].approach.attack_rad, -0.5235987755983, 1e-12);
}

TEST(what_does_not_fit_the_map_is_refused_by_its_line)
{
    const struct dig_curve_map map =
        map_of(HEAD "  My_Nm: {column: torque}\n  packing: {column: rep}\n");
    static const char *const bad[][2] = {
        { "dig,mu,rho,ms,X,Z,rep\n",
          ":1: column torque: missing, expected a header of mu, rho, dig, ms, torque" },
        { "dig,mu,rho,ms,torque,X,Z,rep\npull,.3,2.5,0,1,1\n",
          ":2: column Z: the line has 6 fields, expected 8 as in the header" },
        { "dig,mu,rho,ms,torque,X,Z,rep\npull,.3,2.5,0,nan,1,1,0\n",
          ":2: column torque: \"nan\", expected a finite number" },
        { "dig,mu,rho,ms,torque,X,Z,rep\npull,.3,,0,1,1,1,0\n",
          ":2: column rho: \"\", expected a finite number" },
        { "dig,mu,rho,ms,torque,X,Z,rep\npull,.3,2.5,0,1,1,1,.5\n",
          ":2: column rep: 0.5, expected a whole number from 0" },
        { "dig,mu,rho,ms,torque,X,Z,rep\n$(pull),.3,2.5,0,1,1,1,0\n",
          ":2: column dig: \"$(pull)\", expected a name of letters" },
        { "dig,mu,rho,ms,torque,X,Z,rep\n,.3,2.5,0,1,1,1,0\n",
          ":2: column dig: \"\", expected a name" },
        { "dig,mu,rho,ms,torque,X,Z,rep\npull,.3,2.5,5,1,1,1,0\npull,.3,2.5,0,1,1,1,0\n",
          ":3: column ms: 0 after 0.005 in one dig, expected ascending time" },
        { "dig,mu,rho,ms,torque,X,Z,rep\n", ":1: no row of numbers, expected a header of mu," },
        { "", ":1: no header, expected a header of mu," },
        { "dig,mu,rho,ms,torque,X,Z,rep,mu\n", ":1: column mu: given twice, expected once" },
    };
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        struct seen      seen  = { .digs = 0 };
        struct dig_error error = { "" };
        assert_refused(read_text(bad[i][0], &map, &seen, &error), error, DIG_EINVAL, bad[i][1]);
        assert_int_equal(seen.digs, 0);
    }
}

TEST(a_depth_or_attack_that_cannot_be_is_refused_by_its_line)
{
    const struct dig_curve_map map =
        map_of(HEAD "  My_Nm: {value: 1}\n  depth: {column: deep}\n  attack_deg: {column: turn}\n");
    static const char *const bad[][2] = {
        { "0.1,0", ":3: column deep: 0.1, expected a factor of 0.2 to 3" },
        { "0,0", ":3: column deep: 0, expected a factor of 0.2 to 3" },
        { "3.5,0", ":3: column deep: 3.5, expected a factor of 0.2 to 3" },
        { "1,-46", ":3: column turn: -46, expected -45 to 45 deg" },
        { "1,45.1", ":3: column turn: 45.1, expected -45 to 45 deg" },
        { "1,steep", ":3: column turn: \"steep\", expected a finite number" },
        { "inf,0", ":3: column deep: \"inf\", expected a finite number" },
    };
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        char             csv[256];
        struct seen      seen  = { .digs = 0 };
        struct dig_error error = { "" };
        (void)snprintf(
            csv, sizeof csv,
            "dig,mu,rho,ms,X,Z,deep,turn\npull,.3,2.5,0,1,1,1,45\npull,.3,2.5,5,1,1,%s\n",
            bad[i][0]);
        assert_refused(read_text(csv, &map, &seen, &error), error, DIG_EINVAL, bad[i][1]);
    }
}

TEST(what_is_no_map_is_refused_by_its_key)
{
    static const char *const bad[][2] = {
        { HEAD, "columns.My_Nm: missing" },
        { HEAD "  My_Nm: {factor: 2}\n",
          ":12: columns.My_Nm: expected either a column or a value" },
        { HEAD "  My_Nm: {column: a, value: 3}\n", "columns.My_Nm: expected either a column or" },
        { "scene: a\nengine: b\nversion: c\ncolumns:\n  friction: {value: 1}\n  rolling: {value: "
          "1}\n"
          "  density_kgpm3: {value: 1}\n  trajectory: {value: a}\n  t_s: {value: 1}\n"
          "  My_Nm: {value: 1}\n  Fx_N: {value: 1}\n  Fz_N: {value: 1}\n",
          ":9: columns.t_s: a value, expected a column" },
        { HEAD "  My_Nm: {column: a}\n  Mz_Nm: {column: b}\n", "columns.Mz_Nm: unknown key" },
    };
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        struct dig_curve_map map;
        struct dig_error     error = { "" };
        assert_refused(dig_curve_map_read(scratch_write("map.yaml", bad[i][0]), &map, &error),
                       error, DIG_EINVAL, bad[i][1]);
    }
}

TESTS_WITH(scratch_setup, scratch_teardown)

// Tests for tools/rig/motion/path.c and tools/rig/motion/blend.c

#include "tools/rig/motion/path.h"

#include "core/units.h"
#include "tests/testlib.h"

#include <stdlib.h>

// A dig with one corner: down for a second, then level for a second, loaded all the time.
#define ROWS 401
static struct dig_force_row rows[ROWS];

static struct dig_recording cornered(void)
{
    for (int i = 0; i < ROWS; i++) {
        const double t_s = 0.005 * i;
        rows[i]          = (struct dig_force_row){
                     .t_s       = t_s,
                     .pin_x_m   = 0.2 + (t_s < 1.0 ? 0.0 : 0.05 * (t_s - 1.0)),
                     .pin_z_m   = 0.16 - 0.04 * (t_s < 1.0 ? t_s : 1.0),
                     .theta_deg = -20.0,
                     .Fx_N      = -10.0 * t_s,
                     .Fz_N      = 4.0 * t_s,
                     .My_Nm     = 0.7 * t_s,
        };
    }
    return (struct dig_recording){ .rows = ROWS, .row = rows };
}

static struct dig_rig_path build(const struct dig_rig_path_options options)
{
    const struct dig_recording recording = cornered();
    struct dig_rig_path        path;
    struct dig_error           error = { "" };
    assert_ok(dig_rig_path_build(&options, 1, &recording, &path, &error), error);
    return path;
}

TEST(dig_is_scaled_by_froude_and_mirrored)
{
    const double        lambda = 4.0;
    struct dig_rig_path path =
        build((struct dig_rig_path_options){ .lambda = lambda, .tooth_m = 0.36 });
    // Twice as long in time; 1.5 s of the rig are 3 s here.
    assert_int_equal(path.frames, 4001);
    const struct dig_rig_frame *const f = &path.frame[3000];
    assert_close(f->pose.X_m, -4.0 * 0.025, 1e-9); // towards the cab
    assert_close(f->pose.Z_m, -4.0 * 0.04, 1e-9);
    assert_close(f->pose.phi_rad, -70.0 * DIG_RAD_PER_DEG, 1e-12);
    assert_close(f->soil.FX_N, 64.0 * 15.0, 1e-6); // lambda^3, mirrored
    assert_close(f->soil.FZ_N, 64.0 * 6.0, 1e-6);
    assert_close(f->soil.M_Nm, 256.0 * 0.7 * 1.5, 1e-6); // lambda^4, as it stands
    dig_rig_path_finish(&path);
}

static size_t first_loaded(const struct dig_rig_path *const path)
{
    size_t i = 0;
    while (i < path->frames && fabs(path->frame[i].soil.FX_N) < 1e-12) {
        i++;
    }
    return i;
}

TEST(air_lies_before_contact_and_after_the_dump)
{
    struct dig_rig_path path  = build((struct dig_rig_path_options){
         .lambda = 10.0, .tooth_m = 0.9, .air = true, .air_pace = 1.0, .blend = true });
    const size_t        first = first_loaded(&path);
    assert_true((double)first * DIG_RIG_STEP_s >= 2.0);

    // Never below the surface before contact: the tooth starts on it.
    const double surface_m = 0.9 * sin(path.contact_phi_rad);
    for (size_t i = 0; i + 5 < first; i++) {
        const struct dig_rig_pose *const p = &path.frame[i].pose;
        assert_true(p->Z_m + 0.9 * sin(p->phi_rad) > surface_m - 0.002);
    }

    size_t last = path.frames - 1;
    while (fabs(path.frame[last].soil.FX_N) < 1e-12) {
        last--;
    }
    assert_true((double)(path.frames - 1 - last) * DIG_RIG_STEP_s >= 2.0);
    // Both air motions turn the bucket there and back, so that its weight can be seen.
    double most  = -10.0;
    double least = 10.0;
    for (size_t i = last; i < path.frames; i++) {
        most  = fmax(most, path.frame[i].pose.phi_rad);
        least = fmin(least, path.frame[i].pose.phi_rad);
    }
    assert_true(most - least > 0.3);
    // It ends where it began, to be played in a loop.
    assert_close(path.frame[path.frames - 1].pose.X_m, path.frame[0].pose.X_m, 1e-6);
    assert_close(path.frame[path.frames - 1].pose.Z_m, path.frame[0].pose.Z_m, 1e-6);
    dig_rig_path_finish(&path);
}

TEST(load_fades_without_a_jump_while_the_bucket_dumps)
{
    struct dig_rig_path path  = build((struct dig_rig_path_options){
         .lambda = 10.0, .tooth_m = 0.9, .air = true, .air_pace = 1.0, .blend = true });
    const size_t        first = first_loaded(&path);
    for (size_t i = first + 10000; i < path.frames; i++) {
        const double step_N = fabs(path.frame[i].soil.FX_N - path.frame[i - 1].soil.FX_N);
        assert_true(step_N <= 20e3 * 2.0 * DIG_RIG_STEP_s); // at most 20 kN fading in 1.5 s
    }
    dig_rig_path_finish(&path);
}

static double speed_step(const struct dig_rig_path *const path, const size_t i)
{
    const struct dig_rig_frame *const f = path->frame;
    const double X = f[i + 1].pose.X_m - 2.0 * f[i].pose.X_m + f[i - 1].pose.X_m;
    const double Z = f[i + 1].pose.Z_m - 2.0 * f[i].pose.Z_m + f[i - 1].pose.Z_m;
    return hypot(X, Z) / DIG_RIG_STEP_s;
}

TEST(blend_removes_velocity_jumps_and_stays_within_its_bound)
{
    const struct dig_rig_path_options sharp = { .lambda = 10.0, .tooth_m = 0.9 };
    struct dig_rig_path_options       round = sharp;
    round.blend                             = true;
    struct dig_rig_path a                   = build(sharp);
    struct dig_rig_path b                   = build(round);
    const size_t        corner              = (size_t)lround(sqrt(10.0) / DIG_RIG_STEP_s);

    // Speeds are the rig's times sqrt(lambda); the corner turns from one to the other.
    const double jump_mps = sqrt(10.0) * hypot(0.05, 0.04);
    double       worst_m  = 0.0;
    double       most_a   = 0.0;
    double       most_b   = 0.0;
    for (size_t i = corner - 300; i < corner + 300; i++) {
        most_a  = fmax(most_a, speed_step(&a, i));
        most_b  = fmax(most_b, speed_step(&b, i));
        worst_m = fmax(worst_m, hypot(a.frame[i].pose.X_m - b.frame[i].pose.X_m,
                                      a.frame[i].pose.Z_m - b.frame[i].pose.Z_m));
    }
    assert_true(most_a > 0.5 * jump_mps);
    assert_true(most_b < 0.02 * jump_mps);
    assert_true(worst_m < DIG_RIG_BLEND_s / 12.0 * jump_mps);
    assert_true(worst_m > 0.5 * DIG_RIG_BLEND_s / 12.0 * jump_mps);
    assert_true(b.blend_off_m >= worst_m - 1e-12);

    // Even, straight motion is left alone, and so are the forces.
    for (size_t i = 300; i < corner - 300; i++) {
        assert_close(b.frame[i].pose.Z_m, a.frame[i].pose.Z_m, 1e-10);
        assert_close(b.frame[i].soil.M_Nm, a.frame[i].soil.M_Nm, 0.0);
    }
    dig_rig_path_finish(&a);
    dig_rig_path_finish(&b);
}

TEST(two_digs_lie_in_one_bed_with_air_between)
{
    const struct dig_recording  one   = cornered();
    struct dig_force_row *const moved = malloc(sizeof rows);
    assert_non_null(moved);
    for (int i = 0; i < ROWS; i++) {
        moved[i] = rows[i];
        moved[i].pin_x_m += 0.03;
    }
    const struct dig_recording        both[]  = { one, { .rows = ROWS, .row = moved } };
    const struct dig_rig_path_options options = {
        .lambda = 10.0, .tooth_m = 0.9, .air = true, .air_pace = 1.0
    };
    struct dig_rig_path path;
    struct dig_error    error = { "" };
    assert_int_equal(dig_rig_path_build(&options, 2, both, &path, &error), DIG_OK);

    // The second contact is where the load rises from nothing for the second time.
    int    contacts = 0;
    size_t at[2]    = { 0, 0 };
    size_t empty    = 0;
    for (size_t i = 0; i < path.frames; i++) {
        const bool loaded = fabs(path.frame[i].soil.FX_N) > 1e-9;
        if (loaded && empty > 1000) {
            assert_true(contacts < 2);
            assert_true((double)empty * DIG_RIG_STEP_s >= 2.0);
            at[contacts++] = i;
        }
        empty = loaded ? 0 : empty + 1;
    }
    assert_int_equal(contacts, 2);
    assert_close(path.frame[at[1]].pose.X_m - path.frame[at[0]].pose.X_m, -0.3, 1e-3);
    assert_close(path.frame[at[1]].pose.Z_m, path.frame[at[0]].pose.Z_m, 1e-3);
    dig_rig_path_finish(&path);
    free(moved);
}

TEST(bad_requests_are_refused_and_write_nothing)
{
    const struct dig_recording        good[2] = { cornered(), cornered() };
    const struct dig_recording        shorty  = { .rows = 1, .row = rows };
    const struct dig_rig_path_options air     = {
            .lambda = 10.0, .tooth_m = 0.9, .air = true, .air_pace = 1.0
    };
    const struct dig_rig_path_options no_air = { .lambda = 10.0, .tooth_m = 0.9 };
    const struct dig_rig_path_options bad[]  = {
         { .lambda = 0.0, .tooth_m = 0.9 },
         { .lambda = -1.0, .tooth_m = 0.9 },
         { .lambda = NAN, .tooth_m = 0.9 },
         { .lambda = 10.0, .tooth_m = 0.0 },
    };
    struct dig_rig_path path  = { .frames = 42 };
    struct dig_error    error = { "" };
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        assert_int_equal(dig_rig_path_build(&bad[i], 1, good, &path, &error), DIG_EINVAL);
    }
    assert_int_equal(dig_rig_path_build(&air, 0, good, &path, &error), DIG_EINVAL);
    assert_int_equal(dig_rig_path_build(&air, 1, &shorty, &path, &error), DIG_EINVAL);
    assert_int_equal(dig_rig_path_build(&no_air, 2, good, &path, &error), DIG_EINVAL);
    assert_int_equal(path.frames, 42);
    assert_true(error.text[0] != '\0');
}

#include "offline_dem/world/obstacles.h"

#include "core/units.h"
#include "offline_dem/law/period.h"

#include <math.h>
#include <string.h>

// Margin of a rock: a share of its smallest half edge, and so many steps of its speed.
#define MARGIN_SHARE 0.008
#define MARGIN_STEPS 20

static struct dig_rock make_rock(const struct dig_obstacle *const o)
{
    struct dig_rock rock = { .surface = { .shape = o->shape, .q = { 1.0 } },
                             .movable = o->movable };
    const bool      box  = o->shape == DIG_OBSTACLE_BOX;
    for (size_t k = 0; k < 3; k++) {
        rock.surface.half_m[k] = 0.5 * o->size_m[box ? k : 0];
        rock.surface.x_m[k]    = o->centre_m[k];
    }
    const double *const h  = rock.surface.half_m;
    const double        m3 = box ? 8.0 * h[0] * h[1] * h[2] : DIG_PI / 0.75 * h[0] * h[0] * h[0];
    rock.mass_kg           = o->movable ? o->density_kgpm3 * m3 : 0.0;
    return rock;
}

struct dig_obstacles dig_obstacles_make(const struct dig_scene *const scene)
{
    struct dig_obstacles made = { .rocks = scene->bed.obstacles };
    for (size_t i = 0; i < made.rocks; i++) {
        made.rock[i] = make_rock(&scene->bed.obstacle[i]);
    }
    return made;
}

void dig_obstacles_load_poses(struct dig_obstacles *const obstacles,
                              const struct dig_bed *const bed)
{
    for (size_t i = 0; i < obstacles->rocks && i < bed->rocks; i++) {
        memcpy(obstacles->rock[i].surface.x_m, bed->rock[i].x_m, sizeof bed->rock[i].x_m);
        memcpy(obstacles->rock[i].surface.q, bed->rock[i].q, sizeof bed->rock[i].q);
    }
}

void dig_obstacles_save_poses(const struct dig_obstacles *const obstacles,
                              struct dig_bed *const             bed)
{
    bed->rocks = obstacles->rocks;
    for (size_t i = 0; i < obstacles->rocks; i++) {
        memcpy(bed->rock[i].x_m, obstacles->rock[i].surface.x_m, sizeof bed->rock[i].x_m);
        memcpy(bed->rock[i].q, obstacles->rock[i].surface.q, sizeof bed->rock[i].q);
    }
}

double dig_rock_least_half_m(const struct dig_rock_surface *const rock)
{
    const double *const h = rock->half_m;
    return rock->shape == DIG_OBSTACLE_BOX ? fmin(h[0], fmin(h[1], h[2])) : h[0];
}

// Image of a grain nearest to the rock along y.
static void nearest_image(const struct dig_world *const        world,
                          const struct dig_rock_surface *const rock, const double x_m[],
                          double image_m[3])
{
    const double y_m = rock->x_m[1];
    memcpy(image_m, x_m, 3 * sizeof *image_m);
    if (world->period_y_m > 0.0) {
        image_m[1] = y_m + dig_period_fold(x_m[1] - y_m, world->period_y_m,
                                           dig_period_inverse(world->period_y_m));
    }
}

static double length(const double v[3])
{
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

// Lever by which a rotation moves the surface.
static double turning_radius_m(const struct dig_rock_surface *const rock)
{
    return rock->shape == DIG_OBSTACLE_BOX ? length(rock->half_m) : 0.0;
}

void dig_obstacles_set_margins(struct dig_obstacles *const o, const double dt_s)
{
    for (size_t r = 0; r < o->rocks; r++) {
        const struct dig_rock *const rock    = &o->rock[r];
        const double                 least_m = dig_rock_least_half_m(&rock->surface);
        const double                 speed_mps =
            length(rock->v_mps) + turning_radius_m(&rock->surface) * length(rock->w_radps);
        o->reference[r] = rock->surface;
        o->margin_m[r] =
            rock->movable ? MARGIN_SHARE * least_m + MARGIN_STEPS * dt_s * speed_mps : 0.0;
    }
}

bool dig_obstacles_left_margin(const struct dig_obstacles *const o)
{
    for (size_t r = 0; r < o->rocks; r++) {
        const struct dig_rock_surface *const now = &o->rock[r].surface;
        const double *const                  x   = o->reference[r].x_m;
        const double *const                  q   = o->reference[r].q;
        const double d[3]   = { now->x_m[0] - x[0], now->x_m[1] - x[1], now->x_m[2] - x[2] };
        const double cosine = now->q[0] * q[0] + now->q[1] * q[1] + now->q[2] * q[2] +
                              now->q[3] * q[3]; // of half the angle it has turned
        const double chord = 2.0 * sqrt(fmax(0.0, 1.0 - cosine * cosine));
        // Negated, so that a position that is not a number counts as having left.
        if (o->rock[r].movable && !(length(d) + chord * turning_radius_m(now) <= o->margin_m[r])) {
            return true;
        }
    }
    return false;
}

bool dig_obstacles_is_near(const struct dig_obstacles *const o, const struct dig_world *const world,
                           const size_t rock, const double x_m[], const double reach_m)
{
    double closest_m[3];
    double image_m[3];
    nearest_image(world, &o->rock[rock].surface, x_m, image_m);
    return dig_rock_surface_closest(&o->rock[rock].surface, image_m, closest_m) <
           reach_m + o->margin_m[rock];
}

void dig_obstacles_separation(const struct dig_world *const world,
                              const struct dig_rock *const rock, const double x_m[],
                              const double radius_m, double d_m[3], double arm_m[3],
                              double v_mps[3])
{
    double closest_m[3];
    double image_m[3];
    nearest_image(world, &rock->surface, x_m, image_m);
    dig_rock_surface_separation(&rock->surface, image_m, radius_m, closest_m, d_m);
    for (int k = 0; k < 3; k++) {
        arm_m[k] = closest_m[k] - rock->surface.x_m[k];
    }
    const double *const w = rock->w_radps;
    for (int k = 0; k < 3; k++) {
        v_mps[k] = rock->v_mps[k] + w[(k + 1) % 3] * arm_m[(k + 2) % 3] -
                   w[(k + 2) % 3] * arm_m[(k + 1) % 3];
    }
}

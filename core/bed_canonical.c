#include "core/bed_plan.h"

#include "core/text.h"

enum { SIZE = DIG_SCENE_TEXT_SIZE };

static void write_laws(const struct dig_laws *const laws, char text[const SIZE])
{
    static const char *const normal[]  = { "hooke", "hertz" };
    static const char *const rolling[] = { "epsd2", "cdt", "none" };
    if (laws->normal != DIG_NORMAL_HOOKE) {
        dig_text_add(SIZE, text, "normal=%s\n", normal[laws->normal]);
    }
    if (laws->rolling != DIG_ROLLING_EPSD2) {
        dig_text_add(SIZE, text, "rolling=%s\n", rolling[laws->rolling]);
    }
    if (laws->cohesion_Jpm3 > 0.0) {
        dig_text_add(SIZE, text, "cohesion_Jpm3=%.17g\n", laws->cohesion_Jpm3);
    }
    if (laws->adhesion_Jpm3 > 0.0) {
        dig_text_add(SIZE, text, "adhesion_Jpm3=%.17g\n", laws->adhesion_Jpm3);
    }
    if (laws->bucket_smoothness > 0.0) {
        dig_text_add(SIZE, text, "bucket_smoothness=%.17g\n", laws->bucket_smoothness);
    }
}

static void write_materials(const struct dig_bed_plan *const bed, char text[const SIZE])
{
    for (size_t i = 0; i < bed->sizes; i++) {
        dig_text_add(SIZE, text, "size=%.17g %.17g\n", bed->size[i].diameter_m,
                     bed->size[i].mass_fraction);
    }
    for (size_t i = 0; i < bed->materials; i++) {
        const struct dig_other_material *const m = &bed->material[i];
        dig_text_add(SIZE, text, "other=%s %.17g %.17g %.17g %.17g\n", m->name, m->friction,
                     m->rolling, m->density_kgpm3, m->restitution);
    }
    for (size_t i = 0; i < bed->pairs; i++) {
        const struct dig_material_pair *const p = &bed->pair[i];
        dig_text_add(SIZE, text, "pair=%zu %zu %.17g %.17g %.17g\n", p->a, p->b, p->friction,
                     p->rolling, p->restitution);
    }
    for (size_t i = 0; i < bed->layers; i++) {
        const struct dig_layer *const layer = &bed->layer[i];
        dig_text_add(SIZE, text, "layer=%zu %.17g %.17g\n", layer->material, layer->from_m,
                     layer->to_m);
    }
}

static void write_shapes(const struct dig_bed_plan *const bed, char text[const SIZE])
{
    for (size_t i = 0; i < bed->surface; i++) {
        dig_text_add(SIZE, text, "surface_m=%.17g %.17g\n", bed->surface_x_m[i],
                     bed->surface_z_m[i]);
    }
    for (size_t k = 0; k < bed->profiles; k++) {
        const struct dig_ground_profile *const p = &bed->profile[k];
        dig_text_add(SIZE, text, "ground_y_m=%.17g\n", p->y_m);
        for (size_t i = 0; i < p->points; i++) {
            dig_text_add(SIZE, text, "ground_m=%zu %.17g %.17g\n", k, p->x_m[i], p->z_m[i]);
        }
    }
    for (size_t i = 0; i < bed->clump.spheres; i++) {
        const struct dig_clump *const c = &bed->clump;
        dig_text_add(SIZE, text, "clump=%.17g %.17g %.17g %.17g\n", c->x[i], c->y[i], c->z[i],
                     c->radius[i]);
    }
    for (size_t i = 0; i < bed->obstacles; i++) {
        const struct dig_obstacle *const o = &bed->obstacle[i];
        dig_text_add(SIZE, text, "obstacle=%s %s %.17g %.17g %.17g %.17g %.17g %.17g %.17g\n",
                     o->shape == DIG_OBSTACLE_BOX ? "box" : "sphere",
                     o->movable ? "movable" : "fixed", o->centre_m[0], o->centre_m[1],
                     o->centre_m[2], o->size_m[0], o->size_m[1], o->size_m[2], o->density_kgpm3);
    }
}

void dig_bed_plan_canonical(const struct dig_scene *const scene, char text[const SIZE])
{
    const struct dig_bed_plan *const bed = &scene->bed;
    write_laws(&scene->laws, text);
    write_materials(bed, text);
    write_shapes(bed, text);
    if (bed->periodic_y) {
        dig_text_add(SIZE, text, "periodic_y\n");
    }
    if (bed->preload_Pa > 0.0) {
        dig_text_add(SIZE, text, "preload_Pa=%.17g\n", bed->preload_Pa);
    }
    if (bed->earlier_digs > 0) {
        dig_text_add(SIZE, text, "earlier=%zu %s %s\n", bed->earlier_digs,
                     bed->earlier_as_dug ? "as_dug" : "levelled", bed->earlier);
    }
}

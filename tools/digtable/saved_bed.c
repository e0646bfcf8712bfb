#include "tools/digtable/saved_bed.h"

#include "files/bed_csv.h"

enum dig_status dig_cli_bed_fits_file(const struct dig_scene *const scene,
                                      struct dig_error *const       error)
{
    for (size_t i = 0; i < scene->bed.obstacles; i++) {
        if (scene->bed.obstacle[i].movable) {
            return dig_error_set(error, DIG_EINVAL,
                                 "bed.obstacles[%zu].movable: a bed file does not hold where a "
                                 "rock has come to lie, expected fixed rocks",
                                 i);
        }
    }
    return DIG_OK;
}

enum dig_status dig_cli_bed_read(const char *const path, const struct dig_scene *const scene,
                                 struct dig_bed *const bed, struct dig_error *const error)
{
    enum dig_status status = dig_cli_bed_fits_file(scene, error);
    if (status != DIG_OK) {
        return status;
    }
    struct dig_bed read;
    status = dig_bed_read(path, &read, error);
    if (status != DIG_OK) {
        return status;
    }
    if (scene->bed.layers > 0 && read.material == NULL) {
        dig_bed_finish(&read);
        return dig_error_set(
            error, DIG_EINVAL,
            "%s:1: column material: missing, expected one, as the scene has layers", path);
    }
    *bed = read;
    return DIG_OK;
}

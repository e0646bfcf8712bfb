// What ships, read for a test, which fails with the reader's words where it cannot be.

#ifndef DIG_TESTS_READ_H
#define DIG_TESTS_READ_H

#include "files/machine_yaml.h"
#include "files/recording_csv.h"
#include "files/scene_yaml.h"
#include "tests/testlib.h"

#include <stdio.h>

/// That of config/machines/NAME.yaml.
static inline struct dig_machine read_machine(const char *const name)
{
    char               path[200];
    struct dig_machine machine;
    struct dig_error   error = { "" };
    (void)snprintf(path, sizeof path, "config/machines/%s.yaml", name);
    assert_ok(dig_machine_read(path, &machine, &error), error);
    return machine;
}

static inline struct dig_scene read_scene(const char *const path)
{
    struct dig_scene scene;
    struct dig_error error = { "" };
    assert_ok(dig_scene_read(path, &scene, &error), error);
    return scene;
}

/// Free with dig_recording_finish().
static inline struct dig_recording read_recording(const char *const path)
{
    struct dig_recording recording;
    struct dig_error     error = { "" };
    assert_ok(dig_recording_read(path, &recording, &error), error);
    return recording;
}

#endif // DIG_TESTS_READ_H

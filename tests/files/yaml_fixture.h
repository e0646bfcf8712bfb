// What the tests of YAML files share: the examples of docs/formats with a word changed, and what a
// reader must say of them.

#ifndef DIG_TESTS_YAML_FIXTURE_H
#define DIG_TESTS_YAML_FIXTURE_H

#include "tests/read.h"
#include "tests/scratch.h"

#include <ctype.h>

/// The text with the first `from`, which must be there, replaced; malloc'ed.
static inline char *yaml_with(const char *const text, const char *const from, const char *const to)
{
    const char *const at = strstr(text, from);
    assert_non_null(at);
    const size_t size = strlen(text) + strlen(to) + 1;
    char *const  out  = malloc(size);
    assert_non_null(out);
    (void)snprintf(out, size, "%.*s%s%s", (int)(at - text), text, to, at + strlen(from));
    return out;
}

/// Each of the changes { from, to, says } to the example by itself is refused. expect_refusal fails
/// unless the text, written as bad.yaml, is refused with these words and nothing is written.
static inline void
yaml_refuses_each(const char *const example, const size_t changes, const char *const change[][3],
                  void (*const expect_refusal)(const char *text, const char *says))
{
    size_t      size = 0;
    char *const text = scratch_read(example, &size);
    for (size_t i = 0; i < changes; i++) {
        char *const other = yaml_with(text, change[i][0], change[i][1]);
        expect_refusal(other, change[i][2]);
        free(other);
    }
    free(text);
}

/// Each key of the example in turn is spelled wrongly: an unknown key is found by its own line.
static inline void yaml_knows_every_key(const char *const example,
                                        void (*const expect_refusal)(const char *text,
                                                                     const char *says))
{
    size_t      size = 0;
    char *const text = scratch_read(example, &size);
    int         line = 1, keys = 0;
    for (size_t i = 0; i + 1 < size; i++) {
        line += text[i] == '\n';
        if (text[i + 1] != ':' || !isalnum((unsigned char)text[i])) {
            continue;
        }
        const char kept = text[i];
        text[i]         = 'Q';
        char where[32];
        (void)snprintf(where, sizeof where, "bad.yaml:%d: ", line);
        expect_refusal(text, where);
        text[i] = kept;
        keys++;
    }
    assert_true(keys > 0);
    free(text);
}

/// Reads every YAML file of a folder that is shipped; there is one at least.
static inline void yaml_loads_all(const char *const folder, void (*const load)(const char *path))
{
    DIR *const dir = opendir(folder);
    assert_non_null(dir);
    int files = 0;
    for (struct dirent *entry; (entry = readdir(dir)) != NULL;) {
        if (strstr(entry->d_name, ".yaml") != NULL) {
            char path[512];
            (void)snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
            load(path);
            files++;
        }
    }
    (void)closedir(dir);
    assert_true(files > 0);
}

static inline void yaml_scene_hash(const char *const text, char hex[const 65])
{
    const struct dig_scene scene = read_scene(scratch_write("scene.yaml", text));
    dig_scene_hash(&scene, hex);
}

/// Each of the changes { from, to } to the example by itself makes a scene of another identity, or
/// of the same.
static inline void yaml_scene_differs_by_each(const char *const example, const size_t changes,
                                              const char *const change[][2], const bool differs)
{
    size_t      size = 0;
    char *const text = scratch_read(example, &size);
    char        before[65], after[65];
    yaml_scene_hash(text, before);
    for (size_t i = 0; i < changes; i++) {
        char *const other = yaml_with(text, change[i][0], change[i][1]);
        yaml_scene_hash(other, after);
        if ((strcmp(before, after) != 0) != differs) {
            fail_msg("\"%s\": the identity %s", change[i][1], differs ? "stays" : "changes");
        }
        free(other);
    }
    free(text);
}

/// What expect_refusal is for scenes.
static inline void yaml_scene_refused(const char *const text, const char *const says)
{
    struct dig_error error = { "" };
    struct dig_scene scene;
    memset(&scene, 0x5a, sizeof scene);
    const struct dig_scene untouched = scene;
    assert_int_equal(dig_scene_read(scratch_write("bad.yaml", text), &scene, &error), DIG_EINVAL);
    assert_memory_equal(&scene, &untouched, sizeof scene);
    assert_contains(error.text, says);
    assert_contains(error.text, "expected");
}

#endif // DIG_TESTS_YAML_FIXTURE_H

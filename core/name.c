#include "core/name.h"

#include "core/text.h"

#include <assert.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

static const char name_characters[] =
    "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_.-";

static bool of_name(const char c)
{
    return c != '\0' && strchr(name_characters, c) != NULL;
}

bool dig_name_ok(const char *const name)
{
    assert(name != NULL);
    return of_name(name[0]) && name[0] != '.' && name[0] != '-' &&
           name[strspn(name, name_characters)] == '\0';
}

bool dig_label_ok(const char *const label)
{
    assert(label != NULL);
    if (!of_name(label[0]) || label[0] == '.' || label[0] == '-' || label[0] == '_') {
        return false;
    }
    const char *c = label;
    while (of_name(*c) || (*c != '\0' && strchr(" +:/()", *c) != NULL)) {
        c++;
    }
    return *c == '\0' && c[-1] != ' ';
}

bool dig_path_ok(const char *const path)
{
    assert(path != NULL);
    const char *c = path;
    for (size_t n; (n = dig_text_character(c)) > 0 && strchr("\t\n", *c) == NULL;) {
        c += n;
    }
    return *c == '\0' && c > path;
}

bool dig_path_stays(const char *const path)
{
    assert(path != NULL);
    bool up = false;
    for (const char *part = path; path[0] != '/' && part != NULL;) {
        const char *const end = strchr(part, '/');
        up                    = up || strcmp(part, "..") == 0 || strncmp(part, "../", 3) == 0;
        part                  = end != NULL ? end + 1 : NULL;
    }
    return !up;
}

const char *dig_path_last(const char *const path)
{
    assert(path != NULL);
    const char *const slash = strrchr(path, '/');
    return slash != NULL ? slash + 1 : path;
}

bool dig_path_beside(const char *const beside, const char *const name, const size_t size,
                     char path[])
{
    assert(beside != NULL && name != NULL && path != NULL);
    const int folder = name[0] == '/' ? 0 : (int)(dig_path_last(beside) - beside);
    const int length = snprintf(path, size, "%.*s%s", folder, beside, name);
    return length >= 0 && (size_t)length < size;
}

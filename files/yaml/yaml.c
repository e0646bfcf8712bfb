#include "files/yaml/yaml.h"

#include "files/text/whole.h"
#include "files/yaml/yaml_tree.h"

#include <assert.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static enum dig_status open_document(const char *const path, yaml_document_t *const document,
                                     struct dig_error *const error)
{
    char           *text   = NULL;
    size_t          size   = 0;
    enum dig_status status = dig_file_read(path, &text, &size, error);
    if (status == DIG_OK) {
        status = dig_yaml_parse(path, text, size, document, error);
    }
    free(text);
    return status;
}

// text: of a refusal, which begins with a key. The line is that of its value, or of the deepest
// mapping on the way to it.
static enum dig_status refuse(const char *const path, yaml_document_t *const document,
                              const enum dig_status status, const char *const text,
                              struct dig_error *const error)
{
    char key[128];
    int  found = 0;
    (void)snprintf(key, sizeof key, "%.*s", (int)strcspn(text, ": "), text);
    const yaml_node_t *const node = document != NULL ? dig_yaml_find(document, key, &found) : NULL;
    return dig_error_set(error, status, "%s:%d: %.400s", path,
                         node != NULL ? dig_yaml_line_of(node) : 1, text);
}

static enum dig_status load(const char *const path, yaml_document_t *const document,
                            const struct dig_yaml_file *const schema, void *const loaded,
                            struct dig_error *const error)
{
    if (schema->defaults != NULL) {
        memcpy(loaded, schema->defaults, schema->size);
    }
    struct dig_c_locale   locale = dig_c_locale_enter();
    const enum dig_status status = dig_yaml_load(path, document, schema->of, loaded, error);
    dig_c_locale_leave(&locale);
    return status;
}

enum dig_status dig_yaml_read(const char *const path, const struct dig_yaml_file *const schema,
                              void (*const take)(const char *, void *, struct dig_conditions *),
                              void *const into, struct dig_error *const error)
{
    assert(path != NULL && schema != NULL && into != NULL);
    yaml_document_t document;
    enum dig_status status = open_document(path, &document, error);
    if (status != DIG_OK) {
        return status;
    }
    void *const loaded = calloc(1, schema->size);
    status             = loaded == NULL ? dig_error_set(error, DIG_ENOMEM, "%s: no memory", path)
                                        : load(path, &document, schema, loaded, error);
    if (status == DIG_OK && loaded != NULL) {
        struct dig_error      found = { "" };
        struct dig_conditions c     = { .error = &found };
        take(path, loaded, &c);
        if (c.status == DIG_OK) {
            memcpy(into, loaded, schema->kept > 0 ? schema->kept : schema->size);
        } else {
            status = refuse(path, &document, c.status, found.text, error);
        }
    }
    free(loaded);
    yaml_document_delete(&document);
    return status;
}

int dig_yaml_line(const char *const path, const char *const key)
{
    assert(path != NULL && key != NULL);
    yaml_document_t document;
    int             found = 0;
    int             line  = 0;
    if (open_document(path, &document, NULL) == DIG_OK) {
        const yaml_node_t *const node = dig_yaml_find(&document, key, &found);
        line                          = found ? dig_yaml_line_of(node) : 0;
        yaml_document_delete(&document);
    }
    return line;
}

enum dig_status dig_yaml_refuse(const char *const path, struct dig_error *const error,
                                const char *const format, ...)
{
    struct dig_error what;
    yaml_document_t  document;
    va_list          args;
    va_start(args, format);
    (void)vsnprintf(what.text, sizeof what.text, format, args);
    va_end(args);
    const bool open = open_document(path, &document, NULL) == DIG_OK;
    (void)refuse(path, open ? &document : NULL, DIG_EINVAL, what.text, error);
    if (open) {
        yaml_document_delete(&document);
    }
    return DIG_EINVAL;
}

enum dig_status dig_yaml_tell_namer(const char *const path, const char *const key,
                                    const enum dig_status status, struct dig_error *const error)
{
    if (status == DIG_EIO && error != NULL) {
        const struct dig_error found = *error;
        (void)dig_yaml_refuse(path, error, "%s: %.350s", key, found.text);
    }
    return status;
}

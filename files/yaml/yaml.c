#include "files/yaml/yaml.h"

#include "files/text/whole.h"
#include "files/yaml/yaml_tree.h"

#include <assert.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// libcyaml's own words, for what dig_yaml_check() let through.
struct log {
    char   text[300];
    size_t used;
};

__attribute__((format(printf, 3, 0))) static void
collect_log(const cyaml_log_t level, void *const context, const char *const format, va_list args)
{
    struct log *const log = context;
    (void)level;
    if (log->used + 1 < sizeof log->text) {
        const int n = vsnprintf(log->text + log->used, sizeof log->text - log->used, format, args);
        log->used += n > 0 ? (size_t)n : 0;
    }
}

static enum dig_status load_text(const char *const path, const char *const text, const size_t size,
                                 const cyaml_schema_value_t *const schema,
                                 cyaml_data_t **const data, struct dig_error *const error)
{
    struct log           log    = { .used = 0 };
    const cyaml_config_t config = {
        .log_fn    = collect_log,
        .log_ctx   = &log,
        .mem_fn    = cyaml_mem,
        .log_level = CYAML_LOG_ERROR,
        .flags     = CYAML_CFG_DEFAULT,
    };
    cyaml_data_t     *loaded = NULL;
    const cyaml_err_t err =
        cyaml_load_data((const uint8_t *)text, size, &config, schema, &loaded, NULL);
    if (err == CYAML_OK) {
        *data = loaded;
        return DIG_OK;
    }
    for (char *c = log.text; *c != '\0'; c++) {
        if (*c == '\n') {
            *c = ' ';
        }
    }
    return dig_error_set(error, err == CYAML_ERR_OOM ? DIG_ENOMEM : DIG_EINVAL, "%s:1: %s: %s",
                         path, cyaml_strerror(err), log.text);
}

static enum dig_status load(const char *const path, const cyaml_schema_value_t *const schema,
                            cyaml_data_t **const data, struct dig_error *const error)
{
    char           *text   = NULL;
    size_t          size   = 0;
    enum dig_status status = dig_file_read(path, &text, &size, error);
    if (status != DIG_OK) {
        return status;
    }
    struct dig_c_locale locale = dig_c_locale_enter();
    yaml_document_t     document;
    status = dig_yaml_parse(path, text, size, &document, error);
    if (status == DIG_OK) {
        status = dig_yaml_check(path, &document, schema, error);
        yaml_document_delete(&document);
    }
    if (status == DIG_OK) {
        status = load_text(path, text, size, schema, data, error);
    }
    dig_c_locale_leave(&locale);
    free(text);
    return status;
}

// The line of the value at key, or of the deepest mapping on the way to it.
static int nearest_line(const char *const path, const char *const key, int *const found)
{
    char           *text = NULL;
    size_t          size = 0;
    yaml_document_t document;
    *found = 0;
    if (dig_file_read(path, &text, &size, NULL) != DIG_OK) {
        return 0;
    }
    int line = 0;
    if (dig_yaml_parse(path, text, size, &document, NULL) == DIG_OK) {
        const yaml_node_t *const node = dig_yaml_find(&document, key, found);
        line                          = node != NULL ? (int)node->start_mark.line + 1 : 0;
        yaml_document_delete(&document);
    }
    free(text);
    return line;
}

// text: of a refusal, which begins with a key.
static enum dig_status tell_line(const char *const path, const enum dig_status status,
                                 const char *const text, struct dig_error *const error)
{
    char key[128];
    (void)snprintf(key, sizeof key, "%.*s", (int)strcspn(text, ": "), text);
    int       at   = 0;
    const int line = nearest_line(path, key, &at);
    return dig_error_set(error, status, "%s:%d: %.400s", path, line > 0 ? line : 1, text);
}

enum dig_status dig_yaml_read(const char *const path, const cyaml_schema_value_t *const schema,
                              void (*const take)(const char *, cyaml_data_t *, void *,
                                                 struct dig_conditions *),
                              void *const into, struct dig_error *const error)
{
    assert(path != NULL && schema != NULL && into != NULL);
    const cyaml_config_t config = { .mem_fn = cyaml_mem, .flags = CYAML_CFG_DEFAULT };
    cyaml_data_t        *data   = NULL;
    enum dig_status      status = load(path, schema, &data, error);
    if (status == DIG_OK) {
        struct dig_error      found = { "" };
        struct dig_conditions c     = { .error = &found };
        take(path, data, into, &c);
        status = c.status != DIG_OK ? tell_line(path, c.status, found.text, error) : DIG_OK;
        (void)cyaml_free(&config, schema, data, 0);
    }
    return status;
}

int dig_yaml_line(const char *const path, const char *const key)
{
    assert(path != NULL && key != NULL);
    int       found = 0;
    const int line  = nearest_line(path, key, &found);
    return found ? line : 0;
}

enum dig_status dig_yaml_refuse(const char *const path, struct dig_error *const error,
                                const char *const format, ...)
{
    struct dig_error what;
    va_list          args;
    va_start(args, format);
    (void)vsnprintf(what.text, sizeof what.text, format, args);
    va_end(args);
    return tell_line(path, DIG_EINVAL, what.text, error);
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

void dig_yaml_check_ranges(const char *const at, const size_t count,
                           const struct dig_yaml_range range[], struct dig_conditions *const c)
{
    for (size_t i = 0; i < count; i++) {
        dig_require(c, range[i].value >= range[i].least && range[i].value <= range[i].most,
                    "%s%s%s: %g, expected %g … %g", at, at[0] != '\0' ? "." : "", range[i].key,
                    range[i].value, range[i].least, range[i].most);
    }
}

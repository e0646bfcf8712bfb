#include "core/error.h"

#include "core/text.h"

#include <assert.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

enum dig_status dig_error_set(struct dig_error *const error, const enum dig_status status,
                              const char *const format, ...)
{
    assert(format != NULL);
    if (error != NULL) {
        va_list args;
        va_start(args, format);
        (void)vsnprintf(error->text, sizeof error->text, format, args);
        va_end(args);
        // It quotes what files hold: that may neither begin a line of its own nor move the cursor.
        dig_text_clean(error->text);
        for (char *c = error->text; (c = strpbrk(c, "\n\t")) != NULL;) {
            *c = '?';
        }
    }
    return status;
}

enum dig_status dig_error_name(struct dig_error *const error, const enum dig_status status,
                               const char *const format, ...)
{
    if (error != NULL && status != DIG_OK) {
        const struct dig_error found = *error;
        char                   name[sizeof found.text];
        va_list                args;
        va_start(args, format);
        (void)vsnprintf(name, sizeof name, format, args);
        va_end(args);
        (void)dig_error_set(error, status, "%s: %s", name, found.text);
    }
    return status;
}

void dig_require(struct dig_conditions *const conditions, const bool holds,
                 const char *const format, ...)
{
    assert(conditions != NULL && format != NULL);
    if (!holds && conditions->status == DIG_OK) {
        struct dig_error what;
        va_list          args;
        va_start(args, format);
        (void)vsnprintf(what.text, sizeof what.text, format, args);
        va_end(args);
        conditions->status = dig_error_set(conditions->error, DIG_EINVAL, "%s", what.text);
    }
}

#include "core/canonical.h"

#include <assert.h>
#include <stdarg.h>
#include <stdio.h>

void dig_canonical_add(struct dig_canonical *const text, const char *const format, ...)
{
    char *const  to   = text->length < text->size ? text->at + text->length : NULL;
    const size_t left = to != NULL ? text->size - text->length : 0;
    va_list      args;
    va_start(args, format);
    const int wrote = vsnprintf(to, left, format, args);
    va_end(args);
    assert(wrote >= 0);
    text->length += (size_t)wrote;
}

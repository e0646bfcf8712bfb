#include "core/text.h"

#include <assert.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

// The bytes that a character beginning with c has; 0: none begins so.
static size_t length_of(const unsigned char c)
{
    if (c < 0x80) {
        return 1;
    }
    if (c < 0xc2 || c > 0xf4) {
        return 0;
    }
    return c < 0xe0 ? 2 : c < 0xf0 ? 3 : 4;
}

// Written longer than needed, half of a surrogate pair, or beyond U+10FFFF.
static bool is_no_code_point(const unsigned char c[])
{
    return (c[0] == 0xe0 && c[1] < 0xa0) || (c[0] == 0xf0 && c[1] < 0x90) ||
           (c[0] == 0xed && c[1] >= 0xa0) || (c[0] == 0xf4 && c[1] >= 0x90);
}

static bool is_control(const unsigned char c[])
{
    return (c[0] < 0x20 && c[0] != '\n' && c[0] != '\t') || c[0] == 0x7f ||
           (c[0] == 0xc2 && c[1] < 0xa0);
}

// Those that turn a line's direction make it read as another; U+FFFE and U+FFFF are none.
static bool is_no_text(const unsigned char c[])
{
    if (c[0] == 0xe2) {
        return (c[1] == 0x80 && c[2] >= 0xaa && c[2] <= 0xae) ||
               (c[1] == 0x81 && c[2] >= 0xa6 && c[2] <= 0xa9);
    }
    return c[0] == 0xef && c[1] == 0xbf && c[2] >= 0xbe;
}

size_t dig_text_character(const char *const text)
{
    assert(text != NULL);
    const unsigned char *const c = (const unsigned char *)text;
    const size_t               n = length_of(c[0]);
    for (size_t i = 1; i < n; i++) {
        if ((c[i] & 0xc0) != 0x80) {
            return 0;
        }
    }
    return n == 0 || is_no_code_point(c) || is_control(c) || is_no_text(c) ? 0 : n;
}

void dig_text_clean(char text[])
{
    assert(text != NULL);
    for (char *c = text; *c != '\0';) {
        const size_t n = dig_text_character(c);
        if (n == 0) {
            *c = '?';
        }
        c += n == 0 ? 1 : n;
    }
}

void dig_text_copy(const size_t size, char to[], const char *const text)
{
    assert(size > 0 && to != NULL && text != NULL);
    (void)snprintf(to, size, "%s", text);
    dig_text_clean(to);
}

void dig_text_list(const size_t size, char list[], const char *const word)
{
    assert(list != NULL && word != NULL);
    dig_text_add(size, list, "%s%s", list[0] == '\0' ? "" : ", ", word);
}

void dig_text_add(const size_t size, char text[], const char *const format, ...)
{
    assert(text != NULL && format != NULL);
    const size_t used = strlen(text);
    assert(used < size);
    va_list args;
    va_start(args, format);
    (void)vsnprintf(text + used, size - used, format, args);
    va_end(args);
}

bool dig_text_number(const char *const text, double *const value)
{
    assert(text != NULL && value != NULL);
    char        *end    = NULL;
    const double number = strtod(text, &end);
    if (text[strspn(text, "0123456789+-.eE")] != '\0' || end == text || *end != '\0' ||
        !isfinite(number)) {
        return false;
    }
    *value = number;
    return true;
}

void dig_text_utc(const int64_t unix_s, const size_t size, char text[const])
{
    assert(text != NULL && size > 0);
    const time_t seconds = (time_t)unix_s;
    struct tm    utc;
    if (gmtime_r(&seconds, &utc) == NULL || strftime(text, size, "%Y-%m-%dT%H:%M:%SZ", &utc) == 0) {
        text[0] = '\0';
    }
}

int dig_text_line(const char *const text, const size_t at)
{
    int line = 1;
    for (size_t i = 0; i < at; i++) {
        line += text[i] == '\n';
    }
    return line;
}

void dig_text_put(FILE *const to, const char *const text)
{
    assert(to != NULL && text != NULL);
    for (const char *c = text; *c != '\0';) {
        const size_t n = *c == '\n' || *c == '\t' ? 0 : dig_text_character(c);
        if (n == 0) {
            (void)fputc('?', to);
        } else {
            (void)fwrite(c, 1, n, to);
        }
        c += n == 0 ? 1 : n;
    }
}

void dig_text_print(FILE *const to, const char *const format, ...)
{
    assert(to != NULL && format != NULL);
    char    text[8192];
    va_list args;
    va_start(args, format);
    (void)vsnprintf(text, sizeof text, format, args);
    va_end(args);
    dig_text_clean(text);
    (void)fputs(text, to);
}

void dig_text_put_json(FILE *const to, const char *const text)
{
    assert(to != NULL && text != NULL);
    (void)fputc('"', to);
    for (const char *c = text; *c != '\0';) {
        const unsigned char *const byte = (const unsigned char *)c;
        const size_t               n    = dig_text_character(c);
        const bool c1 = byte[0] == 0xc2 && (byte[1] & 0xe0) == 0x80; // U+0080 to U+009F
        if (*c == '"' || *c == '\\') {
            (void)fprintf(to, "\\%c", *c);
        } else if (byte[0] < 0x20 || byte[0] == 0x7f || c1) {
            (void)fprintf(to, "\\u%04x", c1 ? byte[1] : byte[0]);
        } else if (n == 0) {
            (void)fputs("\xef\xbf\xbd", to);
        } else {
            (void)fwrite(c, 1, n, to);
        }
        c += c1 ? 2 : n == 0 ? 1 : n;
    }
    (void)fputc('"', to);
}

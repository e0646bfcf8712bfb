#include "core/shell.h"

#include "core/text.h"

#include <assert.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

// What is being written, as far as there is room.
struct line {
    size_t size, length;
    char  *text;
};

static void add(struct line *const line, const char *const text, const size_t length)
{
    for (size_t i = 0; i < length; i++, line->length++) {
        if (line->length + 1 < line->size) {
            line->text[line->length] = text[i];
        }
    }
}

static void add_text(struct line *const line, const char *const text)
{
    add(line, text, strlen(text));
}

// Between single quotes a shell reads everything as it stands, but for their end.
static void add_quoted(struct line *const line, const char *const word)
{
    add_text(line, "'");
    for (const char *c = word; *c != '\0';) {
        const size_t n = dig_text_character(c);
        if (*c == '\'') {
            add_text(line, "'\\''");
        } else if (n > 0) {
            add(line, c, n);
        } else {
            char byte[32];
            (void)snprintf(byte, sizeof byte, "'\"$(printf '\\%03o')\"'", (unsigned char)*c);
            add_text(line, byte);
        }
        c += n == 0 ? 1 : n;
    }
    add_text(line, "'");
}

size_t dig_shell_word(const char *const word, const size_t size, char text[])
{
    static const char plain[] =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./+-";
    assert(word != NULL && text != NULL && size > 0);
    struct line line = { .size = size, .text = text };
    if (word[0] != '\0' && word[strspn(word, plain)] == '\0') {
        add_text(&line, word);
    } else {
        add_quoted(&line, word);
    }
    text[line.length < size ? line.length : size - 1] = '\0';
    return line.length;
}

// is_json: exits 0 when standard input is one JSON value (RFC 8259) and nothing else, 1 otherwise.

#include <ctype.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

static int next_char(void)
{
    int c = getchar();
    while (c == ' ' || c == '\t' || c == '\n' || c == '\r') {
        c = getchar();
    }
    return c;
}

static bool word(const char *rest)
{
    for (; *rest != '\0'; rest++) {
        if (getchar() != *rest) {
            return false;
        }
    }
    return true;
}

// What follows the quote.
static bool string(void)
{
    for (int c = getchar(); c != '"'; c = getchar()) {
        if (c < ' ') {
            return false;
        }
        if (c == '\\') {
            c = getchar();
            for (int i = 0; c == 'u' && i < 4; i++) {
                if (isxdigit(getchar()) == 0) {
                    return false;
                }
            }
            if (c == EOF || strchr("\"\\/bfnrtu", c) == NULL) {
                return false;
            }
        }
    }
    return true;
}

static int digits(int c, bool *const any)
{
    for (*any = false; isdigit(c) != 0; c = getchar()) {
        *any = true;
    }
    return c;
}

static bool number(int c)
{
    bool any = false;
    if (c == '-') {
        c = getchar();
    }
    const bool zero = c == '0';
    c               = zero ? getchar() : digits(c, &any);
    if (!zero && !any) {
        return false;
    }
    if (c == '.') {
        c = digits(getchar(), &any);
        if (!any) {
            return false;
        }
    }
    if (c == 'e' || c == 'E') {
        c = getchar();
        c = digits(c == '+' || c == '-' ? getchar() : c, &any);
        if (!any) {
            return false;
        }
    }
    (void)ungetc(c, stdin);
    return true;
}

static bool value(int c);

// What follows the bracket: with names in an object, without in an array.
// NOLINTNEXTLINE(misc-no-recursion): as deep as the text nests
static bool members(const char close, const bool named)
{
    int c = next_char();
    if (c == close) {
        return true;
    }
    for (;;) {
        if (named) {
            if (c != '"' || !string() || next_char() != ':') {
                return false;
            }
            c = next_char();
        }
        if (!value(c)) {
            return false;
        }
        c = next_char();
        if (c != ',') {
            return c == close;
        }
        c = next_char();
    }
}

// NOLINTNEXTLINE(misc-no-recursion): as deep as the text nests
static bool value(const int c)
{
    switch (c) {
    case '{': return members('}', true);
    case '[': return members(']', false);
    case '"': return string();
    case 't': return word("rue");
    case 'f': return word("alse");
    case 'n': return word("ull");
    default: return number(c);
    }
}

int main(void)
{
    return value(next_char()) && next_char() == EOF ? 0 : 1;
}

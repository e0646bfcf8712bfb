#include "core/did_you_mean.h"

#include <assert.h>
#include <stdio.h>
#include <string.h>

enum { LONGEST = 63 };

static size_t least(const size_t a, const size_t b)
{
    return a < b ? a : b;
}

// Edit distance with swaps of neighbours (optimal string alignment), row by row.
static size_t distance_of(const char *const a, const char *const b)
{
    const size_t m = strlen(a);
    const size_t n = strlen(b);
    size_t       row[3][LONGEST + 1];
    for (size_t k = 0; k <= n; k++) {
        row[0][k] = k;
    }
    for (size_t i = 1; i <= m; i++) {
        size_t *const       now    = row[i % 3];
        const size_t *const above  = row[(i + 2) % 3];
        const size_t *const above2 = row[(i + 1) % 3];
        now[0]                     = i;
        for (size_t k = 1; k <= n; k++) {
            const size_t replaced = above[k - 1] + (a[i - 1] != b[k - 1] ? 1 : 0);
            now[k]                = least(replaced, least(above[k], now[k - 1]) + 1);
            if (i > 1 && k > 1 && a[i - 1] == b[k - 2] && a[i - 2] == b[k - 1]) {
                now[k] = least(now[k], above2[k - 2] + 1);
            }
        }
    }
    return row[m % 3][n];
}

struct dig_guess dig_guess(const char *const word)
{
    assert(word != NULL);
    const size_t third = strlen(word) / 3;
    return (struct dig_guess){ .word = word, .distance = (third > 1 ? third : 1) + 1 };
}

void dig_guess_try(struct dig_guess *const guess, const char *const known)
{
    assert(guess != NULL && known != NULL);
    if (strlen(guess->word) > LONGEST || strlen(known) > LONGEST) {
        return;
    }
    const size_t distance = distance_of(guess->word, known);
    if (distance < guess->distance) {
        guess->best     = known;
        guess->distance = distance;
    }
}

const char *dig_guess_text(const struct dig_guess *const guess, const char *const before,
                           char text[const DIG_GUESS_SIZE])
{
    assert(guess != NULL && before != NULL && text != NULL);
    text[0] = '\0';
    if (guess->best != NULL) {
        (void)snprintf(text, DIG_GUESS_SIZE, ", did you mean \"%s%s\"?", before, guess->best);
    }
    return text;
}

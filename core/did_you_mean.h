// The known word that a wrong one was probably meant to be.

#ifndef DIG_CORE_DID_YOU_MEAN_H
#define DIG_CORE_DID_YOU_MEAN_H

#include <stddef.h>

/// Start with dig_guess(), try every known word, ask for the text.
struct dig_guess {
    const char *word;     // what was written; the caller's
    const char *best;     // the nearest known word so far, NULL: none is near enough
    size_t      distance; // letters to insert, delete, replace or swap with their neighbour
};

struct dig_guess dig_guess(const char *word);

/// Keeps known, which must outlive the guess, when it is nearer than those before. Near enough is a
/// third of the word's letters, at least one. Words of over 63 bytes are never guessed.
void dig_guess_try(struct dig_guess *guess, const char *known);

#define DIG_GUESS_SIZE 96

/// `, did you mean "BEFOREknown"?`, or "" without a guess; in text, which it returns.
const char *dig_guess_text(const struct dig_guess *guess, const char *before,
                           char text[DIG_GUESS_SIZE]);

#endif // DIG_CORE_DID_YOU_MEAN_H

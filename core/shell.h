// Words for a POSIX shell. Nothing of ours runs one; people paste what a report prints.

#ifndef DIG_CORE_SHELL_H
#define DIG_CORE_SHELL_H

#include <stddef.h>

/// Writes word so that any POSIX shell reads exactly its bytes back as one word: as it stands where
/// that is enough, else between quotes; a byte a terminal must not be shown as a printf of its
/// number. A word that begins with '-' is still an option of the program it is given to. Returns
/// the length that takes, as snprintf() does; text then holds the beginning, and is no word.
size_t dig_shell_word(const char *word, size_t size, char text[]);

#endif // DIG_CORE_SHELL_H

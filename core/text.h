// Text from elsewhere: which of it is a character, and what of it a terminal may be shown.

#ifndef DIG_CORE_TEXT_H
#define DIG_CORE_TEXT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/// The bytes of the printable UTF-8 character at text, 1 to 4; 0 where none begins: at a byte that
/// is not UTF-8, and at a control character, those from U+0080 to U+009F and those that turn the
/// direction of writing among them. A line break
/// and a tab count as printable.
size_t dig_text_character(const char *text);

/// Puts '?' in place of each byte that is none of a printable character, so that no escape sequence
/// reaches a terminal or a log.
void dig_text_clean(char text[]);

/// Copies text, cut to size, as dig_text_clean() makes it.
void dig_text_copy(size_t size, char to[], const char *text);

/// Puts word at the end of list, behind a comma where it is not the first; cut to size.
void dig_text_list(size_t size, char list[], const char *word);

/// A plain decimal number, all of text and finite; strtod() alone would take "nan", "inf" and
/// "0x1p3" as well. By the thread's locale. False leaves *value.
bool dig_text_number(const char *text, double *value);

/// Writes the time in UTC as ISO 8601 has it, "2026-01-31T12:00:00Z", which takes 21 bytes; "" of a
/// time beyond any year.
void dig_text_utc(int64_t unix_s, size_t size, char text[]);

/// The line, from 1, on which byte `at` of a text stands.
int dig_text_line(const char *text, size_t at);

/// Puts what fprintf() would print at the end of text; cut to size.
__attribute__((format(printf, 3, 4))) void dig_text_add(size_t size, char text[],
                                                        const char *format, ...);

/// text as dig_text_clean() makes it, and in one line: a line break or a tab becomes '?', too.
void dig_text_put(FILE *to, const char *text);

/// As fprintf(), for people at a terminal, of at most 8 KiB: what is printed is made as
/// dig_text_clean() makes it. Whatever quotes a file's name is printed so.
__attribute__((format(printf, 2, 3))) void dig_text_print(FILE *to, const char *format, ...);

/// text as a JSON string, with its quotes: valid JSON and UTF-8 whatever the bytes. Control
/// characters are escaped and come back; a byte that is no UTF-8 becomes U+FFFD.
void dig_text_put_json(FILE *to, const char *text);

#endif // DIG_CORE_TEXT_H

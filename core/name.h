// Rules for names. Names stand in tables, messages, pages, paths and shell lines, so few characters
// are allowed, which mean the same everywhere. Every reader of a file or message checks with these,
// and says where the name stands.

#ifndef DIG_CORE_NAME_H
#define DIG_CORE_NAME_H

#include <stdbool.h>
#include <stddef.h>

/// For "expected …" where one of these is false.
#define DIG_NAME_RULE "a name of letters, digits, '_', '.' and '-' that begins with none of . -"
#define DIG_LABEL_RULE                                                                             \
    "letters, digits, blanks and any of _ . - + : / ( ), beginning with a letter or digit"
#define DIG_PATH_RULE "a file's name without control characters"

/// Of a scene, trajectory, phase, material or signal: ASCII letters, digits, `_ . -`, not empty,
/// the first neither '.' nor '-', so that it is never `..` or an option. Its reader knows how long
/// it may be.
bool dig_name_ok(const char *name);

/// Of a machine, an engine, a version or a date, which are for people: a name's characters, blanks
/// within, and `+ : / ( )`.
bool dig_label_ok(const char *label);

/// Of a file: printable UTF-8 in one line, not empty.
bool dig_path_ok(const char *path);

/// True when a path that is not absolute has no `..` in it: it stays in the folder it is of.
bool dig_path_stays(const char *path);

/// What stands behind the last '/' of a path.
const char *dig_path_last(const char *path);

/// Puts the folder that the file `beside` lies in before a name, unless that is absolute. False
/// when the path is too long; it is cut off then.
bool dig_path_beside(const char *beside, const char *name, size_t size, char path[]);

#endif // DIG_CORE_NAME_H

// CSV: a header line that names the columns in any order, numbers in SI, `#` lines as comments, LF
// or CRLF. No quoting: no column of ours holds text.

#ifndef DIG_FILES_TEXT_CSV_H
#define DIG_FILES_TEXT_CSV_H

#include "core/error.h"

#include <stdbool.h>
#include <stddef.h>

#define DIG_CSV_COLUMNS_MAX 32

struct dig_csv_column {
    const char *name;
    bool        optional;  // the column may be absent
    bool        may_empty; // a field of it may be empty
    bool        text;      // of at most one: no number
};

/// value[row * columns + column], in the order of the columns asked for; NaN where the field is
/// empty or the column absent (a NaN in the file is refused) or a text. word[row] is the field of
/// the column that is a text, a part of text; line[row] is the row's line.
struct dig_csv {
    size_t       rows, columns;
    double      *value;
    int         *line;
    const char **word;
    char        *text;
};

/// What becomes of columns that are not asked for.
enum dig_csv_others { DIG_CSV_REFUSE_OTHERS, DIG_CSV_SKIP_OTHERS };

/// DIG_EINVAL: "FILE:LINE: column NAME: what was found, expected …": a column that is unknown,
/// missing or given twice, too few or too many fields, text, NaN or infinity where a number
/// belongs, an empty field that may not be, no row at all. Writes *csv on success only; free with
/// dig_csv_finish().
DIG_MUST_CHECK enum dig_status dig_csv_read(const char *path, enum dig_csv_others others,
                                            size_t columns, const struct dig_csv_column column[],
                                            struct dig_csv *csv, struct dig_error *error);

/// True when the header line of path names this column; false also when path cannot be read, which
/// dig_csv_read() says.
bool dig_csv_has(const char *path, const char *column);

void dig_csv_finish(struct dig_csv *csv);

#endif // DIG_FILES_TEXT_CSV_H

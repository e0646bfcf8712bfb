// strsep() is BSD's, not POSIX's.
#define _DEFAULT_SOURCE // NOLINT(bugprone-reserved-identifier)

#include "files/text/csv.h"

#include "core/regular.h"
#include "core/room.h"
#include "core/text.h"
#include "files/text/whole.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define ROWS_MAX   ((size_t)1 << 22) // half a day at 100 Hz
#define FIELDS_MAX 256               // of a line; what stands behind is skipped
#define ABSENT     FIELDS_MAX

// What is being read, and where the reader stands.
struct reader {
    const char                  *path;
    size_t                       columns;
    const struct dig_csv_column *column;
    enum dig_csv_others          others;
    struct dig_error            *error;
    int                          line;
    size_t                       fields;                  // in the header
    const char                  *header[FIELDS_MAX];      // its fields
    size_t                       at[DIG_CSV_COLUMNS_MAX]; // which of them a column is
    struct dig_csv               csv;
};

// Cuts the next line off *rest, without its end; NULL at the end of the text.
static char *next_line(char **const rest)
{
    char *const  line   = *rest != NULL && **rest != '\0' ? strsep(rest, "\n") : NULL;
    const size_t length = line != NULL ? strlen(line) : 0;
    if (length > 0 && line[length - 1] == '\r') {
        line[length - 1] = '\0';
    }
    return line;
}

// Cuts the next field off the rest of a line, without the blanks around it; NULL at its end.
static char *next_field(char **const rest)
{
    char *field = strsep(rest, ",");
    if (field == NULL) {
        return NULL;
    }
    field += strspn(field, " \t");
    size_t length = strlen(field);
    while (length > 0 && (field[length - 1] == ' ' || field[length - 1] == '\t')) {
        field[--length] = '\0';
    }
    return field;
}

static const char byte_order_mark[] = "\xef\xbb\xbf";

static bool is_comment_or_blank(const char *const line)
{
    const char first = line[strspn(line, " \t")];
    return first == '#' || first == '\0';
}

// The names asked for, for people: "t_s, pin_x_m, …".
static const char *names(const struct reader *const r, const size_t size, char text[const])
{
    text[0] = '\0';
    for (size_t i = 0; i < r->columns; i++) {
        dig_text_list(size, text, r->column[i].name);
    }
    return text;
}

// Cuts a line into fields; how many there are.
static size_t split(char *line, const char *field[const FIELDS_MAX])
{
    size_t n = 0;
    while (n < FIELDS_MAX && (field[n] = next_field(&line)) != NULL) {
        n++;
    }
    return n;
}

static enum dig_status read_header(struct reader *const r, char *const line)
{
    char known[256];
    for (size_t c = 0; c < r->columns; c++) {
        r->at[c] = ABSENT;
    }
    r->fields = split(line, r->header);
    for (size_t f = 0; f < r->fields; f++) {
        bool asked_for = r->others == DIG_CSV_SKIP_OTHERS;
        for (size_t c = 0; c < r->columns; c++) {
            if (strcmp(r->column[c].name, r->header[f]) != 0) {
                continue;
            }
            if (r->at[c] != ABSENT) {
                return dig_error_set(r->error, DIG_EINVAL,
                                     "%s:%d: column %s: given twice, expected once", r->path,
                                     r->line, r->header[f]);
            }
            r->at[c]  = f;
            asked_for = true;
        }
        if (!asked_for && strchr(r->header[f], ';') != NULL) {
            return dig_error_set(r->error, DIG_EINVAL,
                                 "%s:%d: semicolons between columns, expected commas and decimal "
                                 "points",
                                 r->path, r->line);
        }
        if (!asked_for) {
            return dig_error_set(r->error, DIG_EINVAL,
                                 "%s:%d: column \"%.40s\": unknown, expected a header of %s",
                                 r->path, r->line, r->header[f], names(r, sizeof known, known));
        }
    }
    for (size_t c = 0; c < r->columns; c++) {
        if (r->at[c] == ABSENT && !r->column[c].optional) {
            return dig_error_set(r->error, DIG_EINVAL,
                                 "%s:%d: column %s: missing, expected a header of %s", r->path,
                                 r->line, r->column[c].name, names(r, sizeof known, known));
        }
    }
    return DIG_OK;
}

static enum dig_status make_room(struct reader *const r)
{
    struct dig_csv *const csv = &r->csv;
    if (csv->rows >= ROWS_MAX) {
        return dig_error_set(r->error, DIG_EINVAL, "%s:%d: a row after %zu others, expected fewer",
                             r->path, r->line, ROWS_MAX);
    }
    double *const      value = dig_room(csv->value, csv->rows, r->columns * sizeof *value);
    int *const         line  = dig_room(csv->line, csv->rows, sizeof *line);
    const char **const word  = dig_room(csv->word, csv->rows, sizeof *word);
    csv->value               = value != NULL ? value : csv->value;
    csv->line                = line != NULL ? line : csv->line;
    csv->word                = word != NULL ? word : csv->word;
    return value != NULL && line != NULL && word != NULL
               ? DIG_OK
               : dig_error_set(r->error, DIG_ENOMEM, "%s: no memory for %zu rows", r->path,
                               csv->rows);
}

static enum dig_status read_row(struct reader *const r, char *const line)
{
    enum dig_status status = make_room(r);
    if (status != DIG_OK) {
        return status;
    }
    const char   *field[FIELDS_MAX];
    const size_t  fields = split(line, field);
    double *const row    = r->csv.value + r->csv.rows * r->columns;
    for (size_t c = 0; c < r->columns; c++) {
        const struct dig_csv_column *const column = &r->column[c];
        const char *const                  found  = r->at[c] < fields ? field[r->at[c]] : "";
        row[c]                                    = NAN;
        if (column->text) {
            r->csv.word[r->csv.rows] = found;
        } else if (r->at[c] < fields && !(found[0] == '\0' && column->may_empty) &&
                   !dig_text_number(found, &row[c])) {
            return dig_error_set(r->error, DIG_EINVAL,
                                 "%s:%d: column %s: \"%.40s\", expected a finite number", r->path,
                                 r->line, column->name, found);
        }
    }
    if (fields != r->fields) {
        return dig_error_set(r->error, DIG_EINVAL,
                             "%s:%d: column %s: the line has %zu fields, expected %zu as in the "
                             "header",
                             r->path, r->line,
                             fields < r->fields ? r->header[fields] : "after the last", fields,
                             r->fields);
    }
    r->csv.line[r->csv.rows++] = r->line;
    return DIG_OK;
}

static enum dig_status read_lines(struct reader *const r, char *text)
{
    // Spreadsheets put a byte-order mark first.
    if (strncmp(text, byte_order_mark, 3) == 0) {
        text += 3;
    }
    bool            header = false;
    enum dig_status status = DIG_OK;
    for (char *line; status == DIG_OK && (line = next_line(&text)) != NULL;) {
        r->line++;
        if (!is_comment_or_blank(line)) {
            status = header ? read_row(r, line) : read_header(r, line);
            header = true;
        }
    }
    if (status == DIG_OK && r->csv.rows == 0) {
        char known[256];
        return dig_error_set(r->error, DIG_EINVAL, "%s:%d: %s, expected a header of %s and rows",
                             r->path, r->line > 0 ? r->line : 1,
                             header ? "no row of numbers" : "no header",
                             names(r, sizeof known, known));
    }
    return status;
}

enum dig_status dig_csv_read(const char *const path, const enum dig_csv_others others,
                             const size_t columns, const struct dig_csv_column column[],
                             struct dig_csv *const csv, struct dig_error *const error)
{
    assert(path != NULL && columns > 0 && columns <= DIG_CSV_COLUMNS_MAX && csv != NULL);

    struct reader reader = {
        .path    = path,
        .columns = columns,
        .column  = column,
        .others  = others,
        .error   = error,
        .csv     = { .columns = columns },
    };
    size_t          size   = 0;
    enum dig_status status = dig_file_read(path, &reader.csv.text, &size, error);
    if (status != DIG_OK) {
        return status;
    }
    struct dig_c_locale locale = dig_c_locale_enter();
    status                     = read_lines(&reader, reader.csv.text);
    dig_c_locale_leave(&locale);
    if (status != DIG_OK) {
        dig_csv_finish(&reader.csv);
        return status;
    }
    *csv = reader.csv;
    return DIG_OK;
}

bool dig_csv_has(const char *const path, const char *const column)
{
    assert(path != NULL && column != NULL);
    FILE *file   = NULL;
    char *header = NULL;
    char  piece[8192]; // no header of ours is longer; of a longer line the rest is passed over
    if (dig_regular_open(path, &file, NULL) != DIG_OK) {
        return false;
    }
    for (bool begins = true, more = true;
         more && header == NULL && fgets(piece, sizeof piece, file);) {
        char *const  text   = strncmp(piece, byte_order_mark, 3) == 0 ? piece + 3 : piece;
        const size_t length = strlen(piece);
        const bool   ends   = length > 0 && piece[length - 1] == '\n';
        // Else it is the last line, or holds a NUL, which no text does.
        more                        = ends || length == sizeof piece - 1;
        text[strcspn(text, "\r\n")] = '\0';
        header                      = begins && !is_comment_or_blank(text) ? text : NULL;
        begins                      = ends;
    }
    bool has = false;
    for (const char *field; header != NULL && !has && (field = next_field(&header)) != NULL;) {
        has = strcmp(field, column) == 0;
    }
    (void)fclose(file);
    return has;
}

void dig_csv_finish(struct dig_csv *const csv)
{
    if (csv != NULL) {
        free(csv->value);
        free(csv->line);
        free(csv->word);
        free(csv->text);
        *csv = (struct dig_csv){ 0 };
    }
}

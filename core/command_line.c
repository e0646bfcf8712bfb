#include "core/command_line.h"

#include "core/did_you_mean.h"
#include "core/help.h"
#include "core/regular.h"
#include "core/streams.h"
#include "core/text.h"

#include <assert.h>
#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { OPTIONS_MAX = 48 };

static const struct dig_command *find_command(const struct dig_program *const program,
                                              const char *const name, struct dig_error *const error)
{
    const bool       needed    = program->commands > 0 && !program->alone;
    struct dig_guess guess     = dig_guess(name != NULL ? name : "");
    char             list[200] = "";
    for (size_t i = 0; i < program->commands; i++) {
        const char *const known = program->command[i].name;
        if (name != NULL && strcmp(known, name) == 0) {
            return &program->command[i];
        }
        dig_guess_try(&guess, known);
        dig_text_add(sizeof list, list, "%s%s",
                     i == 0                       ? ""
                     : i + 1 == program->commands ? " or "
                                                  : ", ",
                     known);
    }
    if (!needed || (name != NULL && name[0] == '-')) {
        return &program->self;
    }
    char text[DIG_GUESS_SIZE];
    if (name == NULL) {
        (void)dig_error_set(error, DIG_EINVAL, "expected a command: %s", list);
    } else if (guess.best != NULL) {
        (void)dig_error_set(error, DIG_EINVAL, "%s: unknown command%s", name,
                            dig_guess_text(&guess, "", text));
    } else {
        (void)dig_error_set(error, DIG_EINVAL, "%s: unknown command, expected %s", name, list);
    }
    return NULL;
}

// Says what is wrong with the option in word, which getopt did not take.
static void refuse(const struct dig_program *const program, const struct dig_command *const command,
                   const int found, const char *const word, struct dig_error *const error)
{
    const bool is_long  = strncmp(word, "--", 2) == 0;
    char       name[64] = { (char)optopt };
    if (is_long) {
        (void)snprintf(name, sizeof name, "%.*s", (int)strcspn(word + 2, "="), word + 2);
    }
    const char *const dashes = is_long ? "--" : "-";
    if (found == ':') {
        (void)dig_error_set(error, DIG_EINVAL, "%s%s: needs a value", dashes, name);
        return;
    }
    if (is_long && optopt != 0) {
        (void)dig_error_set(error, DIG_EINVAL, "%s: takes no value", word);
        return;
    }
    struct dig_guess guess = dig_guess(name);
    dig_guess_try(&guess, "help");
    dig_guess_try(&guess, "version");
    for (size_t i = 0; i < program->options; i++) {
        const struct dig_option *const o = &program->option[i];
        if (dig_option_belongs(o, command)) {
            dig_guess_try(&guess, o->name);
        } else if (is_long ? strcmp(o->name, name) == 0 : o->letter == optopt) {
            (void)dig_error_set(error, DIG_EINVAL, "%s takes no %s%s", command->name, dashes, name);
            return;
        }
    }
    char text[DIG_GUESS_SIZE] = "";
    (void)dig_error_set(error, DIG_EINVAL, "%s%s: unknown option%s", dashes, name,
                        is_long ? dig_guess_text(&guess, "--", text) : "");
}

// What the option says into its field.
static enum dig_status take(const struct dig_option *const o, const char *const value,
                            void *const into, struct dig_error *const error)
{
    void *const field = (char *)into + o->offset;
    const bool  any   = o->least >= o->most;
    bool        ok    = false;
    switch (o->kind) {
    case DIG_OPTION_CALL: return o->take(value, into, error);
    case DIG_OPTION_TEXT: *(const char **)field = value; return DIG_OK;
    case DIG_OPTION_FLAG: *(bool *)field = !o->clears; return DIG_OK;
    case DIG_OPTION_NUMBER: ok = dig_number_read(value, o->least, o->most, field); break;
    case DIG_OPTION_COUNT:
        ok = dig_count_read(value, (uint64_t)o->least, any ? UINT64_MAX : (uint64_t)o->most, field);
        break;
    }
    if (ok) {
        return DIG_OK;
    }
    return any ? dig_error_set(error, DIG_EINVAL, "--%s %s: expected a whole number", o->name,
                               value)
               : dig_error_set(error, DIG_EINVAL, "--%s %s: expected %g to %g%s%s", o->name, value,
                               o->least, o->most, o->unit != NULL ? " " : "",
                               o->unit != NULL ? o->unit : "");
}

// What getopt says of a short option is its letter, of a long one its row, from ROWS on.
enum { VERSION = 1, ROWS = 256 };

// What getopt is to know, and what it says of each of the program's.
struct known {
    struct option            option[OPTIONS_MAX + 3];
    char                     letters[2 * OPTIONS_MAX + 3];
    const struct dig_option *row[ROWS + OPTIONS_MAX];
};

static void list_options(const struct dig_program *const program,
                         const struct dig_command *const command, struct known *const known)
{
    size_t options = 2;
    *known         = (struct known){ .option  = { { "help", no_argument, NULL, 'h' },
                                                  { "version", no_argument, NULL, VERSION } },
                                     .letters = ":h" };
    for (size_t i = 0; i < program->options; i++) {
        const struct dig_option *const o = &program->option[i];
        if (!dig_option_belongs(o, command)) {
            continue;
        }
        known->option[options++] =
            (struct option){ o->name, o->value != NULL ? required_argument : no_argument, NULL,
                             ROWS + (int)i };
        known->row[ROWS + i] = o;
        if (o->letter != 0) {
            known->row[(unsigned char)o->letter] = o;
            dig_text_add(sizeof known->letters, known->letters, "%c%s", o->letter,
                         o->value != NULL ? ":" : "");
        }
    }
}

// The files that options name.
struct named {
    size_t      files;
    const char *path[OPTIONS_MAX];
    bool        written[OPTIONS_MAX];
};

static void note(const struct dig_option *const o, const char *const value,
                 struct named *const named)
{
    // "CURVE.csv", not "NAME". "-" is standard output, of which dig_out_is_stdout() tells.
    if (o->value != NULL && strchr(o->value, '.') != NULL && strcmp(value, "-") != 0 &&
        named->files < OPTIONS_MAX) {
        named->path[named->files]      = value;
        named->written[named->files++] = o->writes;
    }
}

// No input is written over, and no result by the next.
static enum dig_status check_written(const struct named *const named, char *const argv[const],
                                     struct dig_error *const error)
{
    for (size_t i = 0; i < named->files; i++) {
        const char *const to    = named->path[i];
        bool              again = false;
        for (size_t k = 0; named->written[i] && k < named->files; k++) {
            again = again || (k != i && dig_regular_same(to, named->path[k]));
        }
        for (size_t k = 0; named->written[i] && argv[k] != NULL; k++) {
            again = again || dig_regular_same(to, argv[k]);
        }
        if (again) {
            return dig_error_set(error, DIG_EINVAL,
                                 "%s: to be written, and named for something else, too; expected "
                                 "another name",
                                 to);
        }
    }
    return DIG_OK;
}

const struct dig_command *dig_options_read(const struct dig_program *const program, const int argc,
                                           char *argv[], void *const into,
                                           struct dig_error *const error)
{
    assert(program != NULL && program->options < OPTIONS_MAX && into != NULL);
    const struct dig_command *const command = find_command(program, argv[1], error);
    if (command == NULL) {
        return NULL;
    }
    struct known known;
    struct named named = { .files = 0 };
    list_options(program, command, &known);
    // getopt sees the command in the program's place, and begins anew with 0.
    const int skipped = command == &program->self ? 0 : 1;
    optind            = 0;
    opterr            = 0;
    for (int found; (found = getopt_long(argc - skipped, argv + skipped, known.letters,
                                         known.option, NULL)) != -1;) {
        if (found == 'h') {
            dig_help_print(program, command, stdout);
            exit(dig_streams_end(program->self.name, EXIT_SUCCESS));
        }
        if (found == VERSION) {
            (void)printf("%s %s\n", program->self.name, DIG_VERSION);
            exit(dig_streams_end(program->self.name, EXIT_SUCCESS));
        }
        if (found == '?' || found == ':') {
            refuse(program, command, found, argv[optind - 1 + skipped], error);
            return NULL;
        }
        const struct dig_option *const told = known.row[found];
        assert(told != NULL); // getopt says no other
        if (take(told, optarg, into, error) != DIG_OK) {
            return NULL;
        }
        note(told, optarg, &named);
    }
    optind += skipped;
    if (check_written(&named, argv + optind, error) != DIG_OK) {
        return NULL;
    }
    // Options alone are no command.
    return skipped == 0 ? find_command(program, NULL, error) : command;
}

void dig_options_refuse(const struct dig_program *const program, const char *const word,
                        const char *const wrong, FILE *const to)
{
    assert(program != NULL && wrong != NULL && to != NULL);
    const char *command = "";
    for (size_t i = 0; i < program->commands && word != NULL; i++) {
        if (strcmp(program->command[i].name, word) == 0) {
            command = word;
        }
    }
    dig_text_print(to, "%s: %s\nTry %s%s%s --help.\n", program->self.name, wrong,
                   program->self.name, command[0] != '\0' ? " " : "", command);
}

bool dig_number_read(const char *const text, const double least, const double most,
                     double *const value)
{
    assert(text != NULL && value != NULL);
    char        *end   = NULL;
    const double found = strtod(text, &end);
    if (end == text || *end != '\0' || !(found >= least && found <= most)) {
        return false;
    }
    *value = found;
    return true;
}

bool dig_count_read(const char *const text, const uint64_t least, const uint64_t most,
                    uint64_t *const value)
{
    assert(text != NULL && value != NULL);
    char                    *end   = NULL;
    const unsigned long long found = strtoull(text, &end, 10);
    if (text[0] < '0' || text[0] > '9' || *end != '\0' || found < least || found > most) {
        return false;
    }
    *value = found;
    return true;
}

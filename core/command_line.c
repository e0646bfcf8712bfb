#include "core/command_line.h"

#include "core/did_you_mean.h"
#include "core/text.h"

#include <assert.h>
#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { OPTIONS_MAX = 48 };

const struct dig_command *dig_command_find(const struct dig_program *const program,
                                           const char *const name, struct dig_error *const error)
{
    assert(program != NULL);
    if (name != NULL && name[0] == '-') {
        return &program->self;
    }
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

bool dig_option_belongs(const struct dig_option *const  option,
                        const struct dig_command *const command)
{
    assert(option != NULL && command != NULL);
    char word[32];
    (void)snprintf(word, sizeof word, " %s ", command->name);
    return option->commands == NULL || strstr(option->commands, word) != NULL;
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
        } else if (is_long ? strcmp(o->name, name) == 0 : o->id == optopt) {
            (void)dig_error_set(error, DIG_EINVAL, "%s takes no %s%s", command->name, dashes, name);
            return;
        }
    }
    char text[DIG_GUESS_SIZE] = "";
    (void)dig_error_set(error, DIG_EINVAL, "%s%s: unknown option%s", dashes, name,
                        is_long ? dig_guess_text(&guess, "--", text) : "");
}

int dig_option_next(const struct dig_program *const program,
                    const struct dig_command *const command, const int argc, char *argv[],
                    struct dig_error *const error)
{
    assert(program != NULL && command != NULL && program->options < OPTIONS_MAX);
    struct option known[OPTIONS_MAX + 2] = {
        { "help", no_argument, NULL, DIG_OPTION_HELP },
        { "version", no_argument, NULL, DIG_OPTION_VERSION },
    };
    char   letters[2 * OPTIONS_MAX + 3] = ":h";
    size_t options                      = 2;
    size_t used                         = strlen(letters);
    for (size_t i = 0; i < program->options; i++) {
        const struct dig_option *const o = &program->option[i];
        if (!dig_option_belongs(o, command)) {
            continue;
        }
        known[options++] =
            (struct option){ o->name, o->value != NULL ? required_argument : no_argument, NULL,
                             o->id };
        if (o->id < 256) {
            letters[used++] = (char)o->id;
            letters[used]   = ':';
            used += o->value != NULL ? 1 : 0;
        }
    }
    letters[used]  = '\0';
    known[options] = (struct option){ NULL, 0, NULL, 0 };
    // getopt sees the command in the program's place. It begins with 1, or with 0 to begin anew.
    const int skipped = command == &program->self ? 0 : 1;
    optind -= optind > 1 ? skipped : 0;
    opterr          = 0;
    const int found = getopt_long(argc - skipped, argv + skipped, letters, known, NULL);
    optind += skipped;
    if (found == '?' || found == ':') {
        refuse(program, command, found, argv[optind - 1], error);
        return DIG_OPTION_WRONG;
    }
    if (found == DIG_OPTION_END && command == &program->self && program->commands > 0 &&
        !program->alone) {
        (void)dig_command_find(program, NULL, error);
        return DIG_OPTION_WRONG;
    }
    return found;
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

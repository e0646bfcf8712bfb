#include "core/help.h"

#include <assert.h>
#include <stdbool.h>
#include <string.h>

enum { WIDTH = 79, OPTION_COLUMN = 28, COMMAND_COLUMN = 14 };

// Words from column `at` on, in lines that begin at `column`; a line break begins a new line.
static void put_words(FILE *const to, size_t at, const size_t column, const char *text)
{
    const char *gap = "";
    while (*text != '\0') {
        const size_t length = strcspn(text, " \n");
        if (*gap == ' ' && at + 1 + length > WIDTH) {
            gap = "\n";
        }
        if (*gap == '\n') {
            (void)fprintf(to, "\n%*s", (int)column, "");
            at = column;
        } else {
            (void)fputs(gap, to);
            at += strlen(gap);
        }
        (void)fprintf(to, "%.*s", (int)length, text);
        at += length;
        text += length;
        gap = *text == '\n' ? "\n" : " ";
        text += *text != '\0' ? 1 : 0;
    }
    (void)fputs("\n", to);
}

// A word in the left column, its text in the right one.
static void put_row(FILE *const to, const char *const left, const size_t column,
                    const char *const text)
{
    const size_t used = strlen(left);
    (void)fputs(left, to);
    if (used + 2 > column) {
        (void)fprintf(to, "\n%*s", (int)column, "");
    } else {
        (void)fprintf(to, "%*s", (int)(column - used), "");
    }
    put_words(to, column, column, text);
}

static void put_option(FILE *const to, const struct dig_option *const o)
{
    char left[80];
    char letter[8] = "    ";
    if (o->letter != 0) {
        (void)snprintf(letter, sizeof letter, "-%c, ", o->letter);
    }
    (void)snprintf(left, sizeof left, "  %s--%s%s%s", letter, o->name, o->value != NULL ? " " : "",
                   o->value != NULL ? o->value : "");
    put_row(to, left, OPTION_COLUMN, o->text);
}

// Lines, each behind an indent.
static void put_lines(FILE *const to, const char *const first, const char *const next,
                      const char *text)
{
    for (const char *before = first; *text != '\0'; before = next) {
        const size_t length = strcspn(text, "\n");
        (void)fprintf(to, "%s%.*s\n", before, (int)length, text);
        text += length + (text[length] == '\n' ? 1 : 0);
    }
}

bool dig_option_belongs(const struct dig_option *const  option,
                        const struct dig_command *const command)
{
    assert(option != NULL && command != NULL);
    char word[32];
    (void)snprintf(word, sizeof word, " %s ", command->name);
    return option->commands == NULL || strstr(option->commands, word) != NULL;
}

void dig_help_print(const struct dig_program *const program,
                    const struct dig_command *const command, FILE *const to)
{
    assert(program != NULL && command != NULL && to != NULL);
    const struct dig_command *const c   = command;
    const bool                      all = command == &program->self;
    char                            first[64];
    char                            next[64];
    (void)snprintf(first, sizeof first, "Usage: %s%s%s ", program->self.name, all ? "" : " ",
                   all ? "" : c->name);
    (void)snprintf(next, sizeof next, "  or:  %s", first + strlen("Usage: "));
    put_lines(to, first, next, c->usage);
    (void)fputs("\n", to);
    put_words(to, 0, 0, c->summary);
    if (c->text != NULL) {
        (void)fputs("\n", to);
        put_words(to, 0, 0, c->text);
    }
    if (all && program->commands > 0) {
        (void)fputs("\nCommands:\n", to);
        for (size_t i = 0; i < program->commands; i++) {
            char left[32];
            (void)snprintf(left, sizeof left, "  %s", program->command[i].name);
            put_row(to, left, COMMAND_COLUMN, program->command[i].summary);
        }
    }
    (void)fputs("\nOptions:\n", to);
    for (size_t i = 0; i < program->options && !(all && program->commands > 0 && !program->alone);
         i++) {
        if (dig_option_belongs(&program->option[i], c)) {
            put_option(to, &program->option[i]);
        }
    }
    put_option(to, &(struct dig_option){ .name   = "help",
                                         .letter = 'h',
                                         .text   = all && program->commands > 0
                                                       ? "this text; behind a command, the command's"
                                                       : "this text" });
    put_option(to, &(struct dig_option){ .name = "version", .text = "name and version" });
    (void)fputs("\nExamples:\n", to);
    put_lines(to, "  ", "  ", c->examples);
    (void)fputs("\nExit status:\n", to);
    put_lines(to, "  ", "  ", program->exit_status);
}

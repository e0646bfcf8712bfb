// Wide characters of curses are X/Open's, not POSIX's.
#define _XOPEN_SOURCE 700 // NOLINT(bugprone-reserved-identifier)

#include "tools/digwatch/terminal.h"

#include <assert.h>
#include <curses.h>
#include <fcntl.h>
#include <langinfo.h>
#include <locale.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static int silenced = -1; // standard error as it was; -1: not silenced

// What a library says there would stand in the middle of the screen.
static void silence_errors(void)
{
    const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
    silenced          = nowhere < 0 ? -1 : dup(STDERR_FILENO);
    if (silenced >= 0) {
        (void)dup2(nowhere, STDERR_FILENO);
    }
    if (nowhere >= 0) {
        (void)close(nowhere);
    }
}

void digwatch_terminal_close(void)
{
    if (stdscr != NULL && !isendwin()) {
        (void)endwin();
    }
    if (silenced >= 0) {
        (void)dup2(silenced, STDERR_FILENO);
        (void)close(silenced);
        silenced = -1;
    }
}

// Not safe in a signal handler by the letter; after a fault there is nothing to lose.
static void give_back(const int number)
{
    digwatch_terminal_close();
    (void)raise(number); // SA_RESETHAND: now it ends the program
}

static void start_colours(void)
{
    if (getenv("NO_COLOR") != NULL || !has_colors() || start_color() == ERR) {
        return;
    }
    (void)use_default_colors();
    (void)init_pair(DIGWATCH_MEASURED, COLOR_RED, -1);
    (void)init_pair(DIGWATCH_PREDICTED, COLOR_CYAN, -1);
    (void)init_pair(DIGWATCH_GOOD, COLOR_GREEN, -1);
    (void)init_pair(DIGWATCH_BAD, COLOR_YELLOW, -1);
}

enum dig_status digwatch_terminal_open(bool *const utf8, struct dig_error *const error)
{
    assert(utf8 != NULL);
    if (isatty(STDIN_FILENO) == 0 || isatty(STDOUT_FILENO) == 0) {
        return dig_error_set(error, DIG_EINVAL, "standard input and output: expected a terminal");
    }
    // Numbers keep their point: only the set of characters is the user's.
    const bool        locale = setlocale(LC_CTYPE, "") != NULL;
    const char *const name   = getenv("TERM");
    if (newterm(NULL, stdout, stdin) == NULL) {
        return dig_error_set(error, DIG_EINVAL, "TERM=%s: expected a terminal that ncurses knows",
                             name != NULL ? name : "");
    }
    (void)atexit(digwatch_terminal_close);
    static const int faults[] = { SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL };
    struct sigaction action   = { .sa_handler = give_back, .sa_flags = SA_NODEFER };
    action.sa_flags |= (int)SA_RESETHAND;
    for (size_t i = 0; i < sizeof faults / sizeof faults[0]; i++) {
        (void)sigaction(faults[i], &action, NULL);
    }
    silence_errors();
    (void)cbreak();
    (void)noecho();
    (void)nodelay(stdscr, TRUE);
    (void)curs_set(0);
    start_colours();
    *utf8 = locale && strcmp(nl_langinfo(CODESET), "UTF-8") == 0;
    return DIG_OK;
}

void digwatch_terminal_size(int *const rows, int *const columns)
{
    assert(rows != NULL && columns != NULL);
    getmaxyx(stdscr, *rows, *columns);
}

int digwatch_terminal_key(void)
{
    const int key = getch();
    return key == ERR ? 0 : key;
}

void digwatch_terminal_show(const struct digwatch_grid *const grid)
{
    static const attr_t look[DIGWATCH_INKS] = {
        [DIGWATCH_TITLE] = A_BOLD, [DIGWATCH_FAINT] = A_DIM, [DIGWATCH_MEASURED] = A_BOLD,
        [DIGWATCH_GOOD] = A_BOLD,  [DIGWATCH_BAD] = A_BOLD,
    };
    assert(grid != NULL);
    for (int row = 0; row < grid->rows; row++) {
        for (int column = 0; column < grid->columns; column++) {
            const struct digwatch_cell *const cell    = &grid->cell[row][column];
            const wchar_t                     text[2] = { (wchar_t)cell->glyph, L'\0' };
            cchar_t                           shown;
            (void)setcchar(&shown, text, look[cell->ink], (short)cell->ink, NULL);
            (void)mvadd_wch(row, column, &shown);
        }
    }
    (void)refresh();
}

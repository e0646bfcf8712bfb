// Tests for core/shell.c: what a shell makes of a quoted word.

#include "core/shell.h"
#include "core/text.h"

#include "tests/testlib.h"

#include <stdio.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

// What `SHELL -c "printf '%s|' WORD"` prints.
static size_t said_by(const char *const word, const size_t size, char said[const])
{
    char text[4 * 4096];
    assert_true(dig_shell_word(word, sizeof text, text) < sizeof text);
    char line[sizeof text + 32];
    (void)snprintf(line, sizeof line, "printf '%%s|' %s", text);
    int end[2];
    assert_int_equal(pipe(end), 0);
    const pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        (void)dup2(end[1], STDOUT_FILENO);
        (void)close(end[0]);
        (void)execlp("sh", "sh", "-c", line, (char *)NULL);
        _exit(127);
    }
    (void)close(end[1]);
    size_t used = 0;
    for (ssize_t n; (n = read(end[0], said + used, size - 1 - used)) > 0;) {
        used += (size_t)n;
    }
    (void)close(end[0]);
    said[used] = '\0';
    int status = -1;
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(WIFEXITED(status) && WEXITSTATUS(status) == 0);
    return used;
}

static void assert_one_word(const char *const word)
{
    char         said[3 * 4096];
    const size_t length = strlen(word);
    assert_int_equal(said_by(word, sizeof said, said), length + 1);
    assert_memory_equal(said, word, length);
    assert_int_equal(said[length], '|');
}

TEST(a_shell_reads_each_word_as_it_is)
{
    static const char *const words[] = {
        "",
        "plain/path-1.2_3+4.csv",
        "two words",
        "it's",
        "'",
        "''''",
        "\"quoted\"",
        "$HOME",
        "$(touch OWNED)",
        "`touch OWNED`",
        "a; touch OWNED",
        "a && touch OWNED #",
        "*?[a-z]",
        "~root",
        "!1",
        "a\\",
        "\\n%s%n",
        "line\nbreak",
        "ends in a line break\n",
        "\t tab",
        "-n",
        "--help",
        "END\n",
        "\x1b]0;title\x07",
        "\r\x7f\x01",
        "\xff\xfe not UTF-8 \xc3",
        "\xc2\x9b[31m",
        "\xc3\xa9",
        "{a,b}",
        "<(x) >y 2>&1 |z &",
        "=x",
    };
    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++) {
        assert_one_word(words[i]);
    }
    char each[256];
    for (unsigned c = 1; c < 256; c++) {
        each[c - 1] = (char)c;
    }
    each[255] = '\0';
    assert_one_word(each);
    char long_word[4096];
    memset(long_word, '\'', sizeof long_word - 1);
    long_word[sizeof long_word - 1] = '\0';
    assert_one_word(long_word);
}

TEST(a_terminal_is_shown_characters_only)
{
    char text[256];
    (void)dig_shell_word("a\x1b[31m\xff\xc2\x9b\r", sizeof text, text);
    for (const char *c = text; *c != '\0'; c += dig_text_character(c)) {
        assert_true(dig_text_character(c) > 0);
    }
}

TEST(a_plain_word_stands_as_it_is_and_another_between_quotes)
{
    char text[64];
    assert_int_equal(dig_shell_word("a/b.csv", sizeof text, text), 7);
    assert_string_equal(text, "a/b.csv");
    assert_int_equal(dig_shell_word("a b", sizeof text, text), 5);
    assert_string_equal(text, "'a b'");
}

TEST(a_text_too_short_is_told_by_the_length_and_ends)
{
    char text[8] = "xxxxxxx";
    assert_int_equal(dig_shell_word("it's me", 5, text), 12);
    assert_string_equal(text, "'it'");
    assert_int_equal(text[5], 'x');
}

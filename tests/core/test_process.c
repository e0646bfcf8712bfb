// Tests for core/process.c

#include "core/process.h"

#include "tests/testlib.h"

static FILE *out;

static int fresh(void **state)
{
    (void)state;
    out = tmpfile();
    return out != NULL ? 0 : -1;
}

static int done(void **state)
{
    (void)state;
    return fclose(out);
}

TEST_WITH(arguments_arrive_as_they_are, fresh, done)
{
    const char *const        argv[] = { "printf", "%s|", "a b", "it's \"$HOME\"; `x` *", "", NULL };
    const struct dig_process process = { .argv = argv, .out = out };
    char                     line[80];
    assert_int_equal(dig_process_run(&process, NULL), DIG_OK);
    dig_process_last_line(out, sizeof line, line);
    assert_string_equal(line, "a b|it's \"$HOME\"; `x` *||");
}

TEST_WITH(a_program_that_is_not_there_is_bad_input, fresh, done)
{
    const char *const        argv[]  = { "no-such-program-anywhere", NULL };
    const struct dig_process process = { .argv = argv, .out = out };
    struct dig_error         error   = { "" };
    assert_int_equal(dig_process_run(&process, &error), DIG_EINVAL);
    assert_contains(error.text, "no-such-program-anywhere: No such file");
}

TEST_WITH(one_that_fails_is_told_by_its_last_words, fresh, done)
{
    const char *const        argv[]  = { "sh", "-c",
                                         "echo out; echo one >&2; echo two >&2; echo >&2; exit 3", NULL };
    const struct dig_process process = { .argv = argv, .out = out };
    struct dig_error         error   = { "" };
    assert_int_equal(dig_process_run(&process, &error), DIG_EIO);
    assert_string_equal(error.text, "sh: two");
}

TEST_WITH(part_of_the_environment_is_kept_from_it, fresh, done)
{
    assert_int_equal(setenv("DIG_SEEN", "seen", 1), 0);
    assert_int_equal(setenv("HIDE_THIS", "hidden", 1), 0);
    const char *const  argv[] = { "sh", "-c", "echo $DIG_SEEN $HIDE_THIS.", NULL };
    char               line[80];
    struct dig_process process = { .argv = argv, .out = out };
    assert_int_equal(dig_process_run(&process, NULL), DIG_OK);
    dig_process_last_line(out, sizeof line, line);
    assert_string_equal(line, "seen hidden.");
    process.without = "HIDE_";
    assert_int_equal(dig_process_run(&process, NULL), DIG_OK);
    dig_process_last_line(out, sizeof line, line);
    assert_string_equal(line, "seen .");
}

TEST_WITH(it_reads_what_it_is_given, fresh, done)
{
    FILE *const in = tmpfile();
    char        line[80];
    assert_non_null(in);
    assert_true(fputs("7\n", in) >= 0);
    rewind(in);
    const char *const        argv[]  = { "cat", NULL };
    const struct dig_process process = { .argv = argv, .in = in, .out = out };
    assert_int_equal(dig_process_run(&process, NULL), DIG_OK);
    dig_process_last_line(out, sizeof line, line);
    assert_string_equal(line, "7");
    (void)fclose(in);
}

TEST_WITH(the_last_line_is_cut_and_clean, fresh, done)
{
    char line[8];
    dig_process_last_line(out, sizeof line, line);
    assert_string_equal(line, "");
    assert_true(fputs("first\na\033[31mlong line\n \t\n\n", out) >= 0);
    dig_process_last_line(out, sizeof line, line);
    assert_string_equal(line, "a?[31ml");
}

// Tests for core/did_you_mean.c

#include "core/did_you_mean.h"

#include "tests/testlib.h"

#include <string.h>

static const char *best_of(const char *const word)
{
    static const char *const known[] = { "dig",   "show", "seal",    "generate",   "trajectory",
                                         "merge", "add",  "simpleA", "attack-deg", "" };
    struct dig_guess         guess   = dig_guess(word);
    for (size_t i = 0; i < sizeof known / sizeof known[0]; i++) {
        dig_guess_try(&guess, known[i]);
    }
    return guess.best;
}

TEST(a_slip_of_the_fingers_is_understood)
{
    static const char *const meant[][2] = {
        { "shwo", "show" },
        { "sho", "show" },
        { "shows", "show" },
        { "zhow", "show" },
        { "genrate", "generate" },
        { "generaet", "generate" },
        { "simplea", "simpleA" },
        { "trajectroy", "trajectory" },
        { "traj3ct0ry", "trajectory" },
        { "atack-deg", "attack-deg" },
        { "dgi", "dig" },
    };
    for (size_t i = 0; i < sizeof meant / sizeof meant[0]; i++) {
        assert_string_equal(best_of(meant[i][0]), meant[i][1]);
    }
}

TEST(another_word_is_not_guessed)
{
    static const char *const strange[] = { "frob", "ship", "gravel", "generic-word", "xy" };
    for (size_t i = 0; i < sizeof strange / sizeof strange[0]; i++) {
        assert_null(best_of(strange[i]));
    }
}

TEST(the_nearest_wins_whatever_the_order)
{
    struct dig_guess guess = dig_guess("packings");
    dig_guess_try(&guess, "parking");
    assert_string_equal(guess.best, "parking");
    dig_guess_try(&guess, "packing");
    assert_string_equal(guess.best, "packing");
    dig_guess_try(&guess, "parkings");
    assert_string_equal(guess.best, "packing");
}

TEST(long_words_are_left_alone)
{
    char word[4096];
    memset(word, 'a', sizeof word - 1);
    word[sizeof word - 1]  = '\0';
    struct dig_guess guess = dig_guess(word);
    dig_guess_try(&guess, word);
    assert_null(guess.best);
    guess = dig_guess("aa");
    dig_guess_try(&guess, word);
    assert_null(guess.best);
}

TEST(the_text_is_a_question_or_nothing)
{
    char             text[DIG_GUESS_SIZE] = "old";
    struct dig_guess guess                = dig_guess("jsno");
    assert_string_equal(dig_guess_text(&guess, "--", text), "");
    dig_guess_try(&guess, "json");
    assert_string_equal(dig_guess_text(&guess, "--", text), ", did you mean \"--json\"?");
}

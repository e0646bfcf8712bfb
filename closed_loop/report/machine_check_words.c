// The lines of the checklist in words.

#include "closed_loop/report/machine_check_report.h"

#include "core/sample.h"
#include "core/text.h"
#include "core/units.h"

#include <assert.h>
#include <math.h>
#include <stdarg.h>

static const double bar_Pa = 1e5;

// A question's name for programs, what it asks, and what to do; figures come with the answer. What
// is asked of a joint or a signal begins with its name.
static const struct {
    const char *name, *question, *todo;
} questions[DIG_CHECK_QUESTIONS] = {
    [DIG_CHECK_TIMES]     = { "times", "sample times",
                              "a gap hides motion: look at logger and bus; 50 a second are needed" },
    [DIG_CHECK_MISSING]   = { "missing", "readings there",
                              "a sensor, its cable or the bus drops out" },
    [DIG_CHECK_STUCK]     = { "stuck", " changes",
                              "sensor or gateway stands; what it read there was left out" },
    [DIG_CHECK_MOVES]     = { "moves", " moves", "" },
    [DIG_CHECK_RANGE]     = { "range", " within its limits",
                              "min_deg, max_deg, and the cylinder's lengths and pins" },
    [DIG_CHECK_DEGREES]   = { "degrees", "angles are in radians",
                              "scale: 0.0174533 in the signal map, or the DBC's unit" },
    [DIG_CHECK_DIRECTION] = { "direction", " angle counts up", "" },
    [DIG_CHECK_ZERO]      = { "zero", " angle reads more by", "" },
    [DIG_CHECK_CYLINDER]  = { "cylinder", " pressures are its own",
                              "exchange the cylinders in the signal map" },
    [DIG_CHECK_SIDES]     = { "sides", " head is head", "" },
    [DIG_CHECK_UNIT]      = { "unit", " pressures' unit", "" },
    [DIG_CHECK_FACTOR]    = { "factor", " pressures read more by",
                              "range of the transmitter under load, or scale in the signal map" },
    [DIG_CHECK_OFFSET]    = { "offset", " head reads more by", "" },
    [DIG_CHECK_WEIGHT]    = { "weight", " weighs more by", "" },
    [DIG_CHECK_DELAY]     = { "delay", "pressures are late by",
                              "delay_ms of the messages in the signal map" },
    [DIG_CHECK_REST]      = { "rest", ": what is left",
                              "not in this list: pins, lengths, friction, or it touched something" },
};

__attribute__((format(printf, 2, 3))) static void say(char              text[DIG_CHECK_TEXT_SIZE],
                                                      const char *const format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    (void)vsnprintf(text, DIG_CHECK_TEXT_SIZE, format, arguments);
    va_end(arguments);
}

static double degrees(const double rad)
{
    return rad / DIG_RAD_PER_DEG;
}

const char *dig_check_verdict_name(const enum dig_check_verdict verdict)
{
    static const char *const name[] = {
        [DIG_CHECK_OK]       = "ok",
        [DIG_CHECK_UNTOLD]   = "not told",
        [DIG_CHECK_DOUBTFUL] = "doubtful",
        [DIG_CHECK_WRONG]    = "wrong",
    };
    return name[verdict];
}

const char *dig_check_question_name(const enum dig_check_question question)
{
    return questions[question].name;
}

const char *dig_check_of_name(const struct dig_check_item *const item)
{
    if (item->of < 0) {
        return "all";
    }
    return item->question == DIG_CHECK_STUCK ? dig_signal_name((enum dig_signal)item->of)
                                             : dig_joint_name((enum dig_joint)item->of);
}

// Angles are shown as they are read best, which need not be how they stand in the recording.
static void say_reading(const struct dig_reading *const best, const int joint,
                        char text[DIG_CHECK_TEXT_SIZE])
{
    const double zero_deg = degrees(best->zero_rad[joint]);
    const bool   moved    = fabs(zero_deg) > 0.0;
    text[0]               = '\0';
    if (best->turned[joint] && moved) {
        say(text, " (sign turned, then %+.0f deg)", -zero_deg);
    } else if (best->turned[joint]) {
        say(text, " (sign turned)");
    } else if (moved) {
        say(text, " (%+.0f deg on what was read)", -zero_deg);
    }
}

// How a discrete answer stands against the other.
static void say_choice(const struct dig_check_item *const item, const char *const no,
                       char answer[DIG_CHECK_TEXT_SIZE])
{
    if (isnan(item->excess)) {
        say(answer, "not judged: it hardly moves");
    } else if (item->verdict == DIG_CHECK_OK) {
        say(answer, "yes, by %.0f sigma", item->excess);
    } else if (item->verdict == DIG_CHECK_UNTOLD) {
        say(answer, "not told: another is %.1f sigma worse", item->excess);
    } else {
        say(answer, "no: %s, by %.0f sigma", no, item->excess);
    }
}

// "+4.00 +-0.18 deg (allowed 0.50)"
static void say_figure(const struct dig_check_item *const item, const double unit, const int digits,
                       const char *const name, char answer[DIG_CHECK_TEXT_SIZE])
{
    const double least = 0.5 * pow(10.0, -digits);
    const double value = item->value / unit;
    if (isnan(value)) {
        say(answer, "not judged");
    } else {
        say(answer, "%+.*f +-%.*f %s (allowed %.*f)", digits, fabs(value) < least ? 0.0 : value,
            digits, item->sigma / unit, name, digits, item->tolerance / unit);
    }
}

// The answer, and what to do where that has figures.
static void say_answer(const struct dig_check_subject *const subject,
                       const struct dig_check_item *const item, struct dig_check_words *const words)
{
    const char *const joint  = dig_check_of_name(item);
    char *const       answer = words->answer;
    char *const       todo   = words->todo;
    char              part[DIG_CHECK_TEXT_SIZE];
    switch (item->question) {
    case DIG_CHECK_TIMES:
        say(answer, "%.0f a second, largest gap %.3f s", item->value, item->tolerance);
        break;
    case DIG_CHECK_MISSING:
        say(answer, "%.1f %% missing, of the worst signal", 100.0 * item->value);
        break;
    case DIG_CHECK_STUCK: say(answer, "no: one value for %.1f s", item->value); break;
    case DIG_CHECK_MOVES:
        say_reading(&subject->check->reading.best, item->of, part);
        say(answer, "by %.0f deg, from %.0f to %.0f%s", degrees(item->value),
            degrees(subject->check->angles_rad[item->of][0]),
            degrees(subject->check->angles_rad[item->of][1]), part);
        say(todo, "move it by %.0f deg or more: nothing of it is judged", degrees(item->tolerance));
        break;
    case DIG_CHECK_RANGE:
        if (item->value > 0.0) {
            say(answer, "%.1f deg beyond (allowed %.1f)", degrees(item->value),
                degrees(item->tolerance));
        } else {
            say(answer, "yes");
        }
        break;
    case DIG_CHECK_DEGREES:
        say(answer, item->verdict == DIG_CHECK_OK ? "yes" : "no: in degrees");
        break;
    case DIG_CHECK_DIRECTION:
        say_choice(item, "it counts down", answer);
        say(todo, "sign: -1 of %s_rad in the signal map, or 1 where it is -1", joint);
        break;
    case DIG_CHECK_CYLINDER:
        say(part, "in the %s's columns", dig_joint_name((enum dig_joint)item->answer));
        say_choice(item, part, answer);
        break;
    case DIG_CHECK_SIDES:
        say_choice(item, "head and rod exchanged", answer);
        say(todo, "exchange %s_head_Pa and %s_rod_Pa in the signal map", joint, joint);
        break;
    case DIG_CHECK_UNIT:
        say(part, "%.6g times as much", item->value);
        say_choice(item, part, answer);
        say(todo, "unit or scale of %s_head_Pa and %s_rod_Pa: times %.6g", joint, joint,
            item->value);
        break;
    case DIG_CHECK_ZERO:
        say_figure(item, DIG_RAD_PER_DEG, 2, "deg", answer);
        // The map adds the offset before it turns the sign.
        say(todo, "offset of %s_rad in the signal map: %+.4f rad more; with sign: -1, %+.4f", joint,
            -item->value, item->value);
        break;
    case DIG_CHECK_FACTOR: say_figure(item, 0.01, 1, "%", answer); break;
    case DIG_CHECK_OFFSET:
        say_figure(item, bar_Pa, 2, "bar", answer);
        say(todo,
            "transmitter; or in the signal map, offset of %s_head_Pa %+.3g Pa more, or of "
            "%s_rod_Pa %+.3g: see which is not 0 without pressure",
            joint, -item->value, joint, -item->at_rod);
        break;
    case DIG_CHECK_WEIGHT:
        say_figure(item, 1.0, 0, "kg", answer);
        say(todo, "weigh it, or mass_kg: %.0f, or another com_m",
            subject->machine->link[item->of].mass_kg + item->value);
        break;
    case DIG_CHECK_DELAY: say_figure(item, 1e-3, 0, "ms", answer); break;
    case DIG_CHECK_REST:
        if (isfinite(item->value)) {
            say(answer, "%.2f sigma (was %.2f), %.1f %% of its load", item->value,
                subject->check->rest_plain[item->of], 100.0 * item->share);
        } else {
            say(answer, "not judged: no pressures");
        }
        break;
    case DIG_CHECK_QUESTIONS: break;
    }
}

void dig_check_say(const struct dig_check_subject *const subject,
                   const struct dig_check_item *const item, struct dig_check_words *const words)
{
    assert(subject != NULL && item != NULL && words != NULL);
    const bool open = item->verdict == DIG_CHECK_UNTOLD && item->question != DIG_CHECK_MOVES;
    *words          = (struct dig_check_words){ .todo = "" };
    say(words->question, "%s%s", item->of < 0 ? "" : dig_check_of_name(item),
        questions[item->question].question);
    say(words->todo, "%s", questions[item->question].todo);
    say_answer(subject, item, words);
    if (item->verdict == DIG_CHECK_OK || open) {
        words->todo[0] = '\0';
    }
}

// What would do in its place.
static void list_other(const struct dig_check_subject *const subject,
                       const struct dig_check_item *const item, const size_t size, char text[])
{
    if (item->or_item >= 0) {
        struct dig_check_words other;
        dig_check_say(subject, &subject->check->item[item->or_item], &other);
        dig_text_add(size, text, ", or %s: %s", other.question, other.answer);
    }
}

static size_t list_lines(const struct dig_check_subject *const subject,
                         const enum dig_check_verdict verdict, const size_t size, char text[])
{
    size_t n = 0;
    for (size_t i = 0; i < subject->check->items; i++) {
        struct dig_check_words words;
        // What stands in the place of something is told with it.
        const struct dig_check_item *const item = &subject->check->item[i];
        const bool                         told = item->or_item >= 0 && verdict != DIG_CHECK_WRONG;
        if (item->verdict == verdict && !told) {
            dig_check_say(subject, item, &words);
            if (text != NULL) {
                dig_text_add(size, text, "%s%s: %s", n > 0 ? "; " : "", words.question,
                             words.answer);
                list_other(subject, item, size, text);
            }
            n++;
        }
    }
    return n;
}

void dig_check_sentence(const struct dig_check_subject *const subject, const size_t size,
                        char text[])
{
    assert(subject != NULL && size > 0 && text != NULL);
    const size_t wrong    = list_lines(subject, DIG_CHECK_WRONG, 0, NULL);
    const size_t doubtful = list_lines(subject, DIG_CHECK_DOUBTFUL, 0, NULL);
    const size_t untold   = list_lines(subject, DIG_CHECK_UNTOLD, 0, NULL);
    (void)snprintf(text, size, "%s", subject->machine->name);
    if (wrong == 0 && doubtful == 0) {
        dig_text_add(size, text, " fits this recording in free air");
    }
    if (subject->check->unexplained) {
        dig_text_add(size, text,
                     ": no answer to these questions explains this recording. Was the bucket in "
                     "free air all the time? ");
    } else if (wrong > 0) {
        dig_text_add(size, text, " does not fit this recording. ");
    }
    if (wrong > 0) {
        dig_text_add(size, text, "Wrong: ");
        (void)list_lines(subject, DIG_CHECK_WRONG, size, text);
    }
    // Of what is not explained the doubtful answers are as good as none.
    if (doubtful > 0 && !subject->check->unexplained) {
        dig_text_add(size, text,
                     wrong > 0 ? ". Doubtful: "
                               : " fits this recording but for what is doubtful: ");
        (void)list_lines(subject, DIG_CHECK_DOUBTFUL, size, text);
    }
    if (untold > 0) {
        dig_text_add(size, text, "; %zu question%s not told", untold,
                     untold == 1 ? " is" : "s are");
    }
    dig_text_add(size, text, ".");
}

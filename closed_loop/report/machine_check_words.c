// The lines of the checklist in words.

#include "closed_loop/report/machine_check_report.h"

#include "core/sample.h"
#include "core/units.h"

#include <assert.h>
#include <math.h>
#include <stdarg.h>
#include <string.h>

static const double bar_Pa = 1e5;

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

// One question each: what is asked, what is answered, what to do.
typedef void sayer(const struct dig_check_subject *subject, const struct dig_check_item *item,
                   struct dig_check_words *words);

static const char *joint_of(const struct dig_check_item *const item)
{
    return dig_joint_name((enum dig_joint)item->of);
}

static void say_times(const struct dig_check_subject *const subject,
                      const struct dig_check_item *const item, struct dig_check_words *const words)
{
    (void)subject;
    say(words->question, "sample times");
    say(words->answer, "%.0f a second, largest gap %.3f s", item->value, item->tolerance);
    say(words->todo, "a gap hides motion: look at logger and bus; 50 a second are needed");
}

static void say_missing(const struct dig_check_subject *const subject,
                        const struct dig_check_item *const    item,
                        struct dig_check_words *const         words)
{
    (void)subject;
    say(words->question, "readings there");
    say(words->answer, "%.1f %% missing, of the worst signal", 100.0 * item->value);
    say(words->todo, "a sensor, its cable or the bus drops out");
}

static void say_stuck(const struct dig_check_subject *const subject,
                      const struct dig_check_item *const item, struct dig_check_words *const words)
{
    (void)subject;
    say(words->question, "%s changes", dig_signal_name((enum dig_signal)item->of));
    say(words->answer, "no: one value for %.1f s", item->value);
    say(words->todo, "sensor or gateway stands; what it read there was left out");
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

static void say_moves(const struct dig_check_subject *const subject,
                      const struct dig_check_item *const item, struct dig_check_words *const words)
{
    const double *const rad = subject->check->angles_rad[item->of];
    char                read[DIG_CHECK_TEXT_SIZE];
    say_reading(&subject->check->reading.best, item->of, read);
    say(words->question, "%s moves", joint_of(item));
    say(words->answer, "by %.0f deg, from %.0f to %.0f%s", degrees(item->value), degrees(rad[0]),
        degrees(rad[1]), read);
    say(words->todo, "move it by %.0f deg or more: nothing of it is judged",
        degrees(item->tolerance));
}

static void say_range(const struct dig_check_subject *const subject,
                      const struct dig_check_item *const item, struct dig_check_words *const words)
{
    (void)subject;
    say(words->question, "%s within its limits", joint_of(item));
    if (item->value > 0.0) {
        say(words->answer, "%.1f deg beyond (allowed %.1f)", degrees(item->value),
            degrees(item->tolerance));
    } else {
        say(words->answer, "yes");
    }
    say(words->todo, "min_deg, max_deg, and the cylinder's lengths and pins");
}

static void say_degrees(const struct dig_check_subject *const subject,
                        const struct dig_check_item *const    item,
                        struct dig_check_words *const         words)
{
    (void)subject;
    say(words->question, "angles are in radians");
    say(words->answer, item->verdict == DIG_CHECK_OK ? "yes" : "no: in degrees");
    say(words->todo, "scale: 0.0174533 in the signal map, or the DBC's unit");
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

static void say_direction(const struct dig_check_subject *const subject,
                          const struct dig_check_item *const    item,
                          struct dig_check_words *const         words)
{
    (void)subject;
    say(words->question, "%s angle counts up", joint_of(item));
    say_choice(item, "it counts down", words->answer);
    say(words->todo, "sign: -1 of %s_rad in the signal map, or 1 where it is -1", joint_of(item));
}

static void say_cylinder(const struct dig_check_subject *const subject,
                         const struct dig_check_item *const    item,
                         struct dig_check_words *const         words)
{
    (void)subject;
    char no[DIG_CHECK_TEXT_SIZE];
    say(words->question, "%s pressures are its own", joint_of(item));
    say(no, "in the %s's columns", dig_joint_name((enum dig_joint)item->answer));
    say_choice(item, no, words->answer);
    say(words->todo, "exchange the cylinders in the signal map");
}

static void say_sides(const struct dig_check_subject *const subject,
                      const struct dig_check_item *const item, struct dig_check_words *const words)
{
    (void)subject;
    say(words->question, "%s head is head", joint_of(item));
    say_choice(item, "head and rod exchanged", words->answer);
    say(words->todo, "exchange %s_head_Pa and %s_rod_Pa in the signal map", joint_of(item),
        joint_of(item));
}

static void say_unit(const struct dig_check_subject *const subject,
                     const struct dig_check_item *const item, struct dig_check_words *const words)
{
    (void)subject;
    char no[DIG_CHECK_TEXT_SIZE];
    say(words->question, "%s pressures' unit", joint_of(item));
    say(no, "%.6g times as much", item->value);
    say_choice(item, no, words->answer);
    say(words->todo, "unit or scale of %s_head_Pa and %s_rod_Pa: times %.6g", joint_of(item),
        joint_of(item), item->value);
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

static void say_zero(const struct dig_check_subject *const subject,
                     const struct dig_check_item *const item, struct dig_check_words *const words)
{
    (void)subject;
    say(words->question, "%s angle reads more by", joint_of(item));
    say_figure(item, DIG_RAD_PER_DEG, 2, "deg", words->answer);
    // The map adds the offset before it turns the sign.
    say(words->todo, "offset of %s_rad in the signal map: %+.4f rad more; with sign: -1, %+.4f",
        joint_of(item), -item->value, item->value);
}

static void say_factor(const struct dig_check_subject *const subject,
                       const struct dig_check_item *const item, struct dig_check_words *const words)
{
    (void)subject;
    say(words->question, "%s pressures read more by", joint_of(item));
    say_figure(item, 0.01, 1, "%", words->answer);
    say(words->todo, "range of the transmitter under load, or scale in the signal map");
}

static void say_offset(const struct dig_check_subject *const subject,
                       const struct dig_check_item *const item, struct dig_check_words *const words)
{
    (void)subject;
    say(words->question, "%s head reads more by", joint_of(item));
    say_figure(item, bar_Pa, 2, "bar", words->answer);
    say(words->todo,
        "transmitter; or in the signal map, offset of %s_head_Pa %+.3g Pa more, or of %s_rod_Pa "
        "%+.3g: see which is not 0 without pressure",
        joint_of(item), -item->value, joint_of(item), -item->at_rod);
}

static void say_weight(const struct dig_check_subject *const subject,
                       const struct dig_check_item *const item, struct dig_check_words *const words)
{
    say(words->question, "%s weighs more by", joint_of(item));
    say_figure(item, 1.0, 0, "kg", words->answer);
    say(words->todo, "weigh it, or mass_kg: %.0f, or another com_m",
        subject->machine->link[item->of].mass_kg + item->value);
}

static void say_delay(const struct dig_check_subject *const subject,
                      const struct dig_check_item *const item, struct dig_check_words *const words)
{
    (void)subject;
    say(words->question, "pressures are late by");
    say_figure(item, 1e-3, 0, "ms", words->answer);
    say(words->todo, "delay_ms of the messages in the signal map");
}

static void say_rest(const struct dig_check_subject *const subject,
                     const struct dig_check_item *const item, struct dig_check_words *const words)
{
    say(words->question, "%s: what is left", joint_of(item));
    if (isfinite(item->value)) {
        say(words->answer, "%.2f sigma (was %.2f), %.1f %% of its load", item->value,
            subject->check->rest_plain[item->of], 100.0 * item->share);
    } else {
        say(words->answer, "not judged: no pressures");
    }
    say(words->todo, "not in this list: pins, lengths, friction, or it touched something");
}

void dig_check_say(const struct dig_check_subject *const subject,
                   const struct dig_check_item *const item, struct dig_check_words *const words)
{
    assert(subject != NULL && item != NULL && words != NULL);
    static sayer *const of[DIG_CHECK_QUESTIONS] = {
        [DIG_CHECK_TIMES] = say_times,         [DIG_CHECK_MISSING] = say_missing,
        [DIG_CHECK_STUCK] = say_stuck,         [DIG_CHECK_MOVES] = say_moves,
        [DIG_CHECK_RANGE] = say_range,         [DIG_CHECK_DEGREES] = say_degrees,
        [DIG_CHECK_DIRECTION] = say_direction, [DIG_CHECK_ZERO] = say_zero,
        [DIG_CHECK_CYLINDER] = say_cylinder,   [DIG_CHECK_SIDES] = say_sides,
        [DIG_CHECK_UNIT] = say_unit,           [DIG_CHECK_FACTOR] = say_factor,
        [DIG_CHECK_OFFSET] = say_offset,       [DIG_CHECK_WEIGHT] = say_weight,
        [DIG_CHECK_DELAY] = say_delay,         [DIG_CHECK_REST] = say_rest,
    };
    *words = (struct dig_check_words){ .todo = "" };
    of[item->question](subject, item, words);
    const bool open = item->verdict == DIG_CHECK_UNTOLD && item->question != DIG_CHECK_MOVES;
    if (item->verdict == DIG_CHECK_OK || open) {
        words->todo[0] = '\0';
    }
}

// Adds to a list, "a, b, c".
static void list(const size_t size, char text[], const char *const before, const char *const what)
{
    const size_t used = strlen(text);
    (void)snprintf(text + used, size - used, "%s%s", before, what);
}

// What would do in its place.
static void list_other(const struct dig_check_subject *const subject,
                       const struct dig_check_item *const item, const size_t size, char text[])
{
    if (item->or_item >= 0) {
        struct dig_check_words other;
        dig_check_say(subject, &subject->check->item[item->or_item], &other);
        list(size, text, ", or ", other.question);
        list(size, text, ": ", other.answer);
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
                list(size, text, n > 0 ? "; " : "", words.question);
                list(size, text, ": ", words.answer);
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
        list(size, text, " ", "fits this recording in free air");
    }
    if (subject->check->unexplained) {
        list(size, text, ": ",
             "no answer to these questions explains this recording. Was the bucket in free air all "
             "the time");
        list(size, text, "? ", "");
    } else if (wrong > 0) {
        list(size, text, " ", "does not fit this recording. ");
    }
    if (wrong > 0) {
        list(size, text, "", "Wrong: ");
        (void)list_lines(subject, DIG_CHECK_WRONG, size, text);
    }
    // Of what is not explained the doubtful answers are as good as none.
    if (doubtful > 0 && !subject->check->unexplained) {
        list(size, text, wrong > 0 ? ". " : " fits this recording but for what is doubtful: ",
             wrong > 0 ? "Doubtful: " : "");
        (void)list_lines(subject, DIG_CHECK_DOUBTFUL, size, text);
    }
    if (untold > 0) {
        const size_t used = strlen(text);
        (void)snprintf(text + used, size - used, "; %zu question%s not told", untold,
                       untold == 1 ? " is" : "s are");
    }
    list(size, text, "", ".");
}

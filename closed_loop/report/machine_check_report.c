#include "closed_loop/report/machine_check_report.h"

#include "core/markup.h"
#include "core/sample.h"
#include "core/text.h"

#include <assert.h>
#include <string.h>

enum { COLUMNS = 80, ANSWER = 39, SENTENCE = 4000 };

// A text in lines of 80 columns behind what stands in the first, the later ones indented.
static void put_wrapped(FILE *const to, const int first, const int indent, const char *text)
{
    int column = first;
    while (*text != '\0') {
        const int word = (int)strcspn(text, " ");
        if (column > indent && column + 1 + word > COLUMNS) {
            (void)fprintf(to, "\n%*s", indent, "");
            column = indent;
        } else if (column > 0) {
            (void)fputc(' ', to);
            column++;
        }
        (void)fprintf(to, "%.*s", word, text);
        column += word;
        text += word;
        text += strspn(text, " ");
    }
    (void)fputc('\n', to);
}

static void put_line(FILE *const to, const struct dig_check_subject *const subject,
                     const struct dig_check_item *const item)
{
    struct dig_check_words words;
    dig_check_say(subject, item, &words);
    const int answer =
        fprintf(to, "%-9s %-28s", dig_check_verdict_name(item->verdict), words.question);
    put_wrapped(to, answer, ANSWER, words.answer);
    if (words.todo[0] != '\0') {
        const int indent = fprintf(to, "          ->");
        put_wrapped(to, indent, indent + 1, words.todo);
    }
    if (item->or_item >= 0) {
        struct dig_check_words other;
        dig_check_say(subject, &subject->check->item[item->or_item], &other);
        (void)fprintf(to, "          or %s: this recording cannot tell\n", other.question);
    }
}

void dig_machine_check_text(const struct dig_check_subject *const subject, FILE *const to)
{
    assert(subject != NULL && to != NULL);
    char sentence[SENTENCE];
    dig_check_sentence(subject, sizeof sentence, sentence);
    dig_text_clean(sentence);
    put_wrapped(to, 0, 0, sentence);
    (void)fputc('\n', to);
    for (size_t i = 0; i < subject->check->items; i++) {
        put_line(to, subject, &subject->check->item[i]);
    }
}

static void put_item(FILE *const to, const struct dig_check_subject *const subject,
                     const struct dig_check_item *const item)
{
    struct dig_check_words words;
    dig_check_say(subject, item, &words);
    dig_json_put(to,
                 "  {\"question\": %s, \"of\": %s, \"verdict\": %s, \"value\": %g, \"sigma\": %g, "
                 "\"tolerance\": %g, \"excess\": %g",
                 dig_check_question_name(item->question), dig_check_of_name(item),
                 dig_check_verdict_name(item->verdict), item->value, item->sigma, item->tolerance,
                 item->excess);
    if (item->question == DIG_CHECK_CYLINDER) {
        dig_json_put(to, ", \"found_in\": %s", dig_joint_name((enum dig_joint)item->answer));
    }
    if (item->question == DIG_CHECK_REST) {
        dig_json_put(to, ", \"share\": %g", item->share);
    }
    if (item->or_item >= 0) {
        const struct dig_check_item *const other = &subject->check->item[item->or_item];
        dig_json_put(to, ", \"or\": {\"question\": %s, \"of\": %s}",
                     dig_check_question_name(other->question), dig_check_of_name(other));
    }
    dig_json_put(to, ", \"text\": %s, \"answer\": %s, \"todo\": %s}", words.question, words.answer,
                 words.todo);
}

void dig_machine_check_json(const struct dig_check_subject *const subject, FILE *const to)
{
    assert(subject != NULL && to != NULL);
    const struct dig_machine_air_check *const check = subject->check;
    dig_json_put(to,
                 "{\"machine\": %s,\n \"recording\": %s,\n \"duration_s\": %g,\n"
                 " \"verdict\": %s,\n \"unexplained\": %i,\n \"items\": [\n",
                 subject->machine->name, subject->recording, check->duration_s,
                 dig_check_verdict_name(check->verdict), check->unexplained);
    for (size_t i = 0; i < check->items; i++) {
        put_item(to, subject, &check->item[i]);
        (void)fputs(i + 1 < check->items ? ",\n" : "\n", to);
    }
    (void)fputs(" ]}\n", to);
}

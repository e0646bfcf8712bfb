#include "closed_loop/report/html.h"

#include "core/markup.h"
#include "core/text.h"

#include <assert.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

void dig_html_text(FILE *const to, const char *const text)
{
    assert(to != NULL && text != NULL);
    for (const char *c = text; *c != '\0';) {
        const size_t n = dig_text_character(c);
        switch (*c) {
        case '<': (void)fputs("&lt;", to); break;
        case '>': (void)fputs("&gt;", to); break;
        case '&': (void)fputs("&amp;", to); break;
        case '"': (void)fputs("&quot;", to); break;
        case '\'': (void)fputs("&#39;", to); break;
        default:
            if (n == 0) {
                (void)fputs("\xef\xbf\xbd", to);
            } else {
                (void)fwrite(c, 1, n, to);
            }
        }
        c += n == 0 ? 1 : n;
    }
}

void dig_html_put(FILE *const to, const char *const format, ...)
{
    static const struct dig_markup html = { dig_html_text, "–" };
    va_list                        values;
    va_start(values, format);
    dig_markup_put(to, &html, format, values);
    va_end(values);
}

void dig_html_without_folders(FILE *const to, const char *const text)
{
    assert(to != NULL && text != NULL);
    char *const kept = malloc(strlen(text) + 1);
    size_t      n    = 0;
    size_t      word = 0;
    for (const char *c = text; kept != NULL && *c != '\0'; c++) {
        const bool inside = strchr(" \n'\"", c[1]) == NULL; // of a word: '\0' ends one, too
        if (*c == '/' && inside) {
            n = word;
        } else if (*c != '/' || n == word) {
            kept[n++] = *c;
        }
        word = strchr(" \n'\"=", *c) != NULL ? n : word;
    }
    if (kept != NULL) {
        kept[n] = '\0';
        dig_html_text(to, kept);
    }
    free(kept);
}

// On paper nothing scrolls, no picture or line of a table is torn, and bars are printed.
static const char style[] =
    "<style>body{font:16px/1.5 system-ui,sans-serif;color:#222;max-width:960px;margin:0 auto;"
    "padding:1em}h1{font-size:1.5em;overflow-wrap:anywhere}h2{font-size:1.2em;margin-top:2em;"
    "border-top:1px solid #ddd;"
    "padding-top:1em}table{border-collapse:collapse;display:block;overflow-x:auto}"
    "td,th{padding:.25em .8em;text-align:right;border-bottom:1px solid #eee;font-weight:normal}"
    "th:first-child,.words td,.words th{text-align:left}tr:first-child th{color:#666}"
    "figure{margin:1em 0}.wide td,.wide th{padding:.25em .4em}.wide tr+tr>*{white-space:nowrap}"
    "svg{width:100%;height:auto;max-width:900px}"
    ".result{background:#f4f7fb;padding:.6em 1em;font-weight:bold}"
    ".grid{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(100%,420px),1fr));"
    "gap:.5em 1.5em}.grid figure{margin:.3em 0;min-width:0}.muted{color:#666;font-size:.9em}"
    ".bar{display:inline-block;height:.7em;background:#1f5fa8;vertical-align:baseline}"
    "code,pre{font-size:.9em;background:#f5f5f5;overflow-wrap:anywhere;white-space:pre-wrap}"
    "@media(max-width:500px){td,th{padding:.25em .35em;font-size:.9em}}"
    "footer{color:#666;font-size:.9em;margin-top:2em}"
    "@media print{body{max-width:none;padding:0;font-size:11px;color:#000}"
    "table{display:table}.wide td,.wide th{padding:.2em;font-size:8px;white-space:normal}"
    ".grid{grid-template-columns:1fr 1fr}figure,tr,.result{break-inside:avoid}h2{break-after:avoid}"
    ".result{border:1px solid #000}.muted,footer,tr:first-child th{color:#000}"
    ".bar{print-color-adjust:exact;-webkit-print-color-adjust:exact}}</style>\n";

void dig_html_begin(FILE *const to, const char *const title)
{
    assert(to != NULL && title != NULL);
    dig_html_put(to,
                 "<!doctype html>\n<html lang=en><head><meta charset=utf-8>\n"
                 "<meta name=viewport content=\"width=device-width, initial-scale=1\">\n"
                 "<title>%s</title>\n",
                 title);
    (void)fputs(style, to);
    dig_html_put(to, "</head><body>\n<h1>%s</h1>\n", title);
}

void dig_html_end(FILE *const to, const char *const note)
{
    assert(to != NULL && note != NULL);
    (void)fprintf(to,
                  "<footer>%s Predictions are advice, not a safety function.</footer>\n"
                  "</body></html>\n",
                  note);
}

// Lines of a program. Context: main loop, while compiling.
#include "source_lines.h"

#include <string.h>

#include "base/base.h"
#include "lexer.h"

static bool join_by_default;

static struct {
    const char *next, *end;
    unsigned number;
    bool in_comment; // between /* and */
    bool join;
} source;

void source_lines_start(const char *text, size_t length) {
    source.next = text;
    source.end = text + length;
    source.number = 0;
    source.in_comment = false;
    source.join = join_by_default;
}

void source_lines_join(bool on) {
    join_by_default = on;
}

static bool is_blank(char c) {
    return c == ' ' || c == '\t';
}

static const char *skip_blanks(const char *text, const char *end) {
    while (text < end && is_blank(*text)) {
        text++;
    }
    return text;
}

// Behind `word` and the blanks that follow; NULL if something else stands there.
static const char *skip_word(const char *text, const char *end, const char *word) {
    size_t length = strlen(word);
    if (text == NULL || (size_t)(end - text) < length || !lexer_same(text, length, word) ||
        (text + length < end && lexer_is_name_part(text[length]))) {
        return NULL;
    }
    return skip_blanks(text + length, end);
}

// A line of the text without its end.
static bool next_raw(source_line_t *line) {
    if (source.next >= source.end) {
        return false;
    }
    const char *stop = memchr(source.next, '\n', (size_t)(source.end - source.next));
    line->text = source.next;
    line->end = stop != NULL ? stop : source.end;
    source.next = stop != NULL ? stop + 1 : source.end;
    if (line->end > line->text && line->end[-1] == '\r') {
        line->end--;
    }
    line->number = ++source.number;
    line->too_long = line->end - line->text > SOURCE_LINES_MAX;
    return true;
}

// Block comments; they start and end with a line.
static bool is_comment(const source_line_t *line) {
    const char *text = skip_blanks(line->text, line->end);
    bool comment = source.in_comment;
    if (!comment && line->end - text >= 2 && memcmp(text, "/*", 2) == 0) {
        comment = source.in_comment = true;
        text += 2;
    }
    for (; comment && text + 1 < line->end; text++) {
        if (text[0] == '*' && text[1] == '/') {
            source.in_comment = false;
        }
    }
    return comment;
}

bool source_lines_is_joint(const char *p, const char *end) {
    if (*p != '_') {
        return false;
    }
    for (p++; p < end && (is_blank(*p) || *p == '\r'); p++) {
    }
    return p < end && *p == '\n';
}

// True if the line ends with a blank and an underscore outside strings and comments.
static bool goes_on(const source_line_t *line) {
    const char *last = line->end;
    while (last > line->text && is_blank(last[-1])) {
        last--;
    }
    bool underscore =
        last > line->text && last[-1] == '_' && (last - 1 == line->text || is_blank(last[-2]));
    const char *text = skip_blanks(line->text, line->end);
    if (!underscore || skip_word(text, line->end, "REM") != NULL) {
        return false;
    }
    bool quoted = false;
    for (const char *p = text; p < last; p++) {
        quoted ^= *p == '"';
        if (!quoted && *p == '\'') {
            return false;
        }
    }
    return !quoted;
}

// OPTION CONTINUATION LINES ON|OFF holds from the line behind it on.
static void obey_option(const source_line_t *line) {
    static const struct {
        const char *word;
        bool on;
    } words[] = {{"ON", true}, {"ENABLE", true}, {"OFF", false}, {"DISABLE", false}};
    const char *text = skip_blanks(line->text, line->end);
    text = skip_word(text, line->end, "OPTION");
    text = skip_word(text, line->end, "CONTINUATION");
    text = skip_word(text, line->end, "LINES");
    for (size_t i = 0; i < COUNT_OF_ARRAY(words); i++) {
        if (skip_word(text, line->end, words[i].word) != NULL) {
            source.join = words[i].on;
        }
    }
}

bool source_lines_next(source_line_t *line) {
    do {
        if (!next_raw(line)) {
            return false;
        }
    } while (is_comment(line));
    source_line_t more = *line;
    while (source.join && goes_on(&more) && next_raw(&more)) {
        line->end = more.end;
        line->too_long |= more.too_long;
    }
    obey_option(line);
    return true;
}

// The settings are kept as text, a line "NAME=number" for each that is not what it is at first; so
// a file of an older or newer firmware, or a damaged one, costs no more than the lines that are of
// no use. Context: main loop.
#include "options.h"

#include <string.h>

#include "console.h"
#include "files/files.h"
#include "rows.h"
#include "source_lines.h"

#define OPTIONS_FILE "/.options"
#define TEXT_SIZE 256

static const struct {
    const char *name;
    int64_t first;
    int64_t min, max;
} rows[OPTIONS_COUNT] = {
    [OPTIONS_AUTORUN] = {"AUTORUN", 0, 0, 1},
    [OPTIONS_BREAK] = {"BREAK", 3, 0, 255},
    [OPTIONS_COLOUR] = {"COLOURCODE", 0, 0, 1},
    [OPTIONS_CONTINUATION] = {"CONTINUATION LINES", 0, 0, 1},
    [OPTIONS_DISPLAY] = {"DISPLAY", OPTIONS_DISPLAY_VALUE(24, 80), OPTIONS_DISPLAY_VALUE(2, 20),
                         OPTIONS_DISPLAY_VALUE(255, 255)},
    [OPTIONS_TAB] = {"TAB", 2, 2, 8},
};

static struct {
    char text[TEXT_SIZE]; // zero-terminated
} options;

// ---- The text -----------------------------------------------------------------------------------

// The line of this name, or NULL.
static const char *find_line(const char *name) {
    size_t length = strlen(name);
    const char *line = options.text;
    while (*line != '\0') {
        if (strncmp(line, name, length) == 0 && line[length] == '=') {
            return line;
        }
        const char *end = strchr(line, '\n');
        line = end != NULL ? end + 1 : line + strlen(line);
    }
    return NULL;
}

// The number behind the equals sign. False: there is none, or something behind it.
static bool read_number(const char *line, int64_t *value) {
    const char *p = strchr(line, '=') + 1;
    bool negative = *p == '-';
    p += negative;
    uint64_t sum = 0;
    unsigned digits = 0;
    for (; *p >= '0' && *p <= '9' && digits < 19; p++, digits++) {
        sum = sum * 10 + (unsigned)(*p - '0');
    }
    *value = (int64_t)(negative ? 0 - sum : sum);
    return digits > 0 && (*p == '\n' || *p == '\0');
}

static bool is_name(const char *name, size_t length) {
    for (size_t i = 0; i < length; i++) {
        bool fits = (name[i] >= 'A' && name[i] <= 'Z') || name[i] == ' ';
        if (!fits) {
            return false;
        }
    }
    return length > 0;
}

// Takes the lines of a file that are of use.
static void take_lines(char *text) {
    char *line = text;
    for (char *end; (end = strchr(line, '\n')) != NULL; line = end + 1) {
        *end = '\0';
        char *equals = strchr(line, '=');
        int64_t value;
        if (equals != NULL && is_name(line, (size_t)(equals - line)) && read_number(line, &value)) {
            *equals = '\0';
            bool twice = find_line(line) != NULL;
            *equals = '=';
            strcat(options.text, twice ? "" : line);
            strcat(options.text, twice ? "" : "\n");
        }
    }
}

// What is kept, with this line in the place of the one of that name; `line` empty: without it.
static err_t keep(const char *name, const char *line) {
    char text[TEXT_SIZE];
    const char *old = find_line(name);
    size_t before = old != NULL ? (size_t)(old - options.text) : strlen(options.text);
    const char *end = old != NULL ? strchr(old, '\n') : NULL;
    const char *behind = end != NULL ? end + 1 : "";
    if (before + strlen(behind) + strlen(line) >= sizeof text) {
        return err_raise(ERR_DISK_FULL, NULL);
    }
    memcpy(text, options.text, before);
    strcpy(text + before, behind);
    strcat(text, line);
    if (strcmp(text, options.text) == 0) {
        return ERR_OK;
    }
    err_t error = files_replace(OPTIONS_FILE, text, strlen(text));
    if (error == ERR_OK) {
        strcpy(options.text, text);
    }
    return error;
}

int64_t basic_option(const char *name, int64_t fallback) {
    int64_t value;
    const char *line = find_line(name);
    return line != NULL && read_number(line, &value) ? value : fallback;
}

err_t basic_set_option(const char *name, int64_t value) {
    char line[64];
    format_text(line, sizeof line, "%s=%lld\n", name, (long long)value);
    return keep(name, line);
}

// ---- The language's own -------------------------------------------------------------------------

static void apply(void) {
    int64_t display = options_get(OPTIONS_DISPLAY);
    console_set_size((unsigned)display / 256, (unsigned)display % 256);
    source_lines_join(options_get(OPTIONS_CONTINUATION) != 0);
    console_set_break_key((int)options_get(OPTIONS_BREAK));
}

// A file that is not there, or cannot be read, leaves everything as it is at first.
void options_start(void) {
    char text[TEXT_SIZE];
    int file;
    size_t got = 0;
    options.text[0] = '\0';
    if (files_open(OPTIONS_FILE, FILES_READ, &file) == ERR_OK) {
        files_read(file, text, sizeof text - 1, &got);
        files_close(file);
    }
    text[got] = '\0';
    take_lines(text);
    apply();
}

int64_t options_get(options_t option) {
    int64_t value = basic_option(rows[option].name, rows[option].first);
    return value >= rows[option].min && value <= rows[option].max ? value : rows[option].first;
}

err_t options_set(options_t option, int64_t value) {
    bool first = value == rows[option].first;
    err_t error = first ? keep(rows[option].name, "") : basic_set_option(rows[option].name, value);
    if (error == ERR_OK) {
        apply();
    }
    return error;
}

err_t options_reset(void) {
    files_entry_t entry;
    err_t error = ERR_OK;
    if (files_info(OPTIONS_FILE, &entry) == ERR_OK) {
        error = files_remove(OPTIONS_FILE);
    }
    if (error == ERR_OK) {
        options.text[0] = '\0';
        apply();
    }
    return error;
}

// ---- The list -----------------------------------------------------------------------------------

// The words a row of the product chooses from, or NULL.
static const char *choices_of(const char *name, size_t length) {
    const basic_command_t *row;
    for (unsigned i = 0; (row = rows_command(i)) != NULL; i++) {
        if (strncmp(row->name, "OPTION ", 7) == 0 && strncmp(row->name + 7, name, length) == 0 &&
            row->name[7 + length] == '\0' && row->arg_count > 0) {
            return row->args[0].kind == BASIC_ARG_CHOICE ? row->args[0].choices : NULL;
        }
    }
    return NULL;
}

static void print_choice(const char *choices, int64_t index) {
    while (index-- > 0 && strchr(choices, '|') != NULL) {
        choices = strchr(choices, '|') + 1;
    }
    console_write(choices, strcspn(choices, "|"));
}

static void print_value(const char *name, size_t length, int64_t value) {
    char text[32];
    const char *choices = choices_of(name, length);
    unsigned row = 0;
    while (row < OPTIONS_COUNT &&
           (strncmp(rows[row].name, name, length) != 0 || rows[row].name[length] != '\0')) {
        row++;
    }
    bool is_switch = row < OPTIONS_COUNT && rows[row].max == 1;
    if (choices != NULL) {
        print_choice(choices, value);
        return;
    }
    if (is_switch) {
        console_print(value != 0 ? "ON" : "OFF");
    } else if (row == OPTIONS_DISPLAY) {
        format_text(text, sizeof text, "%u, %u", (unsigned)value / 256, (unsigned)value % 256);
        console_print(text);
    } else {
        format_text(text, sizeof text, "%lld", (long long)value);
        console_print(text);
    }
}

void options_list(void) {
    for (const char *line = options.text; *line != '\0';) {
        size_t length = strcspn(line, "=");
        int64_t value = 0;
        read_number(line, &value);
        console_print("OPTION ");
        console_write(line, length);
        console_print(" ");
        print_value(line, length, value);
        console_new_line();
        line = strchr(line, '\n') + 1;
    }
}

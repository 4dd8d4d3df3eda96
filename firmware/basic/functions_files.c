// DIR$(), CWD$, and what MM.INFO tells about files. Context: main loop.
#include <string.h>

#include "errors.h"
#include "file_names.h"
#include "functions.h"
#include "lexer.h"
#include "memory.h"

#define FUNCTION(name) void functions_##name(value_t *arguments, unsigned count, value_t *result)

// What DIR$() without arguments goes on with. If somebody else has made a list meanwhile, it starts
// anew and goes on behind the name given last.
static struct {
    char folder[FILES_PATH_MAX + 1];
    char pattern[FILES_NAME_MAX + 1];
    char last[FILES_NAME_MAX + 1]; // the name given last
    file_names_kind_t kind;
    unsigned list; // number of its list
} dir;

static void open_list(void) {
    if (files_list_start(dir.folder) != ERR_OK) {
        errors_fail_raised();
    }
    dir.list = files_list_number();
}

static void set_copy(value_t *result, const char *text) {
    size_t length = strlen(text);
    char *copy = memory_text(length);
    memcpy(copy, text, length);
    value_set_text(result, copy, length);
}

static file_names_kind_t kind_of(const value_t *word) {
    static const struct {
        const char *word;
        file_names_kind_t kind;
    } kinds[] = {{"ALL", FILE_NAMES_ALL}, {"DIR", FILE_NAMES_FOLDERS}, {"FILE", FILE_NAMES_FILES}};
    for (size_t i = 0; i < COUNT_OF_ARRAY(kinds); i++) {
        if (lexer_same(word->text, word->length, kinds[i].word)) {
            return kinds[i].kind;
        }
    }
    errors_fail_with(ERR_ARGUMENT, "type: %.*s is invalid (valid is ALL, DIR, FILE)",
                     (int)word->length, word->text);
}

static void start_list(const value_t *arguments, unsigned count) {
    const char *pattern;
    const char *path = file_names_path(&arguments[0]);
    const char *folder = file_names_split(path, &pattern);
    if (strlen(folder) >= sizeof dir.folder || strlen(pattern) >= sizeof dir.pattern) {
        errors_fail_with(ERR_FILE_BAD_NAME, "%s", path);
    }
    strcpy(dir.folder, folder);
    strcpy(dir.pattern, *pattern != '\0' ? pattern : "*");
    dir.last[0] = '\0';
    dir.kind = count > 1 ? kind_of(&arguments[1]) : FILE_NAMES_FILES;
}

FUNCTION(dir) {
    if (count > 0) {
        start_list(arguments, count);
        open_list();
    } else if (dir.pattern[0] == '\0') {
        errors_fail_with(ERR_ARGUMENTS_MISSING, "pattern");
    } else if (dir.list != files_list_number()) {
        open_list();
    }
    files_entry_t entry;
    do {
        if (!file_names_next(dir.pattern, dir.kind, &entry)) {
            value_set_text(result, "", 0);
            return;
        }
    } while (file_names_order(entry.name, dir.last) <= 0 && dir.last[0] != '\0');
    strcpy(dir.last, entry.name);
    set_copy(result, entry.name);
}

FUNCTION(cwd) {
    (void)arguments;
    (void)count;
    char path[FILES_PATH_MAX + 3] = "A:";
    strcat(path, files_folder());
    set_copy(result, path);
}

// FILE or DIR, and its name.
FUNCTION(info_exists) {
    (void)count;
    bool is_file = lexer_same(arguments[0].text, arguments[0].length, "FILE");
    if (!is_file && !lexer_same(arguments[0].text, arguments[0].length, "DIR")) {
        errors_fail(ERR_SYNTAX);
    }
    files_entry_t entry;
    bool found = files_info(file_names_path(&arguments[1]), &entry) == ERR_OK;
    value_set_integer(result, found && entry.is_folder == !is_file);
}

// As in MMBasic: -1 if there is none, -2 for a folder.
FUNCTION(info_filesize) {
    (void)count;
    files_entry_t entry;
    bool found = files_info(file_names_path(&arguments[0]), &entry) == ERR_OK;
    value_set_integer(result, !found ? -1 : entry.is_folder ? -2 : (int64_t)entry.size);
}

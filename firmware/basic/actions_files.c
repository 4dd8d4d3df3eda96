// FILES, KILL, RENAME, COPY, MKDIR, RMDIR, CHDIR, LIST file$, XMODEM at run time. Context: main
// loop.
#include <string.h>

#include "actions.h"
#include "console.h"
#include "errors.h"
#include "file_names.h"
#include "file_output.h"
#include "memory.h"
#include "pager.h"
#include "transfer.h"
#include "vm.h"

#define ACTION_BODY(name) void actions_##name(value_t *arguments, unsigned count)
#define COPY_SIZE 512u
#define LIST_SIZE 64u
#define LIST_RESERVE 1024u

static void check(err_t error) {
    if (error != ERR_OK) {
        errors_fail_raised();
    }
}

ACTION_BODY(mkdir) {
    (void)count;
    check(files_make_folder(file_names_path(arguments)));
}

ACTION_BODY(rmdir) {
    (void)count;
    check(files_remove_folder(file_names_path(arguments)));
}

ACTION_BODY(chdir) {
    (void)count;
    check(files_change_folder(file_names_path(arguments)));
}

ACTION_BODY(rename) {
    (void)count;
    const char *from = file_names_path(&arguments[0]);
    check(files_rename(from, file_names_path(&arguments[1])));
}

// ---- KILL ---------------------------------------------------------------------------------------

static void kill_all(const char *path) {
    const char *pattern;
    const char *folder = file_names_split(path, &pattern);
    bool separated = strchr("/\\:", folder[strlen(folder) - 1]) != NULL;
    size_t size = strlen(folder) + 1 + FILES_NAME_MAX + 1;
    char *victim = memory_text(size);
    files_entry_t entry;
    unsigned killed = 0;
    check(files_list_start(folder));
    while (file_names_next(pattern, FILE_NAMES_FILES, &entry)) {
        format_text(victim, size, "%s%s%s", folder, separated ? "" : "/", entry.name);
        check(files_remove(victim));
        killed++;
        console_poll();
        if (console_break_pending()) {
            errors_break();
        }
    }
    if (killed == 0) {
        errors_fail_with(ERR_FILE_NOT_FOUND, "%s", path);
    }
}

ACTION_BODY(kill) {
    (void)count;
    const char *path = file_names_path(&arguments[0]);
    if (!file_names_is_pattern(path)) {
        check(files_remove(path));
    } else if (value_is_true(&arguments[1])) {
        kill_all(path);
    } else {
        errors_fail_with(ERR_ARGUMENT, "More than one file is meant: use KILL \"%s\", ALL", path);
    }
}

// ---- COPY ---------------------------------------------------------------------------------------

// Ctrl-C: as an error, so that the target is left alone.
static err_t copy_bytes(int from) {
    void *bytes = memory_scratch(COPY_SIZE);
    err_t error;
    size_t got;
    do {
        error = files_read(from, bytes, COPY_SIZE, &got);
        if (error == ERR_OK) {
            error = file_output_write(bytes, got);
        }
        console_poll();
        console_background();
        if (error == ERR_OK && console_break_pending()) {
            return err_raise(ERR_ARGUMENT, "Cancelled");
        }
    } while (error == ERR_OK && got == COPY_SIZE);
    return error;
}

// The target changes as a whole at the end, or not at all.
ACTION_BODY(copy) {
    (void)count;
    const char *source = file_names_path(&arguments[0]);
    const char *target = file_names_path(&arguments[1]);
    int from;
    check(files_open(source, FILES_READ, &from));
    err_t error = file_output_start(target);
    if (error == ERR_OK) {
        error = file_output_end(copy_bytes(from));
    }
    files_close(from);
    check(error);
}

// ---- XMODEM -------------------------------------------------------------------------------------

ACTION_BODY(xmodem_receive) {
    if (count == 0) {
        actions_stop_with(VM_REQUEST_RECEIVE);
    } else {
        check(transfer_receive_file(file_names_path(arguments)));
    }
}

ACTION_BODY(xmodem_send) {
    check(count == 0 ? transfer_send_program() : transfer_send_file(file_names_path(arguments)));
}

// ---- Lists --------------------------------------------------------------------------------------

// The entries of a folder in the order in which FILES shows them, in the scratch.
typedef struct listed {
    struct listed *next;
    uint32_t size;
    bool is_folder;
    char name[]; // zero-terminated
} listed_t;

static bool is_before(const listed_t *left, const listed_t *right) {
    return left->is_folder != right->is_folder ? left->is_folder
                                               : strcmp(left->name, right->name) < 0;
}

// Files come nearly in order, so the search starts at the one that was put in last.
static void put_in_order(listed_t **first, listed_t **last, listed_t *entry) {
    listed_t **place = *last != NULL && is_before(*last, entry) ? &(*last)->next : first;
    while (*place != NULL && is_before(*place, entry)) {
        place = &(*place)->next;
    }
    entry->next = *place;
    *place = entry;
    *last = entry;
}

// As many as there is memory for, at least one. True: there may be more.
static bool gather(const char *pattern, listed_t **first) {
    listed_t *last = NULL;
    files_entry_t entry;
    *first = NULL;
    while (last == NULL || memory_free() > LIST_RESERVE) {
        if (!file_names_next(pattern, FILE_NAMES_ALL, &entry)) {
            return false;
        }
        listed_t *listed = memory_scratch(sizeof *listed + strlen(entry.name) + 1);
        listed->size = entry.size;
        listed->is_folder = entry.is_folder;
        strcpy(listed->name, entry.name);
        put_in_order(first, &last, listed);
    }
    return true;
}

static bool list_entry(const listed_t *entry) {
    char line[FILES_NAME_MAX + 16];
    size_t length =
        entry->is_folder
            ? format_text(line, sizeof line, "%10s  %s", "<DIR>", entry->name)
            : format_text(line, sizeof line, "%10u  %s", (unsigned)entry->size, entry->name);
    return pager_line(line, length);
}

static void list_summary(unsigned folders, unsigned listed) {
    uint32_t total, used;
    check(files_space(&total, &used));
    char line[80];
    size_t length = format_text(line, sizeof line, "%u folder%s, %u file%s, %u bytes free", folders,
                                folders == 1 ? "" : "s", listed, listed == 1 ? "" : "s",
                                (unsigned)(total - used));
    pager_line(line, length);
}

// Folders first, names in order; if the memory is too small for that, one part after the other.
static void list_folder(const char *folder, const char *pattern) {
    unsigned counts[2] = {0, 0}; // files, folders
    uint8_t *scratch = memory.scratch;
    listed_t *entry;
    bool more;
    check(files_list_start(folder));
    pager_start(false);
    do {
        more = gather(pattern, &entry);
        for (; entry != NULL; entry = entry->next) {
            counts[entry->is_folder]++;
            if (!list_entry(entry)) {
                return;
            }
        }
        memory.scratch = scratch;
    } while (more);
    list_summary(counts[true], counts[false]);
}

ACTION_BODY(files) {
    files_entry_t entry;
    const char *path = count == 0 ? "." : file_names_path(arguments);
    if (!file_names_is_pattern(path) && files_info(path, &entry) == ERR_OK && entry.is_folder) {
        list_folder(path, "*");
        return;
    }
    const char *pattern;
    const char *folder = file_names_split(path, &pattern);
    list_folder(folder, pattern);
}

// A line longer than 255 characters goes on in the next; what would upset a terminal is a point.
static err_t list_text(int file) {
    char *line = memory_text(VALUE_STRING_MAX);
    char part[LIST_SIZE];
    size_t length = 0;
    size_t got;
    err_t error;
    while ((error = files_read(file, part, sizeof part, &got)) == ERR_OK && got > 0) {
        for (size_t i = 0; i < got; i++) {
            bool full = length == VALUE_STRING_MAX;
            if ((full || part[i] == '\n') && !pager_line(line, length)) {
                return ERR_OK;
            }
            length = full || part[i] == '\n' ? 0 : length;
            if (part[i] != '\n' && part[i] != '\r') {
                bool shown = (unsigned char)part[i] >= ' ' || part[i] == '\t';
                line[length++] = shown ? part[i] : '.';
            }
        }
    }
    if (length > 0) {
        pager_line(line, length);
    }
    return error;
}

ACTION_BODY(list_file) {
    (void)count;
    int file;
    check(files_open(file_names_path(&arguments[0]), FILES_READ, &file));
    pager_start(value_is_true(&arguments[1]));
    err_t error = list_text(file);
    files_close(file);
    check(error);
}

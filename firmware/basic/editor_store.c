// Where the editor's text comes from and goes to. Context: main loop.
#include "editor_store.h"

#include "editor_text.h"
#include "files/files.h"
#include "program.h"

#define BLOCK_SIZE 128u

// Puts text behind what is there. \r and \r\n become \n; *after_return says for the next block
// whether this one ends with \r.
static err_t append(const char *bytes, size_t count, bool *after_return) {
    for (size_t i = 0; i < count; i++) {
        bool second = bytes[i] == '\n' && *after_return;
        *after_return = bytes[i] == '\r';
        char c = *after_return ? '\n' : bytes[i];
        if (!second && !editor_text_insert(editor_text_length(), &c, 1)) {
            return err_raise(ERR_NO_MEMORY, "%s", "");
        }
    }
    return ERR_OK;
}

err_t editor_store_check(const char *file) {
    int handle;
    err_t error = file != NULL ? files_open(file, FILES_READ, &handle) : ERR_FILE_NOT_FOUND;
    if (error != ERR_OK) {
        return error == ERR_FILE_NOT_FOUND ? ERR_OK : error;
    }
    return files_close(handle);
}

static err_t load_file(const char *file) {
    int handle;
    err_t error = files_open(file, FILES_READ, &handle);
    if (error != ERR_OK) {
        return error == ERR_FILE_NOT_FOUND ? ERR_OK : error;
    }
    char bytes[BLOCK_SIZE];
    size_t got = sizeof bytes;
    bool after_return = false;
    while (error == ERR_OK && got == sizeof bytes) {
        error = files_read(handle, bytes, sizeof bytes, &got);
        if (error == ERR_OK) {
            error = append(bytes, got, &after_return);
        }
    }
    files_close(handle); // nothing was written
    return error;
}

size_t editor_store_size(const char *file) {
    if (file == NULL) {
        return program_length();
    }
    files_entry_t entry;
    return files_info(file, &entry) == ERR_OK ? entry.size : 0;
}

err_t editor_store_load(const char *file) {
    bool after_return = false;
    return file != NULL ? load_file(file) : append(program_text(), program_length(), &after_return);
}

err_t editor_store_save(const char *file) {
    return file != NULL ? files_replace(file, editor_text_flat(), editor_text_length())
                        : program_store_text(editor_text_flat(), editor_text_length());
}

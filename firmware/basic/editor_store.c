// Where the editor's text comes from and goes to. Context: main loop.
#include "editor_store.h"

#include <string.h>

#include "editor_text.h"
#include "program.h"

// Puts text behind what is there, its line ends as \n.
static bool append(const char *bytes, size_t count) {
    while (count > 0) {
        const char *end = memchr(bytes, '\r', count);
        size_t run = end != NULL ? (size_t)(end - bytes) : count;
        if (!editor_text_insert(editor_text_length(), bytes, run)) {
            return false;
        }
        bytes += run;
        count -= run;
        if (count > 0) { // \r, alone or with \n
            bool pair = count > 1 && bytes[1] == '\n';
            if (!pair && !editor_text_insert(editor_text_length(), "\n", 1)) {
                return false;
            }
            bytes++;
            count--;
        }
    }
    return true;
}

err_t editor_store_load(const char *file) {
    (void)file;
    if (!append(program_text(), program_length())) {
        return err_raise(ERR_NO_MEMORY, "%s", "");
    }
    return ERR_OK;
}

err_t editor_store_save(const char *file) {
    (void)file;
    return program_store_text(editor_text_flat(), editor_text_length());
}

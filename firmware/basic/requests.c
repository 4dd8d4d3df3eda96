// Requests of the running code. Context: main loop.
#include "requests.h"

#include <string.h>

#include "actions.h"
#include "errors.h"
#include "files/files.h"

#define EXTENSION ".bas"

static struct {
    char file[FILES_PATH_MAX + 1];
    char argument[VALUE_STRING_MAX - FILES_PATH_MAX]; // not zero-terminated
    size_t argument_length;
} requests;

void requests_program_name(const value_t *name, char *file, size_t size) {
    size_t length = name->length;
    if (length == 0 || length + sizeof EXTENSION > size) {
        errors_fail_with(ERR_FILE_BAD_NAME, "%.*s", (int)length, name->text);
    }
    memcpy(file, name->text, length);
    file[length] = '\0';
    const char *folders_end = strrchr(file, '/');
    if (strchr(folders_end != NULL ? folders_end : file, '.') == NULL) {
        strcpy(file + length, EXTENSION);
    }
}

void requests_clear(void) {
    requests.file[0] = '\0';
    requests.argument_length = 0;
}

void requests_make(vm_request_t request, const value_t *file, const value_t *argument) {
    size_t length = argument != NULL ? argument->length : 0;
    if (length > sizeof requests.argument) {
        errors_fail(ERR_STRING_TOO_LONG);
    }
    requests_clear();
    if (file != NULL && file->length != 0) {
        requests_program_name(file, requests.file, sizeof requests.file);
    }
    if (length != 0) {
        memcpy(requests.argument, argument->text, length);
    }
    requests.argument_length = length;
    actions_stop_with(request);
}

const char *requests_file(void) {
    return requests.file;
}

const char *requests_argument(size_t *length) {
    *length = requests.argument_length;
    return requests.argument;
}

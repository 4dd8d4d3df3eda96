// RUN, NEW, LOAD, SAVE and VAR at run time. Context: main loop.
#include "actions.h"
#include "errors.h"
#include "files/files.h"
#include "program.h"
#include "requests.h"
#include "saved_variables.h"

#define ACTION_BODY(name) void actions_##name(value_t *arguments, unsigned count)

static void expect_string(const value_t *value) {
    if (value->type != VALUE_STRING) {
        errors_fail(ERR_EXPECTED_STRING);
    }
}

// RUN [file$] [, argument$]
ACTION_BODY(run) {
    for (unsigned i = 0; i < count; i++) {
        expect_string(&arguments[i]);
    }
    requests_make(VM_REQUEST_RUN, count > 0 ? &arguments[0] : NULL,
                  count > 1 ? &arguments[1] : NULL);
}

ACTION_BODY(new) {
    (void)arguments;
    (void)count;
    requests_make(VM_REQUEST_NEW, NULL, NULL);
}

// LOAD file$ [, R]
ACTION_BODY(load) {
    (void)count;
    expect_string(&arguments[0]);
    if (arguments[0].length == 0) {
        errors_fail_with(ERR_FILE_BAD_NAME, "%s", "");
    }
    requests_make(value_is_true(&arguments[1]) ? VM_REQUEST_RUN : VM_REQUEST_LOAD, &arguments[0],
                  NULL);
}

ACTION_BODY(save) {
    (void)count;
    expect_string(arguments);
    if (program_length() == 0) {
        errors_fail(ERR_NO_PROGRAM);
    }
    char path[FILES_PATH_MAX + 1];
    requests_program_name(arguments, path, sizeof path);
    if (files_replace(path, program_text(), program_length()) != ERR_OK) {
        errors_fail_raised();
    }
}

ACTION_BODY(var_save) {
    saved_variables_save(arguments, count);
}

ACTION_BODY(var_restore) {
    (void)arguments;
    (void)count;
    saved_variables_restore();
}

ACTION_BODY(var_clear) {
    (void)arguments;
    (void)count;
    saved_variables_clear();
}

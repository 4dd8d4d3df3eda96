// What the sessions share.
#include "fuzz_session.h"

#include <ctype.h>
#include <stdarg.h>
#include <stdio.h>
#include <unistd.h>

#include "hal/hal.h"

#define PLANT_AT_INPUT 20 // late enough for motion to be under way

const char *const fuzz_session_plant_names[FUZZ_PLANT_COUNT] = {
    [FUZZ_PLANT_NONE] = "none",
    [FUZZ_PLANT_CRASH] = "crash",
    [FUZZ_PLANT_LOST_STEP] = "lost-step",
    [FUZZ_PLANT_REFUSED_MOVES] = "refused-moves",
    [FUZZ_PLANT_LONG_ERROR] = "long-error",
    [FUZZ_PLANT_HANG] = "hang",
    [FUZZ_PLANT_DRIVER_WRITE] = "driver-write",
};

fuzz_session_t *fuzz_session;

void fuzz_session_print(const char *label, const fuzz_text_t *text) {
    printf("%s (%zu bytes): ", label, text->length);
    for (size_t i = 0; i < text->length; i++) {
        unsigned char byte = (unsigned char)text->bytes[i];
        if (isprint(byte) && byte != '\\') {
            putchar(byte);
        } else {
            printf("\\x%02x", byte);
        }
    }
    putchar('\n');
}

void fuzz_session_input(const fuzz_text_t *input) {
    fuzz_session->input = *input;
    fuzz_session->inputs++;
    if (fuzz_session->show) {
        fuzz_session_print("input", input);
        fflush(stdout);
    }
    if (fuzz_session_plant_now(FUZZ_PLANT_CRASH)) {
        *(volatile char *)NULL = 0;
    }
    if (fuzz_session_plant_now(FUZZ_PLANT_HANG)) {
        for (;;) {
            pause();
        }
    }
}

void fuzz_session_note(const char *what) {
    if (fuzz_session->show) {
        printf("%llu us: %s\n", (unsigned long long)hal_time_us(), what);
    }
}

bool fuzz_session_plant_now(fuzz_plant_t plant) {
    static bool planted;
    if (fuzz_session->plant != plant || planted || fuzz_session->inputs < PLANT_AT_INPUT) {
        return false;
    }
    planted = true;
    return true;
}

void fuzz_session_fail(const char *format, ...) {
    va_list args;
    va_start(args, format);
    vsnprintf(fuzz_session->failure, sizeof fuzz_session->failure, format, args);
    va_end(args);
    fflush(stdout);
    _exit(1);
}

// What lines mean: each case of tests/gcode/meaning.txt, entry by entry. The same cases run with a
// queue that has room for one entry at a time.
#include <stdio.h>
#include <string.h>
#include <unity.h>

#include "bench.h"
#include "recorder.h"

static unsigned cases, lines, failures;

void setUp(void) {
    bench_start(); // its axes are asked for
    cases = lines = failures = 0;
}

void tearDown(void) {
    bench_end();
}

// Sends a line to a queue that takes one entry now and then.
static err_t send_slowly(const char *text) {
    recorder.room = 1;
    err_t err = recorder_send(text);
    for (unsigned i = 0; i < 1000 && err == ERR_OK && recorder.interpreter.busy; i++) {
        recorder.room = 1;
        gcode_interpreter_background(&recorder.interpreter);
    }
    return err;
}

// The text behind `mark` without blanks at its ends, cut off from `line`; NULL: no mark.
static char *cut(char *line, const char *mark) {
    char *found = strstr(line, mark);
    if (found == NULL) {
        return NULL;
    }
    *found = '\0';
    found += strlen(mark);
    return found + strspn(found, " ");
}

// Each line is told that fails; the test goes on, so that one run shows all.
static void fail(const char *where, const char *expected, const char *found) {
    char text[800];
    snprintf(text, sizeof text, "%s: expected '%s', found '%s'", where, expected, found);
    TEST_MESSAGE(text);
    failures++;
}

static void check_line(const char *where, char *line, bool slowly) {
    const char *message = cut(line, "!!");
    const char *entries = cut(line, "->");
    err_t err = slowly ? send_slowly(line) : recorder_send(line);
    recorder.interpreter.waits = false;
    gcode_interpreter_background(&recorder.interpreter);
    lines++;
    if (message != NULL) {
        if (err == ERR_OK || strcmp(message, err_message()) != 0) {
            fail(where, message, err == ERR_OK ? "accepted" : err_message());
        }
    } else if (err != ERR_OK) {
        fail(where, entries != NULL ? entries : "", err_message());
    } else if (strcmp(entries != NULL ? entries : "", recorder.text) != 0) {
        fail(where, entries != NULL ? entries : "", recorder.text);
    }
}

static void run_cases(bool slowly) {
    char line[300];
    char where[360];
    unsigned number = 0;
    FILE *file = fopen(GCODE_CASES "/meaning.txt", "r");
    TEST_ASSERT_NOT_NULL(file);
    while (fgets(line, sizeof line, file) != NULL) {
        number++;
        line[strcspn(line, "\r\n")] = '\0';
        if (line[0] == '#' || line[0] == '\0') {
            continue;
        }
        if (strncmp(line, "== ", 3) == 0) {
            recorder_start();
            cases++;
            continue;
        }
        snprintf(where, sizeof where, "meaning.txt:%u: %s", number, line);
        check_line(where, line, slowly);
    }
    fclose(file);
    TEST_ASSERT_EQUAL_UINT(0, failures);
}

static void test_all_cases(void) {
    run_cases(false);
    TEST_ASSERT_GREATER_THAN_UINT(25, cases);
    TEST_ASSERT_GREATER_THAN_UINT(150, lines);
}

static void test_all_cases_with_little_room(void) {
    run_cases(true);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_all_cases);
    RUN_TEST(test_all_cases_with_little_room);
    return UNITY_END();
}

// Lines that have to be refused: each of tests/gcode/malformed.txt gives its error and changes
// nothing, neither of what G-code remembers nor of the machine.
#include <stdio.h>
#include <string.h>
#include <unity.h>

#include "bench.h"
#include "gcode/gcode_interpreter.h"
#include "lines.h"

#define LINES_LEAST 300u

static unsigned failures;

// What a refused line may not touch.
typedef struct {
    gcode_state_t state;
    bool busy, waits, ended;
    double target[AXIS_COUNT];
    uint32_t free, bits;
    int32_t steps[AXIS_COUNT];
} picture_t;

void setUp(void) {
    bench_start();
    gcode_reset();
    stepper_limits(AXIS_X, -100, 100);
    stepper_limits(AXIS_Y, -100, 100);
    stepper_limits(AXIS_Z, -50, 50);
}

void tearDown(void) {
    bench_end();
}

static void look(picture_t *picture) {
    memset(picture, 0, sizeof *picture);
    memcpy(&picture->state, &gcode_live.state, sizeof picture->state);
    picture->busy = gcode_live.busy;
    picture->waits = gcode_live.waits;
    picture->ended = gcode_live.ended;
    stepper_target(picture->target);
    picture->free = stepper_blocks_free();
    picture->bits = stepper_status_bits();
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        picture->steps[axis] = stepper_position_steps(axis);
    }
}

// Each line is told that fails; the test goes on, so that one run shows all.
static void fail(const char *where, const char *what) {
    char text[800];
    snprintf(text, sizeof text, "%s: %s", where, what);
    TEST_MESSAGE(text);
    failures++;
}

static void check_refused(const char *where, const char *line, const char *message) {
    picture_t before, after;
    look(&before);
    if (lines_send(line) == ERR_OK) {
        fail(where, "accepted");
        bench_finish(100);
        return;
    }
    if (strcmp(message, err_message()) != 0) {
        fail(where, err_message());
    }
    look(&after);
    if (memcmp(&before, &after, sizeof before) != 0) {
        fail(where, "something has changed");
    }
}

// A line that begins with "== " is sent as it is and has to be accepted: it sets the state up.
static unsigned run_all(void) {
    char text[400];
    char where[460];
    unsigned number = 0;
    unsigned refused = 0;
    FILE *file = fopen(GCODE_CASES "/malformed.txt", "r");
    TEST_ASSERT_NOT_NULL(file);
    while (fgets(text, sizeof text, file) != NULL) {
        number++;
        text[strcspn(text, "\r\n")] = '\0';
        snprintf(where, sizeof where, "malformed.txt:%u: %s", number, text);
        char *message = strstr(text, " !! ");
        if (text[0] == '\0' || strncmp(text, "# ", 2) == 0) {
            continue;
        }
        if (message == NULL) {
            lines_check_ok(text + strspn(text, "= "));
            bench_finish(100);
            continue;
        }
        *message = '\0';
        check_refused(where, text, message + 4);
        refused++;
    }
    fclose(file);
    return refused;
}

static void test_each_is_refused_and_changes_nothing(void) {
    TEST_ASSERT_GREATER_OR_EQUAL_UINT(LINES_LEAST, run_all());
    TEST_ASSERT_EQUAL_UINT(0, failures);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_each_is_refused_and_changes_nothing);
    return UNITY_END();
}

#include "lines.h"

#include <string.h>
#include <unity.h>

#include "gcode/gcode.h"

err_t lines_send(const char *text) {
    return gcode_line(text, strlen(text));
}

void lines_check_ok(const char *text) {
    err_t err = lines_send(text);
    TEST_ASSERT_EQUAL_MESSAGE(ERR_OK, err, err == ERR_OK ? text : err_message());
}

// Channels of a stream, which says little at a time: lines are waited for and cut rightly, what has
// no room waits, and Ctrl-C ends every wait.
#include <string.h>

#include <unity.h>

#include "basic/basic_device.h"
#include "board.h"

#define SENT_SIZE 4000

static struct {
    const char *coming; // what will be received; NULL: nothing more
    uint64_t next_us;   // when the next byte is there
    uint64_t every_us;
    char sent[SENT_SIZE];
    size_t sent_length;
    size_t room; // bytes that can be sent until the time below
    uint64_t room_from_us;
    bool open;
    bool refuses; // the next write fails
    unsigned opened, closed;
    char name[80];
    basic_device_mode_t mode;
} stream;

static bool is_there(void) {
    return *stream.coming != '\0' && board.time_us >= stream.next_us;
}

static err_t open_stream(basic_text_t text, basic_device_mode_t mode, int *handle) {
    if (text.length > sizeof stream.name - 1) {
        return err_raise(ERR_ARGUMENT, "too long");
    }
    memcpy(stream.name, text.text, text.length);
    stream.name[text.length] = '\0';
    stream.mode = mode;
    stream.opened++;
    stream.open = true;
    *handle = 7;
    return ERR_OK;
}

static err_t close_stream(int handle) {
    TEST_ASSERT_EQUAL_INT(7, handle);
    TEST_ASSERT_TRUE(stream.open);
    stream.open = false;
    stream.closed++;
    return ERR_OK;
}

static err_t write_stream(int handle, const void *bytes, size_t size, size_t *took) {
    TEST_ASSERT_EQUAL_INT(7, handle);
    if (stream.refuses) {
        return err_raise(ERR_ARGUMENT, "the wire is cut");
    }
    size_t room = board.time_us >= stream.room_from_us ? SENT_SIZE : stream.room;
    *took = size < room ? size : room;
    stream.room -= board.time_us >= stream.room_from_us ? 0 : *took;
    memcpy(stream.sent + stream.sent_length, bytes, *took);
    stream.sent_length += *took;
    return ERR_OK;
}

static err_t read_stream(int handle, void *bytes, size_t size, size_t *got) {
    TEST_ASSERT_EQUAL_INT(7, handle);
    *got = 0;
    while (*got < size && is_there()) {
        ((char *)bytes)[(*got)++] = *stream.coming++;
        stream.next_us = board.time_us + stream.every_us;
    }
    return ERR_OK;
}

static bool nothing_there(int handle) {
    (void)handle;
    return !is_there();
}

static uint32_t two(int handle) {
    (void)handle;
    return 2;
}

static uint32_t three(int handle) {
    (void)handle;
    return 3;
}

static const basic_device_t device = {
    .name = "COM",
    .open = open_stream,
    .close = close_stream,
    .write = write_stream,
    .read = read_stream,
    .at_end = nothing_there,
    .length = two,
    .position = three,
};

void setUp(void) {
    board_reset();
    memset(&stream, 0, sizeof stream);
    stream.coming = "";
    board.device = &device;
    board_start(NULL, 0, NULL, 0);
    board_shown();
}
void tearDown(void) {}

// Carries lines out; true if `answer` is the last that was shown before the prompt.
static void expect(const char *typed, const char *answer) {
    const char *shown = board_session(typed);
    size_t length = strlen(shown);
    size_t end = strlen(answer) + strlen("\r\n> ");
    TEST_ASSERT_GREATER_THAN_size_t(end, length);
    TEST_ASSERT_EQUAL_STRING_LEN(answer, shown + length - end, strlen(answer));
}

static void test_names_choose_the_device(void) {
    expect("OPEN \"com2:9600,512\" AS #3:PRINT LOF(3);LOC(#3);EOF(3)\r", " 2 3 1");
    TEST_ASSERT_EQUAL_STRING("com2:9600,512", stream.name);
    TEST_ASSERT_EQUAL_INT(BASIC_DEVICE_UNSAID, stream.mode);
    expect("CLOSE 3:OPEN \"COM:x\" FOR OUTPUT AS #3\rPRINT 1\r", " 1");
    TEST_ASSERT_EQUAL_INT(BASIC_DEVICE_OUTPUT, stream.mode);
    expect("CLOSE:OPEN \"COMMENTS\" FOR INPUT AS #1\r", "Error : File not found: /COMMENTS");
    expect("OPEN \"COM\" FOR INPUT AS #1\r", "Error : File not found: /COM");
    TEST_ASSERT_EQUAL_UINT(2, stream.opened);
    TEST_ASSERT_EQUAL_UINT(2, stream.closed);
}

static void test_lines_are_waited_for(void) {
    stream.coming = "one\rtwo\r\nthree\n\rfour\n";
    stream.next_us = 1000000;
    stream.every_us = 1000;
    expect("OPEN \"COM1:\" AS #1:FOR i=1 TO 5:LINE INPUT #1,a$:PRINT \"[\";a$;\"]\";:NEXT:PRINT\r",
           "[one][two][three][][four]");
    TEST_ASSERT_GREATER_OR_EQUAL_UINT64(1020000, board.time_us);
    TEST_ASSERT_LESS_THAN_UINT64(1060000, board.time_us);
}

static void test_a_line_feed_that_comes_late_is_no_line(void) {
    stream.coming = "one\r\ntwo\r\n";
    stream.every_us = 100000;
    expect("OPEN \"COM1:\" AS #1:LINE INPUT #1,a$:PAUSE 500:LINE INPUT #1,b$:PRINT a$;b$\r",
           "onetwo");
}

static void test_a_line_longer_than_a_string_comes_in_parts(void) {
    char line[600];
    memset(line, 'x', 300);
    strcpy(line + 300, "\r\nend\r\n");
    stream.coming = line;
    expect("OPEN \"COM1:\" AS #1:FOR i=1 TO 3:LINE INPUT #1,a$:PRINT LEN(a$);:NEXT:PRINT\r",
           " 255 45 3");
}

static void test_input_takes_fields_and_text_what_is_there(void) {
    stream.coming = "5, \"a b\"\r\nrest";
    expect("OPEN \"COM1:\" AS #1:INPUT #1,a,b$:PRINT a;b$;INPUT$(2,1);INPUT$(99,#1);INPUT$(9,1)\r",
           " 5a brest");
}

static void test_ctrl_c_ends_the_wait_for_a_line(void) {
    board_type_at(700000, "\x03");
    board_session("OPEN \"COM1:\" AS #1:LINE INPUT #1,a$\r");
    TEST_ASSERT_EQUAL_UINT(1, board.breaks);
    TEST_ASSERT_LESS_THAN_UINT64(710000, board.time_us);
}

static void test_what_has_no_room_waits(void) {
    stream.room = 3;
    stream.room_from_us = 400000;
    expect("OPEN \"COM1:\" AS #1:PRINT #1,\"0123456789\";:PRINT 1\r", " 1");
    TEST_ASSERT_EQUAL_size_t(10, stream.sent_length);
    TEST_ASSERT_EQUAL_MEMORY("0123456789", stream.sent, 10);
    TEST_ASSERT_GREATER_OR_EQUAL_UINT64(400000, board.time_us);
}

static void test_ctrl_c_ends_the_wait_for_room(void) {
    stream.room = 3;
    stream.room_from_us = UINT64_MAX;
    board_type_at(700000, "\x03");
    board_session("OPEN \"COM1:\" AS #1:PRINT #1,\"0123456789\"\r");
    TEST_ASSERT_EQUAL_UINT(1, board.breaks);
    TEST_ASSERT_EQUAL_size_t(3, stream.sent_length);
}

static void test_an_error_of_the_device_is_told(void) {
    stream.refuses = true;
    expect("OPEN \"COM1:\" AS #1\rPRINT #1,\"x\"\r", "Error : the wire is cut");
    TEST_ASSERT_TRUE(stream.open);
    expect("SEEK #1,1\r", "Error : Invalid here");
    expect("FLUSH #1:PRINT 2\r", " 2");
}

static void test_a_program_that_ends_closes(void) {
    board_session("AUTOSAVE\rOPEN \"COM1:\" AS #1\rPRINT 1/0\r\x1aRUN\r");
    TEST_ASSERT_EQUAL_UINT(1, stream.opened);
    TEST_ASSERT_FALSE(stream.open);
    TEST_ASSERT_EQUAL_UINT(1, stream.closed);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_names_choose_the_device);
    RUN_TEST(test_lines_are_waited_for);
    RUN_TEST(test_a_line_feed_that_comes_late_is_no_line);
    RUN_TEST(test_a_line_longer_than_a_string_comes_in_parts);
    RUN_TEST(test_input_takes_fields_and_text_what_is_there);
    RUN_TEST(test_ctrl_c_ends_the_wait_for_a_line);
    RUN_TEST(test_what_has_no_room_waits);
    RUN_TEST(test_ctrl_c_ends_the_wait_for_room);
    RUN_TEST(test_an_error_of_the_device_is_told);
    RUN_TEST(test_a_program_that_ends_closes);
    return UNITY_END();
}

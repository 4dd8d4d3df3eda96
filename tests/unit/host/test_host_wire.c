// Exchanges over the simulated serial wires: what a listener hears, what of its answer arrives, and
// what is said of a line with which something is wrong.
#include <unity.h>

#include <string.h>

#include "fixture.h"
#include "hal/hal.h"
#include "hal/hal_wire.h"
#include "host_clock.h"
#include "simulate.h"
#include "simulate_wire.h"

#define TX 5u
#define OTHER_TX 7u
#define OTHER_RX 8u
#define LONELY 9u
#define BAUD 115200u
#define EDGES_MAX 400u

static const hal_wire_t one_pin = {.tx_gpio = TX, .rx_gpio = TX, .baud = BAUD};
static const hal_wire_t two_pins = {.tx_gpio = OTHER_TX, .rx_gpio = OTHER_RX, .baud = BAUD};
static const hal_wire_t lonely = {.tx_gpio = LONELY, .rx_gpio = LONELY, .baud = BAUD};
static const uint8_t request[4] = {0x05, 0x00, 0x06, 0x6F};

// What the listeners heard and what they answer.
static struct {
    unsigned number;
    simulate_wire_words_t heard;
    uint64_t end_ns;
    unsigned frames;
    simulate_wire_words_t answer; // start_ns counts from the end of the frame
} chips[2];

static struct {
    uint64_t time_ns;
    uint32_t levels;
} edges[EDGES_MAX];
static unsigned edge_count;

static void note_edge(void *state, uint64_t time_ns, uint32_t changed, uint32_t levels) {
    (void)state;
    if ((changed & pins_mask(TX)) != 0 && edge_count < EDGES_MAX) {
        edges[edge_count].time_ns = time_ns;
        edges[edge_count++].levels = levels & pins_mask(TX);
    }
}

static void on_frame(void *state, const simulate_wire_words_t *words, uint64_t end_ns) {
    unsigned chip = *(const unsigned *)state;
    chips[chip].heard = *words;
    chips[chip].end_ns = end_ns;
    chips[chip].frames++;
    simulate_wire_words_t answer = chips[chip].answer;
    answer.start_ns += end_ns;
    simulate_wire_say(chips[chip].number, &answer);
}

void setUp(void) {
    hal_wire_abort();
    for (unsigned i = 0; i < 2; i++) {
        chips[i].frames = 0;
        memset(&chips[i].answer, 0, sizeof chips[i].answer);
        simulate_wire_say(chips[i].number, &chips[i].answer);
        simulate_wire_hold(chips[i].number, false);
    }
    hal_wire_open(&one_pin);
    hal_wire_open(&two_pins);
    hal_wire_open(&lonely);
    host_clock_run(host_clock_now_ns() + 20000000, false);
    edge_count = 0;
}

void tearDown(void) {
    hal_wire_close(&one_pin);
    hal_wire_close(&two_pins);
    hal_wire_close(&lonely);
}

static uint64_t bits_ns(double bits) {
    return (uint64_t)(bits * 1e9 / BAUD + 0.5);
}

// Chip `chip` answers a frame with these bytes, so many bits behind it.
static void let_answer(unsigned chip, const char *bytes, double delay_bits) {
    chips[chip].answer.size = strlen(bytes);
    memcpy(chips[chip].answer.bytes, bytes, strlen(bytes));
    chips[chip].answer.start_ns = bits_ns(delay_bits);
    chips[chip].answer.baud = BAUD;
}

static hal_wire_state_t finish(uint8_t *reply) {
    uint64_t again_us = 0;
    hal_wire_state_t state;
    while ((state = hal_wire_poll(reply, &again_us)) == HAL_WIRE_BUSY) {
        TEST_ASSERT_GREATER_THAN_UINT64(hal_time_us(), again_us);
        host_clock_run(again_us * 1000, false);
    }
    return state;
}

static hal_wire_state_t exchange(const hal_wire_t *wire, uint8_t *reply) {
    memset(reply, 0, HAL_WIRE_REPLY_MAX);
    hal_wire_start(wire, request, sizeof request, HAL_WIRE_REPLY_MAX);
    return finish(reply);
}

static void test_frame_has_exact_edges_and_none_before(void) {
    static const uint32_t bauds[] = {9600, 19200, 115200, 250000, 500000};
    for (unsigned i = 0; i < COUNT_OF_ARRAY(bauds); i++) {
        hal_wire_t wire = one_pin;
        wire.baud = bauds[i];
        static const uint8_t send[8] = {0x55, 0x55, 0x55, 0x55, 0x55, 0x55, 0x55, 0x55};
        uint8_t reply[HAL_WIRE_REPLY_MAX];
        edge_count = 0;
        hal_wire_start(&wire, send, sizeof send, 0);
        TEST_ASSERT_EQUAL(HAL_WIRE_DONE, finish(reply));
        TEST_ASSERT_EQUAL(80, edge_count); // each bit differs from the one before
        for (unsigned n = 0; n < edge_count; n++) {
            TEST_ASSERT_EQUAL(n % 2 == 1, edges[n].levels != 0);
            double ideal_ns = (double)edges[0].time_ns + n * 1e9 / bauds[i];
            TEST_ASSERT_DOUBLE_WITHIN(1.0, ideal_ns, (double)edges[n].time_ns);
        }
        TEST_ASSERT_EQUAL(i + 1, chips[0].frames);
        TEST_ASSERT_EQUAL_MEMORY(send, chips[0].heard.bytes, sizeof send);
        double end_ns = (double)edges[0].time_ns + 80e9 / bauds[i];
        TEST_ASSERT_DOUBLE_WITHIN(1.0, end_ns, (double)chips[0].end_ns);
    }
}

static void test_reply_of_one_and_of_two_pins(void) {
    uint8_t reply[HAL_WIRE_REPLY_MAX];
    for (unsigned chip = 0; chip < 2; chip++) {
        let_answer(chip, "\x05\xFF\x06\x21\x55\xAA\x7F\x80", 8.0);
        TEST_ASSERT_EQUAL(HAL_WIRE_DONE, exchange(chip == 0 ? &one_pin : &two_pins, reply));
        TEST_ASSERT_EQUAL_MEMORY(chips[chip].answer.bytes, reply, sizeof reply);
        TEST_ASSERT_EQUAL(1, chips[chip].frames);
        TEST_ASSERT_EQUAL(chip, chips[1 - chip].frames); // the other one heard nothing of this
    }
}

// The answering chip has its own clock, and begins at any phase.
static void test_reply_of_a_clock_that_is_off(void) {
    uint8_t reply[HAL_WIRE_REPLY_MAX];
    for (int percent = -4; percent <= 4; percent++) {
        for (double phase = 0.0; phase < 1.0; phase += 0.09) {
            let_answer(0, "\x05\xFF\x06\x01\xFE\xAA\x55\x80", 16.0 + phase);
            chips[0].answer.baud = BAUD * (1.0 + percent / 100.0);
            TEST_ASSERT_EQUAL(HAL_WIRE_DONE, exchange(&one_pin, reply));
            TEST_ASSERT_EQUAL_MEMORY(chips[0].answer.bytes, reply, sizeof reply);
        }
    }
}

static void test_latest_reply_and_one_that_is_late(void) {
    uint8_t reply[HAL_WIRE_REPLY_MAX];
    let_answer(0, "\x05\xFF\x06\x01\xFE\xAA\x55\x80", HAL_WIRE_REPLY_LATEST_BITS);
    TEST_ASSERT_EQUAL(HAL_WIRE_DONE, exchange(&one_pin, reply));
    let_answer(0, "\x05\xFF\x06\x01\xFE\xAA\x55\x80", HAL_WIRE_REPLY_LATEST_BITS + 40);
    TEST_ASSERT_EQUAL(HAL_WIRE_SILENT, exchange(&one_pin, reply));
}

static void test_no_reply_and_half_of_one(void) {
    uint8_t reply[HAL_WIRE_REPLY_MAX];
    uint64_t begin_us = hal_time_us();
    TEST_ASSERT_EQUAL(HAL_WIRE_SILENT, exchange(&lonely, reply));
    uint64_t took_us = hal_time_us() - begin_us;
    TEST_ASSERT_LESS_THAN_UINT64(bits_ns(11 + 40 + 128 + 80 + 30) / 1000, took_us);
    let_answer(0, "\x05\xFF\x06\x01", 8.0);
    TEST_ASSERT_EQUAL(HAL_WIRE_SILENT, exchange(&one_pin, reply));
    TEST_ASSERT_EQUAL(1, chips[0].frames);
    let_answer(0, "\x05\xFF\x06\x01\xFE\xAA\x55\x80", 8.0);
    TEST_ASSERT_EQUAL(HAL_WIRE_DONE, exchange(&one_pin, reply));
}

static void test_missing_stop_bit(void) {
    uint8_t reply[HAL_WIRE_REPLY_MAX];
    for (unsigned byte = 0; byte < 7; byte++) {
        let_answer(0, "\x05\xFF\x06\x01\xFE\xAA\x55\xFF", 8.0);
        chips[0].answer.no_stop_bytes = 1u << byte;
        TEST_ASSERT_NOT_EQUAL(HAL_WIRE_DONE, exchange(&one_pin, reply));
    }
    let_answer(0, "\x05\xFF\x06\x01\xFE\xAA\x55\xFF", 8.0);
    chips[0].answer.no_stop_bytes = 1u << 7;
    TEST_ASSERT_EQUAL(HAL_WIRE_GARBLED, exchange(&one_pin, reply));
}

static void test_held_line(void) {
    uint8_t reply[HAL_WIRE_REPLY_MAX];
    simulate_wire_hold(chips[0].number, true);
    TEST_ASSERT_EQUAL(HAL_WIRE_HELD_LOW, exchange(&one_pin, reply));
    TEST_ASSERT_EQUAL(0, chips[0].frames);
    hal_wire_start(&one_pin, request, sizeof request, 0); // nobody is expected to answer
    TEST_ASSERT_EQUAL(HAL_WIRE_DONE, finish(reply));
    TEST_ASSERT_EQUAL(1, chips[0].frames);
    simulate_wire_hold(chips[1].number, true);
    TEST_ASSERT_EQUAL(HAL_WIRE_HELD_LOW, exchange(&two_pins, reply));
    TEST_ASSERT_EQUAL(0, chips[1].frames);
}

// A late answer is on the line: the request waits until it is over.
static void test_busy_line_is_waited_for(void) {
    uint8_t reply[HAL_WIRE_REPLY_MAX];
    simulate_wire_words_t late = {.bytes = {0, 0xFF, 0, 0xAA},
                                  .size = 4,
                                  .start_ns = host_clock_now_ns() + bits_ns(3),
                                  .baud = BAUD};
    simulate_wire_say(chips[0].number, &late);
    let_answer(0, "\x05\xFF\x06\x01\xFE\xAA\x55\x80", 8.0);
    uint64_t begin_ns = host_clock_now_ns();
    TEST_ASSERT_EQUAL(HAL_WIRE_DONE, exchange(&one_pin, reply));
    TEST_ASSERT_EQUAL_MEMORY(chips[0].answer.bytes, reply, sizeof reply);
    // Its last low bit is the one before the stop bit, or 0xAA's bit 6.
    TEST_ASSERT_GREATER_THAN_UINT64(begin_ns + bits_ns(3 + 38 + 11), chips[0].heard.start_ns);
}

static void test_abort_in_the_middle(void) {
    uint8_t reply[HAL_WIRE_REPLY_MAX];
    let_answer(0, "\x05\xFF\x06\x01\xFE\xAA\x55\x80", 8.0);
    for (unsigned bits = 1; bits < 140; bits += 3) {
        hal_wire_start(&one_pin, request, sizeof request, HAL_WIRE_REPLY_MAX);
        host_clock_run(host_clock_now_ns() + bits_ns(bits), false);
        hal_wire_abort();
        host_clock_run(host_clock_now_ns() + bits_ns(200), false);
        TEST_ASSERT_TRUE((hal_pins_read() & pins_mask(TX)) != 0);
        TEST_ASSERT_EQUAL(HAL_WIRE_DONE, exchange(&one_pin, reply));
        TEST_ASSERT_EQUAL_MEMORY(chips[0].answer.bytes, reply, sizeof reply);
    }
}

static void test_close_is_for_one_wire(void) {
    uint8_t reply[HAL_WIRE_REPLY_MAX];
    let_answer(0, "\x05\xFF\x06\x01\xFE\xAA\x55\x80", 8.0);
    hal_wire_start(&one_pin, request, sizeof request, HAL_WIRE_REPLY_MAX);
    hal_wire_close(&two_pins);
    TEST_ASSERT_EQUAL(HAL_WIRE_DONE, finish(reply));
    hal_wire_start(&one_pin, request, sizeof request, HAL_WIRE_REPLY_MAX);
    hal_wire_close(&one_pin);
    host_clock_run(host_clock_now_ns() + bits_ns(200), false);
    TEST_ASSERT_EQUAL(1, chips[0].frames);
    TEST_ASSERT_EQUAL(HOST_CLOCK_NEVER, host_clock_next_event_ns());
}

int main(void) {
    static const unsigned indexes[2] = {0, 1};
    static const simulate_wire_listener_t listeners[2] = {
        {.tx_gpio = TX, .rx_gpio = TX, .frame = on_frame, .state = (void *)&indexes[0]},
        {.tx_gpio = OTHER_TX, .rx_gpio = OTHER_RX, .frame = on_frame, .state = (void *)&indexes[1]},
    };
    chips[0].number = simulate_wire_attach(&listeners[0]);
    chips[1].number = simulate_wire_attach(&listeners[1]);
    simulate_observe(note_edge, NULL);
    UNITY_BEGIN();
    RUN_TEST(test_frame_has_exact_edges_and_none_before);
    RUN_TEST(test_reply_of_one_and_of_two_pins);
    RUN_TEST(test_reply_of_a_clock_that_is_off);
    RUN_TEST(test_latest_reply_and_one_that_is_late);
    RUN_TEST(test_no_reply_and_half_of_one);
    RUN_TEST(test_missing_stop_bit);
    RUN_TEST(test_held_line);
    RUN_TEST(test_busy_line_is_waited_for);
    RUN_TEST(test_abort_in_the_middle);
    RUN_TEST(test_close_is_for_one_wire);
    return UNITY_END();
}

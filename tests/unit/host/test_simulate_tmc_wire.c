// Simulated drivers at their wire, by bytes and through the seam: what counts as a datagram, when
// and what they answer, each fault.
#include <string.h>
#include <unity.h>

#include "fixture.h"
#include "hal/hal.h"
#include "hal/hal_wire.h"
#include "host_clock.h"
#include "simulate_tmc_wire.h"

#define TX 26u
#define BAUD 115200.0
#define BIT_NS (1e9 / BAUD)

enum { GCONF = 0x00, IFCNT = 0x02, SLAVECONF = 0x03, IOIN = 0x06, SGTHRS = 0x40, CHOPCONF = 0x6C };

static simulate_tmc_t chip;
static simulate_tmc_wire_t wire;
static simulate_wire_words_t answer;
static uint64_t now_ns;

void setUp(void) {
    simulate_tmc_init(&chip);
    simulate_tmc_reset(&chip, 0);
    wire = (simulate_tmc_wire_t){.tmc = &chip, .random = 77};
    now_ns = 1000000;
}
void tearDown(void) {}

// Says bytes without pauses, after `gap_bits` of silence. True: there is an answer.
static bool say(const uint8_t *bytes, size_t size, double gap_bits, double baud) {
    simulate_wire_words_t words = {.size = size, .baud = baud};
    memcpy(words.bytes, bytes, size);
    words.start_ns = now_ns + (uint64_t)(gap_bits * 1e9 / baud);
    now_ns = words.start_ns + (uint64_t)((double)size * 10e9 / baud);
    return simulate_tmc_wire_hear(&wire, &words, now_ns, &answer);
}

static void write_from(unsigned address, uint8_t reg, uint32_t value, double gap_bits) {
    uint8_t bytes[8] = {5,
                        (uint8_t)address,
                        reg | 0x80,
                        (uint8_t)(value >> 24),
                        (uint8_t)(value >> 16),
                        (uint8_t)(value >> 8),
                        (uint8_t)value};
    bytes[7] = simulate_tmc_wire_checksum(bytes, 7);
    TEST_ASSERT_FALSE(say(bytes, sizeof bytes, gap_bits, BAUD));
}

static void write_register(uint8_t reg, uint32_t value) {
    write_from(0, reg, value, 20);
}

static bool ask_at(uint8_t reg, double baud) {
    uint8_t bytes[4] = {5, (uint8_t)chip.address, reg};
    bytes[3] = simulate_tmc_wire_checksum(bytes, 3);
    return say(bytes, sizeof bytes, 20, baud);
}

static bool ask(uint8_t reg) {
    return ask_at(reg, BAUD);
}

static bool is_checked(void) {
    return answer.bytes[7] == simulate_tmc_wire_checksum(answer.bytes, 7);
}

// The value that is answered, of a datagram that is right in all respects.
static uint32_t asked(uint8_t reg) {
    TEST_ASSERT_TRUE(ask(reg));
    TEST_ASSERT_EQUAL_UINT(8, answer.size);
    TEST_ASSERT_EQUAL_HEX8(0x05, answer.bytes[0]);
    TEST_ASSERT_EQUAL_HEX8(0xFF, answer.bytes[1]);
    TEST_ASSERT_EQUAL_HEX8(reg, answer.bytes[2]);
    TEST_ASSERT_TRUE(is_checked());
    TEST_ASSERT_EQUAL_UINT32(0, answer.no_stop_bytes);
    return (uint32_t)answer.bytes[3] << 24 | (uint32_t)answer.bytes[4] << 16 |
           (uint32_t)answer.bytes[5] << 8 | answer.bytes[6];
}

// ---- Datagrams ----------------------------------------------------------------------------------

// Recorded from a machine that is in use.
static void test_recorded_frames_are_taken(void) {
    static const uint8_t frames[][8] = {
        {0x05, 0x00, 0x80, 0x00, 0x00, 0x01, 0xC0, 0xF6},
        {0x05, 0x00, 0x90, 0x00, 0x08, 0x19, 0x07, 0x15},
        {0x05, 0x00, 0x91, 0x00, 0x00, 0x00, 0x14, 0x1F},
        {0x05, 0x00, 0xEC, 0x14, 0x03, 0x01, 0x53, 0x69},
        {0x05, 0x00, 0xF0, 0xCF, 0x0D, 0x0E, 0x24, 0x96},
        {0x05, 0x00, 0x94, 0x00, 0x00, 0x00, 0xC8, 0x4D},
        {0x05, 0x00, 0xC0, 0x00, 0x00, 0x00, 0x78, 0xD7},
    };
    for (unsigned i = 0; i < COUNT_OF_ARRAY(frames); i++) {
        TEST_ASSERT_FALSE(say(frames[i], 8, 23, BAUD));
        TEST_ASSERT_EQUAL_UINT32(i + 1, asked(IFCNT));
    }
    TEST_ASSERT_EQUAL_HEX32(0x1C0, asked(GCONF));
    TEST_ASSERT_EQUAL_HEX32(0x14030153, asked(CHOPCONF));
    TEST_ASSERT_EQUAL_UINT32(120, simulate_tmc_register(&chip, SGTHRS, now_ns));
    TEST_ASSERT_EQUAL_UINT32(16, simulate_tmc_microsteps(&chip));
}

static void test_every_wrong_bit_of_a_write_is_noticed(void) {
    static const uint8_t good[8] = {0x05, 0x00, 0xC0, 0x00, 0x00, 0x00, 0x78, 0xD7};
    for (unsigned bit = 0; bit < 64; bit++) {
        uint8_t bytes[8];
        memcpy(bytes, good, sizeof bytes);
        bytes[bit / 8] ^= (uint8_t)(1u << bit % 8);
        TEST_ASSERT_FALSE(say(bytes, 8, 70, BAUD));
    }
    now_ns += 1000000;
    TEST_ASSERT_EQUAL_UINT32(0, asked(IFCNT));
    TEST_ASSERT_EQUAL_UINT32(0, simulate_tmc_register(&chip, SGTHRS, now_ns));
}

static void test_other_addresses_are_not_for_it(void) {
    chip.address = 2;
    write_from(0, SGTHRS, 9, 20);
    write_from(1, SGTHRS, 9, 20);
    write_from(3, SGTHRS, 9, 20);
    TEST_ASSERT_EQUAL_UINT32(0, asked(IFCNT));
    write_from(2, SGTHRS, 9, 20);
    TEST_ASSERT_EQUAL_UINT32(1, asked(IFCNT));
    TEST_ASSERT_EQUAL_UINT32(0, chip.bad_frames);
}

static void test_behind_an_error_it_wants_silence(void) {
    static const uint8_t bad[4] = {0x05, 0x00, 0x02, 0x00};
    TEST_ASSERT_FALSE(say(bad, 4, 20, BAUD));
    write_from(0, SGTHRS, 9, 11);
    TEST_ASSERT_EQUAL_UINT32(0, simulate_tmc_register(&chip, SGTHRS, now_ns));
    write_from(0, SGTHRS, 9, 13);
    TEST_ASSERT_EQUAL_UINT32(9, simulate_tmc_register(&chip, SGTHRS, now_ns));
}

static void test_half_a_datagram_is_forgotten_in_a_pause(void) {
    static const uint8_t half[2] = {0x05, 0x00};
    TEST_ASSERT_FALSE(say(half, 2, 20, BAUD));
    write_from(0, SGTHRS, 9, 50); // joined to the first half: an error
    TEST_ASSERT_EQUAL_UINT32(0, simulate_tmc_register(&chip, SGTHRS, now_ns));
    TEST_ASSERT_FALSE(say(half, 2, 20, BAUD));
    write_from(0, SGTHRS, 9, 54); // 64 from start bit to start bit
    TEST_ASSERT_EQUAL_UINT32(9, simulate_tmc_register(&chip, SGTHRS, now_ns));
}

static void test_speeds_it_cannot_follow(void) {
    TEST_ASSERT_FALSE(ask_at(IFCNT, 8000));
    TEST_ASSERT_TRUE(ask_at(IFCNT, 9600));
    TEST_ASSERT_TRUE(ask_at(IFCNT, 500000));
    TEST_ASSERT_FALSE(ask_at(IFCNT, 800000)); // 12 MHz / 16 is the end
}

// ---- Answers ------------------------------------------------------------------------------------

static void test_the_answer_waits_for_senddelay(void) {
    for (unsigned setting = 0; setting < 16; setting++) {
        write_register(SLAVECONF, setting << 8);
        TEST_ASSERT_TRUE(ask(IOIN));
        double bits = (double)(answer.start_ns - now_ns) / BIT_NS;
        TEST_ASSERT_DOUBLE_WITHIN(0.01, setting < 2 ? 8 : 8 * (setting | 1), bits);
        TEST_ASSERT_DOUBLE_WITHIN(1e-6, BAUD, answer.baud);
        now_ns = answer.start_ns + 1000000;
    }
    chip.skew_1000 = -20;
    TEST_ASSERT_TRUE(ask(IOIN));
    TEST_ASSERT_DOUBLE_WITHIN(1.0, BAUD * 0.98, answer.baud);
}

static void test_writes_are_not_answered_and_all_of_them_count(void) {
    write_register(SGTHRS, 1);
    write_register(IOIN, 1); // only readable
    write_register(0x55, 1); // not there
    TEST_ASSERT_EQUAL_UINT32(3, asked(IFCNT));
    TEST_ASSERT_EQUAL_UINT32(0, asked(SGTHRS)); // only writable
    TEST_ASSERT_EQUAL_UINT32(0, asked(0x55));
    for (unsigned i = 3; i < 256; i++) {
        write_register(SGTHRS, i);
    }
    TEST_ASSERT_EQUAL_UINT32(0, asked(IFCNT));
}

// ---- Faults -------------------------------------------------------------------------------------

static void set_fault(simulate_chip_fault_t fault, int32_t frames) {
    simulate_faults_set(&chip.faults, fault, now_ns, UINT64_MAX);
    simulate_faults_limit(&chip.faults, fault, frames);
}

static void test_silent_takes_and_says_nothing(void) {
    set_fault(SIMULATE_CHIP_SILENT, 2);
    TEST_ASSERT_FALSE(ask(IFCNT));
    write_register(SGTHRS, 7); // does not use it up: there was nothing to say
    TEST_ASSERT_FALSE(ask(IFCNT));
    TEST_ASSERT_EQUAL_UINT32(1, asked(IFCNT));
}

static void test_deaf_and_unplugged_take_nothing(void) {
    static const simulate_chip_fault_t faults[] = {SIMULATE_CHIP_DEAF, SIMULATE_CHIP_UNPLUGGED};
    for (unsigned i = 0; i < COUNT_OF_ARRAY(faults); i++) {
        set_fault(faults[i], 2);
        write_register(SGTHRS, 7);
        write_from(3, SGTHRS, 8, 20); // for another driver: does not count
        TEST_ASSERT_FALSE(ask(IFCNT));
        TEST_ASSERT_EQUAL_UINT32(0, asked(IFCNT));
    }
}

static void test_bad_crc_is_only_the_checksum(void) {
    set_fault(SIMULATE_CHIP_BAD_CRC, 1);
    TEST_ASSERT_TRUE(ask(IOIN));
    TEST_ASSERT_FALSE(is_checked());
    TEST_ASSERT_EQUAL_HEX8(0x21, answer.bytes[3]);
    TEST_ASSERT_EQUAL_HEX32(0x21, asked(IOIN) >> 24);
}

static void test_late_is_late_and_then_it_hears_nothing_else(void) {
    for (unsigned i = 0; i < 50; i++) {
        set_fault(SIMULATE_CHIP_LATE, 1);
        TEST_ASSERT_TRUE(ask(IOIN));
        double late_ms = (double)(answer.start_ns - now_ns) / 1e6 - 8 * BIT_NS / 1e6;
        TEST_ASSERT_GREATER_OR_EQUAL_INT(2000, (int)(late_ms * 1000 + 0.5));
        TEST_ASSERT_LESS_OR_EQUAL_INT(10000, (int)(late_ms * 1000));
    }
    wire.answers_ns = now_ns + 5000000;
    TEST_ASSERT_FALSE(ask(IFCNT));
    write_register(SGTHRS, 3); // is taken all the same
    now_ns += 6000000;
    TEST_ASSERT_EQUAL_UINT32(1, asked(IFCNT));
}

static void test_garbled_is_never_mistaken(void) {
    unsigned lost = 0;
    unsigned spoiled = 0;
    for (unsigned i = 0; i < 300; i++) {
        set_fault(SIMULATE_CHIP_GARBLED, 1);
        now_ns += 1000000;
        if (!ask(IOIN)) {
            lost++;
        } else {
            spoiled++;
            bool start = answer.bytes[0] == 5 && answer.bytes[1] == 0xFF;
            TEST_ASSERT_FALSE(is_checked() && start && answer.no_stop_bytes == 0);
        }
        set_fault(SIMULATE_CHIP_GARBLED, 1);
        now_ns += 1000000;
        write_register(SGTHRS, 7);
    }
    now_ns += 1000000;
    TEST_ASSERT_EQUAL_UINT32(0, asked(IFCNT));
    TEST_ASSERT_GREATER_THAN_UINT32(100, lost);
    TEST_ASSERT_GREATER_THAN_UINT32(100, spoiled);
}

static void test_names_of_faults(void) {
    for (unsigned i = 0; i < SIMULATE_CHIP_FAULTS; i++) {
        const char *name = simulate_faults_name((simulate_chip_fault_t)i);
        TEST_ASSERT_EQUAL_UINT(i, simulate_faults_by_name(name, strlen(name)));
    }
    TEST_ASSERT_EQUAL_UINT(SIMULATE_CHIP_FAULTS, simulate_faults_by_name("late!", 5));
    TEST_ASSERT_EQUAL_UINT(SIMULATE_CHIP_FAULTS, simulate_faults_by_name("lat", 3));
}

// ---- Through the seam ---------------------------------------------------------------------------

static simulate_tmc_t first, second;

static hal_wire_state_t exchange(unsigned address, uint8_t reg, uint8_t reply[8]) {
    hal_wire_t pins = {.tx_gpio = TX, .rx_gpio = TX, .baud = 115200};
    uint8_t bytes[4] = {5, (uint8_t)address, reg};
    uint64_t again_us = 0;
    bytes[3] = simulate_tmc_wire_checksum(bytes, 3);
    hal_wire_start(&pins, bytes, sizeof bytes, 8);
    hal_wire_state_t state;
    while ((state = hal_wire_poll(reply, &again_us)) == HAL_WIRE_BUSY) {
        host_clock_run(again_us * 1000, false);
    }
    return state;
}

static void test_two_drivers_on_a_wire_answer_for_themselves(void) {
    uint8_t reply[8] = {0};
    TEST_ASSERT_EQUAL(HAL_WIRE_DONE, exchange(0, IOIN, reply));
    TEST_ASSERT_EQUAL_HEX8(0x21, reply[3]);
    TEST_ASSERT_EQUAL_HEX8(0x40, reply[6]); // MS1, MS2 low; the wire high
    TEST_ASSERT_EQUAL(HAL_WIRE_DONE, exchange(1, IOIN, reply));
    TEST_ASSERT_EQUAL_HEX8(0x44, reply[6]);
    TEST_ASSERT_EQUAL(HAL_WIRE_SILENT, exchange(2, IOIN, reply));
}

// The driver that is not asked takes the answer for a broken request.
static void test_an_answer_upsets_the_other_driver(void) {
    uint8_t reply[8];
    host_clock_run(host_clock_now_ns() + 1000000, false);
    uint32_t before = second.bad_frames;
    TEST_ASSERT_EQUAL(HAL_WIRE_DONE, exchange(0, IOIN, reply));
    TEST_ASSERT_EQUAL_UINT32(before + 1, second.bad_frames);
    simulate_tmc_write(&second, SLAVECONF, 2u << 8, host_clock_now_ns());
    host_clock_run(host_clock_now_ns() + 1000000, false);
    TEST_ASSERT_EQUAL(HAL_WIRE_DONE, exchange(0, IOIN, reply));
    TEST_ASSERT_EQUAL_UINT32(before + 1, second.bad_frames);
}

static void test_a_driver_without_supply_holds_the_wire(void) {
    uint8_t reply[8];
    simulate_faults_set(&second.faults, SIMULATE_CHIP_UNPOWERED, host_clock_now_ns() + 5000000,
                        UINT64_MAX);
    TEST_ASSERT_EQUAL(HAL_WIRE_DONE, exchange(0, IOIN, reply));
    host_clock_run(host_clock_now_ns() + 5000000, false);
    TEST_ASSERT_EQUAL(HAL_WIRE_HELD_LOW, exchange(0, IOIN, reply));
}

static void connect(simulate_tmc_t *tmc, unsigned address) {
    simulate_tmc_init(tmc);
    tmc->address = address;
    tmc->tx_gpio = TX;
    tmc->rx_gpio = TX;
    TEST_ASSERT_TRUE(simulate_tmc_attach(tmc));
    TEST_ASSERT_TRUE(simulate_tmc_wire_attach(tmc));
}

int main(void) {
    UNITY_BEGIN();
    hal_wire_open(&(hal_wire_t){.tx_gpio = TX, .rx_gpio = TX, .baud = 115200});
    connect(&first, 0);
    connect(&second, 1);
    RUN_TEST(test_recorded_frames_are_taken);
    RUN_TEST(test_every_wrong_bit_of_a_write_is_noticed);
    RUN_TEST(test_other_addresses_are_not_for_it);
    RUN_TEST(test_behind_an_error_it_wants_silence);
    RUN_TEST(test_half_a_datagram_is_forgotten_in_a_pause);
    RUN_TEST(test_speeds_it_cannot_follow);
    RUN_TEST(test_the_answer_waits_for_senddelay);
    RUN_TEST(test_writes_are_not_answered_and_all_of_them_count);
    RUN_TEST(test_silent_takes_and_says_nothing);
    RUN_TEST(test_deaf_and_unplugged_take_nothing);
    RUN_TEST(test_bad_crc_is_only_the_checksum);
    RUN_TEST(test_late_is_late_and_then_it_hears_nothing_else);
    RUN_TEST(test_garbled_is_never_mistaken);
    RUN_TEST(test_names_of_faults);
    RUN_TEST(test_two_drivers_on_a_wire_answer_for_themselves);
    RUN_TEST(test_an_answer_upsets_the_other_driver);
    RUN_TEST(test_a_driver_without_supply_holds_the_wire);
    return UNITY_END();
}

// Beginning, waiting, and the ends of jobs.
#include "bench.h"

#include <stdio.h>
#include <unity.h>

const tmc22xx_settings_t bench_usual = {.tx_gpio = BENCH_WIRE,
                                        .address = 0,
                                        .chip = 2209,
                                        .run_ma = 800,
                                        .hold_percent = 30,
                                        .microsteps = 16,
                                        .r_sense_ohm = 0.11,
                                        .stealth = true};
static char words[40 * LINE_FRAMES];

err_t bench_end(err_t begun) {
    TEST_ASSERT_EQUAL_STRING_MESSAGE("", begun == ERR_OK ? "" : err_message(), "at once");
    line_run();
    return tmc22xx_result();
}

void bench_succeeds(err_t begun) {
    err_t err = bench_end(begun);
    TEST_ASSERT_EQUAL_STRING("", err == ERR_OK ? "" : err_message());
}

void bench_fails(err_t begun, const char *message) {
    TEST_ASSERT_NOT_EQUAL(ERR_OK, bench_end(begun));
    TEST_ASSERT_EQUAL_STRING(message, err_message());
}

void bench_refused(err_t begun, const char *message) {
    TEST_ASSERT_NOT_EQUAL(ERR_OK, begun);
    TEST_ASSERT_EQUAL_STRING(message, err_message());
    TEST_ASSERT_FALSE(tmc22xx_busy());
}

tmc22xx_settings_t bench_settings(uint8_t tx_gpio, uint8_t address) {
    tmc22xx_settings_t settings = bench_usual;
    settings.tx_gpio = tx_gpio;
    settings.address = address;
    return settings;
}

unsigned bench_set_up(uint8_t tx_gpio, uint8_t address) {
    tmc22xx_settings_t settings = bench_settings(tx_gpio, address);
    bench_succeeds(tmc22xx_set_up(&settings));
    unsigned driver = 99;
    TEST_ASSERT_EQUAL(ERR_OK, tmc22xx_find(address, tx_gpio, &driver));
    return driver;
}

const char *bench_sent(void) {
    size_t length = 0;
    words[0] = 0;
    for (size_t i = 0; i < line.frame_count && i < LINE_FRAMES; i++) {
        const uint8_t *bytes = line.frames[i].bytes;
        if (line.frames[i].size == 8) {
            length += (size_t)sprintf(words + length, "W%02X %02X%02X%02X%02X ", bytes[2] & 0x7F,
                                      bytes[3], bytes[4], bytes[5], bytes[6]);
        } else {
            length += (size_t)sprintf(words + length, "R%02X ", bytes[2]);
        }
    }
    return words;
}

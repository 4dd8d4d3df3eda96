// Exchanges over a serial wire for a test that plays the chip at its other end. Context: main.
#include "wire_check.h"

#include <stdlib.h>

#include "hal/hal.h"
#include "hal/hal_wire.h"

static char answer[100];

static const char *next_number(const char *text, uint32_t *number) {
    char *end;
    *number = strtoul(text, &end, 10);
    return end;
}

static const char *finish(size_t reply_size) {
    static const char *const states[] = {"busy", "done", "silent", "garbled", "held"};
    uint8_t reply[HAL_WIRE_REPLY_MAX] = {0};
    uint64_t again_us = 0;
    unsigned polls = 1;
    hal_wire_state_t state;
    while ((state = hal_wire_poll(reply, &again_us)) == HAL_WIRE_BUSY) {
        polls++;
        hal_idle(again_us);
    }
    size_t length = format_text(answer, sizeof answer, "%s %u", states[state], polls);
    for (size_t i = 0; i < reply_size && length < sizeof answer; i++) {
        length += format_text(answer + length, sizeof answer - length, " %u", reply[i]);
    }
    return answer;
}

const char *wire_check(const char *line) {
    char command = *line++;
    uint32_t after_us = 0;
    if (command == 'a') {
        line = next_number(line, &after_us);
    }
    uint32_t tx_gpio, rx_gpio, baud, reply_size;
    line = next_number(next_number(next_number(line, &tx_gpio), &rx_gpio), &baud);
    hal_wire_t wire = {.tx_gpio = (uint8_t)tx_gpio, .rx_gpio = (uint8_t)rx_gpio, .baud = baud};
    if (command == 'o' || command == 'c') {
        (command == 'o' ? hal_wire_open : hal_wire_close)(&wire);
        return "done";
    }
    uint8_t send[HAL_WIRE_SEND_MAX];
    size_t size = 0;
    for (line = next_number(line, &reply_size); *line == ' ' && size < sizeof send; size++) {
        uint32_t byte;
        line = next_number(line, &byte);
        send[size] = (uint8_t)byte;
    }
    hal_wire_start(&wire, send, size, reply_size);
    if (command == 'a') {
        uint64_t until_us = hal_time_us() + after_us;
        while (hal_time_us() < until_us) {
            hal_idle(until_us);
        }
        hal_wire_abort();
        return "given up";
    }
    return finish(reply_size);
}

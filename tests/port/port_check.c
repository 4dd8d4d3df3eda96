// A firmware without motion and language, to test firmware/port/rp2 by itself: a letter on the
// console makes it try one thing and print what came of it. Run in the emulator by
// test_rp2_port.py. Contexts: hal_on_tick() tick, hal_on_governor() governor, all else main.
#include "hal/hal.h"

#include <string.h>

#include "wire_check.h"

#define PULSE_GPIO 2u
#define INPUT_GPIO 3u
#define UART_TX_GPIO 0u
#define TICKS 1000u
#define LOST_BYTE '\xff' // stands in the UART's input where bytes are missing

static volatile uint32_t ticks;
static volatile uint32_t ticks_wanted;
static volatile uint32_t governor_calls;
static volatile bool request_in_tick;
static volatile uint32_t calls_seen_in_tick;

void HAL_RAM_FUNC(hal_on_tick)(void) {
    hal_pins_set(1u << PULSE_GPIO);
    ticks = ticks + 1;
    if (request_in_tick) {
        request_in_tick = false;
        hal_governor_request();
        calls_seen_in_tick = governor_calls;
    }
    if (ticks == ticks_wanted) {
        hal_tick_stop();
    }
    hal_pins_clear(1u << PULSE_GPIO);
}

bool hal_on_storage_begin(void) {
    return !hal_tick_running();
}

void hal_on_storage_end(void) {}

void hal_on_governor(void) {
    governor_calls = governor_calls + 1;
}

static void say(const char *text) {
    size_t left = strlen(text);
    while (left > 0) {
        size_t taken = hal_console_write((const uint8_t *)text, left);
        text += taken;
        left -= taken;
        if (left > 0) {
            hal_idle(UINT64_MAX);
        }
    }
}

static void say_numbers(const char *name, unsigned a, unsigned b, unsigned c) {
    char line[80];
    format_text(line, sizeof line, "%s %u %u %u\r\n", name, a, b, c);
    say(line);
}

static void run_ticks(uint32_t count) {
    ticks = 0;
    ticks_wanted = count;
    hal_tick_start();
    hal_tick_start(); // no effect while it runs
}

static void wait_for_tick_stop(void) {
    while (hal_tick_running()) {
        hal_idle(UINT64_MAX);
    }
}

static void check_tick(void) {
    run_ticks(TICKS);
    wait_for_tick_stop();
    unsigned first = ticks;
    run_ticks(TICKS);
    wait_for_tick_stop();
    uint64_t until_us = hal_time_us() + 1000;
    while (hal_time_us() < until_us) {
        hal_idle(until_us);
    }
    say_numbers("tick", first, ticks, hal_tick_running());
}

// Requests from main come at once, several while locked come as one at the unlock, one from the
// tick comes after it.
static void check_governor(void) {
    governor_calls = 0;
    hal_governor_request();
    unsigned from_main = governor_calls;
    hal_governor_lock();
    hal_governor_request();
    hal_governor_request();
    unsigned locked = governor_calls - from_main;
    hal_governor_unlock();
    unsigned unlocked = governor_calls - from_main;
    say_numbers("governor", from_main, locked, unlocked);

    governor_calls = 0;
    request_in_tick = true;
    run_ticks(3);
    wait_for_tick_stop();
    say_numbers("governor from tick", calls_seen_in_tick, governor_calls, 0);
}

static void check_idle(void) {
    uint64_t start_us = hal_time_us();
    uint64_t until_us = start_us + 5000;
    unsigned returns = 0;
    while (hal_time_us() < until_us) {
        hal_idle(until_us);
        returns++;
    }
    unsigned took_us = (unsigned)(hal_time_us() - start_us);
    start_us = hal_time_us();
    hal_idle(start_us); // is over already
    say_numbers("idle", took_us, returns, (unsigned)(hal_time_us() - start_us) / 100);
}

// The tick must not wake main: counts how often hal_idle() returns within 10 ms of running tick.
static void check_idle_under_tick(void) {
    run_ticks(UINT32_MAX);
    unsigned returns = 0;
    uint64_t until_us = hal_time_us() + 10000;
    while (hal_time_us() < until_us) {
        hal_idle(until_us);
        returns++;
    }
    unsigned seen = ticks;
    hal_tick_stop();
    say_numbers("idle under tick", seen / 10, returns, 0);
}

static void check_storage(void) {
    static uint8_t page[HAL_STORAGE_PAGE];
    uint8_t back[4];
    uint32_t offset = HAL_STORAGE_SIZE - HAL_STORAGE_SECTOR; // the chip's last sector
    memset(page, 0xF0, sizeof page);
    bool written =
        hal_storage_erase(offset) && hal_storage_program(offset + HAL_STORAGE_PAGE, page);
    memset(page, 0x3C, sizeof page);
    written = written && hal_storage_program(offset + HAL_STORAGE_PAGE, page); // bits only fall
    hal_storage_read(offset + HAL_STORAGE_PAGE - 2, back, sizeof back);
    say_numbers("storage", written, back[1], back[2]);

    run_ticks(UINT32_MAX);
    bool refused = !hal_storage_erase(offset) && !hal_storage_program(offset, page);
    hal_tick_stop();
    bool outside =
        hal_storage_erase(HAL_STORAGE_SIZE) || hal_storage_program(HAL_STORAGE_SIZE, page);
    say_numbers("storage refused", refused, outside, 0);
}

static void check_pins(void) {
    hal_pin_input(INPUT_GPIO, HAL_PULL_UP);
    unsigned up = (hal_pins_read() >> INPUT_GPIO) & 1;
    hal_pin_input(INPUT_GPIO, HAL_PULL_DOWN);
    unsigned down = (hal_pins_read() >> INPUT_GPIO) & 1;
    hal_pin_output(INPUT_GPIO, true);
    unsigned driven = (hal_pins_read() >> INPUT_GPIO) & 1;
    hal_pin_release(INPUT_GPIO);
    say_numbers("pins", up, down, driven);
}

// As under a stream of input that never ends a line: the prompt takes it and comes to nothing else.
static void read_without_pause(void) {
    uint64_t until_us = hal_time_us() + 9000000;
    uint8_t bytes[16];
    while (hal_time_us() < until_us) {
        hal_console_read(bytes, sizeof bytes);
    }
    say("still here\r\n");
}

static void print_much(void) {
    char line[80];
    for (unsigned i = 0; i < 500; i++) {
        format_text(line, sizeof line, "line %u of a long output\r\n", i);
        say(line);
    }
}

static void overflow_stack(volatile unsigned *above) {
    volatile unsigned room[64];
    room[0] = *above + 1;
    if (room[0] != 0) { // always, but the compiler does not know
        overflow_stack(room);
    }
    room[1] = room[0];
}

static void misuse(char command) {
    volatile unsigned start = 0;
    switch (command) {
    case 'h':
        for (;;) {
        }
    case 'f':
        *(volatile uint32_t *)0x30000000 = 1; // nothing is there
        break;
    case 'o':
        overflow_stack(&start);
        break;
    default:
        hal_exit(0);
    }
}

static void obey(char command) {
    switch (command) {
    case 't':
        check_tick();
        break;
    case 'g':
        check_governor();
        break;
    case 'i':
        check_idle();
        break;
    case 'j':
        check_idle_under_tick();
        break;
    case 's':
        check_storage();
        break;
    case 'p':
        check_pins();
        break;
    case 'l':
        print_much();
        break;
    case 'c':
        read_without_pause();
        break;
    case 'u':
        hal_pin_output(UART_TX_GPIO, true);
        say("uart pins taken\r\n");
        break;
    case 'v':
        hal_pin_release(UART_TX_GPIO);
        say("uart pins given back\r\n");
        break;
    case '.':
        break;
    case LOST_BYTE:
        say("input is missing\r\n");
        break;
    case 'n':
        say(hal_board_name());
        say(" ");
        say(hal_firmware_version());
        say("\r\n");
        break;
    default:
        misuse(command);
    }
}

// What follows a 'w', up to the end of the line, is for the check of the wires. True: taken.
static bool take_for_wire(char c) {
    static char line[80];
    static size_t length;
    static bool taking;
    if (!taking) {
        taking = c == 'w';
        length = 0;
        return taking;
    }
    if (c != '\n' && length < sizeof line - 1) {
        line[length++] = c;
        return true;
    }
    taking = false;
    line[length] = '\0';
    say("wire ");
    say(wire_check(line));
    say("\r\n");
    return true;
}

int main(int argc, char **argv) {
    hal_init(argc, argv);
    hal_pin_output(PULSE_GPIO, false);
    say("port check\r\n");
    for (;;) {
        uint8_t bytes[16];
        size_t count = hal_console_read(bytes, sizeof bytes);
        for (size_t i = 0; i < count; i++) {
            if (!take_for_wire((char)bytes[i])) {
                obey((char)bytes[i]);
            }
        }
        if (count == 0) {
            hal_idle(UINT64_MAX);
        }
    }
}

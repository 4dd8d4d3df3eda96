// The prompt of the bench's test program: a letter selects the check, a number behind it is its
// argument.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "hardware/gpio.h"
#include "hardware/structs/sio.h"
#include "hardware/sync.h"
#include "hardware/watchdog.h"
#include "pico/stdlib.h"

#include "check.h"

static void echo(int argument);
static void fault(int kind);
static void flood(int lines);
static void pins(int argument);
static void restart(int argument);

static const struct {
    char letter;
    void (*run)(int argument);
} commands[] = {
    {'a', check_alu},       {'e', echo},
    {'f', check_float},     {'g', pins},
    {'h', fault},           {'i', check_interrupts},
    {'l', flood},           {'p', check_stack},
    {'r', restart},         {'s', check_storage},
    {'t', check_systick},   {'c', check_timing},
    {'u', check_uart},      {'o', check_pio},
    {'w', check_sleep},     {'x', check_systick_stop},
    {'b', check_pio_shift}, {'d', check_pio_answer},
};

// Repeats lines of input until an empty one.
static void echo(int argument) {
    (void)argument;
    for (;;) {
        char line[128];
        size_t length = 0;
        int c;
        while ((c = getchar()) != '\n' && c != '\r') {
            if (length < sizeof line) {
                line[length++] = (char)c;
            }
        }
        if (length == 0) {
            return;
        }
        printf("echo %.*s\n", (int)length, line);
    }
}

// Output without end, to see what a host that does not read does to it.
static void flood(int lines) {
    for (int i = 0; i < lines; i++) {
        printf("line %d of a long text that fills every buffer there is\n", i);
    }
}

static void pins(int argument) {
    (void)argument;
    gpio_init(CHECK_GPIO_INPUT);
    gpio_pull_up(CHECK_GPIO_INPUT);
    gpio_init(CHECK_GPIO_MAIN);
    gpio_set_dir(CHECK_GPIO_MAIN, GPIO_OUT);
    gpio_put(CHECK_GPIO_MAIN, true);
    busy_wait_us(10);
    printf("input %d output %d\n", gpio_get(CHECK_GPIO_INPUT), gpio_get(CHECK_GPIO_MAIN));
    gpio_put(CHECK_GPIO_MAIN, false);
}

static void fault(int kind) {
    switch (kind) {
    case 0:
        *(volatile uint32_t *)0x30000000 = 1;
        break;
    case 1:
        __asm volatile("ldr r3, [%0]" ::"l"(0x20000001) : "r3");
        break;
    case 2:
        __asm volatile("bkpt 7");
        break;
    default:
        __asm volatile(".hword 0xde00");
    }
}

static void restart(int argument) {
    if (argument == 0) {
        printf("scratch %08lx watchdog %d\n", (unsigned long)watchdog_hw->scratch[1],
               watchdog_caused_reboot());
        return;
    }
    watchdog_hw->scratch[1] = (uint32_t)argument;
    watchdog_reboot(0, 0, 1);
    for (;;) {
        __wfi();
    }
}

static int read_line(char *line, int size) {
    int length = 0;
    for (;;) {
        int c = getchar();
        if (c == '\n' || c == '\r') {
            line[length] = '\0';
            return length;
        }
        if (length < size - 1) {
            line[length++] = (char)c;
        }
    }
}

int main(void) {
    stdio_init_all();
    while (!stdio_usb_connected()) {
        sleep_ms(1);
    }
    printf("emulator-check\n");
    for (;;) {
        char line[32];
        printf("> ");
        if (read_line(line, sizeof line) == 0) {
            continue;
        }
        for (size_t i = 0; i < count_of(commands); i++) {
            if (commands[i].letter == line[0]) {
                commands[i].run(atoi(line + 1));
            }
        }
    }
}

// PIO against the system clock: a square wave by a fractional divider, words through the FIFO
// to a waiting machine, shift registers that fill and empty themselves, and an open-drain answer to
// a pin. Context: main.
#include <stdio.h>

#include "hardware/gpio.h"
#include "hardware/pio.h"
#include "hardware/pio_instructions.h"
#include "hardware/sync.h"
#include "pico/stdlib.h"

#include "check.h"

// High for 3 cycles, low for 5: set pins, 1 [2]; set pins, 0 [4].
static void square_wave(float divider) {
    uint16_t code[] = {pio_encode_set(pio_pins, 1) | pio_encode_delay(2),
                       pio_encode_set(pio_pins, 0) | pio_encode_delay(4)};
    pio_program_t program = {.instructions = code, .length = 2, .origin = 0};
    uint offset = (uint)pio_add_program(pio0, &program);
    pio_sm_config config = pio_get_default_sm_config();
    sm_config_set_wrap(&config, offset, offset + 1);
    sm_config_set_set_pins(&config, CHECK_GPIO_HANDLER, 1);
    sm_config_set_clkdiv(&config, divider);
    pio_gpio_init(pio0, CHECK_GPIO_HANDLER);
    pio_sm_set_consecutive_pindirs(pio0, 0, CHECK_GPIO_HANDLER, 1, true);
    pio_sm_init(pio0, 0, offset, &config);
    pio_sm_set_enabled(pio0, 0, true);
    sleep_us(200); // the machine goes on while the core sleeps
    pio_sm_set_enabled(pio0, 0, false);
    pio_remove_program(pio0, &program, offset);
}

// pull block; mov isr, ~osr; push: each word comes back inverted.
static void through_the_fifos(void) {
    uint16_t code[] = {pio_encode_pull(false, true), pio_encode_mov_not(pio_isr, pio_osr),
                       pio_encode_push(false, true)};
    pio_program_t program = {.instructions = code, .length = 3, .origin = 0};
    uint offset = (uint)pio_add_program(pio0, &program);
    pio_sm_config config = pio_get_default_sm_config();
    sm_config_set_wrap(&config, offset, offset + 2);
    pio_sm_init(pio0, 1, offset, &config);
    pio_sm_set_enabled(pio0, 1, true);
    uint32_t wrong = 0;
    for (uint32_t word = 1; word < 1000; word += 7) {
        pio_sm_put_blocking(pio0, 1, word);
        wrong += pio_sm_get_blocking(pio0, 1) != ~word;
    }
    pio_sm_set_enabled(pio0, 1, false);
    pio_remove_program(pio0, &program, offset);
    printf("words wrong %lu\n", (unsigned long)wrong);
}

#define STEP_FLAG 4u // the program goes on when it is set

// Lets the machine go once round its program, and returns how many words are in one of its FIFOs.
static unsigned level_after_step(bool of_tx) {
    pio0->irq_force = 1u << STEP_FLAG;
    busy_wait_us(5);
    return of_tx ? pio_sm_get_tx_fifo_level(pio0, 1) : pio_sm_get_rx_fifo_level(pio0, 1);
}

// out null, 8 (or in null, 8); wait 1 irq: eight bits at a time from (into) words of which 16
// count.
static void shift(const char *name, bool out) {
    uint16_t code[] = {out ? pio_encode_out(pio_null, 8) : pio_encode_in(pio_null, 8),
                       pio_encode_wait_irq(true, false, STEP_FLAG)};
    pio_program_t program = {.instructions = code, .length = 2, .origin = 0};
    uint offset = (uint)pio_add_program(pio0, &program);
    pio_sm_config config = pio_get_default_sm_config();
    sm_config_set_wrap(&config, offset, offset + 1);
    sm_config_set_out_shift(&config, true, true, 16);
    sm_config_set_in_shift(&config, true, true, 16);
    pio_sm_init(pio0, 1, offset, &config);
    for (uint32_t i = 0; out && i < 3; i++) {
        pio_sm_put(pio0, 1, i);
    }
    pio_sm_set_enabled(pio0, 1, true);
    busy_wait_us(5);
    printf("%s %u", name,
           out ? pio_sm_get_tx_fifo_level(pio0, 1) : pio_sm_get_rx_fifo_level(pio0, 1));
    for (unsigned i = 0; i < 6; i++) {
        printf(" %u", level_after_step(out));
    }
    printf("\n");
    pio_sm_set_enabled(pio0, 1, false);
    pio_remove_program(pio0, &program, offset);
}

// wait 0 pin; set pindirs, 1 [3]; set pindirs, 0; wait 1 pin: pulls a line low for 4 cycles when a
// pin falls.
static void answer(void) {
    uint16_t code[] = {pio_encode_wait_pin(false, 0),
                       pio_encode_set(pio_pindirs, 1) | pio_encode_delay(3),
                       pio_encode_set(pio_pindirs, 0), pio_encode_wait_pin(true, 0)};
    pio_program_t program = {.instructions = code, .length = 4, .origin = 0};
    uint offset = (uint)pio_add_program(pio0, &program);
    pio_sm_config config = pio_get_default_sm_config();
    sm_config_set_wrap(&config, offset, offset + 3);
    sm_config_set_set_pins(&config, CHECK_GPIO_HANDLER, 1);
    sm_config_set_in_pins(&config, CHECK_GPIO_INPUT);
    sm_config_set_clkdiv_int_frac8(&config, 100, 0);
    gpio_init(CHECK_GPIO_INPUT);
    gpio_pull_up(CHECK_GPIO_HANDLER);
    pio_sm_set_pins_with_mask(pio0, 2, 0, 1u << CHECK_GPIO_HANDLER);
    pio_sm_set_consecutive_pindirs(pio0, 2, CHECK_GPIO_HANDLER, 1, false);
    pio_gpio_init(pio0, CHECK_GPIO_HANDLER);
    pio_sm_init(pio0, 2, offset, &config);
    pio_sm_set_enabled(pio0, 2, true);
    busy_wait_us(2000);
    pio_sm_set_enabled(pio0, 2, false);
    pio_remove_program(pio0, &program, offset);
}

void check_pio_shift(int argument) {
    (void)argument;
    shift("autopull", true);
    shift("autopush", false);
}

void check_pio_answer(int argument) {
    (void)argument;
    answer();
    printf("done\n");
}

// `divider_times_2`: the clock divider in halves.
void check_pio(int divider_times_2) {
    square_wave((float)divider_times_2 / 2);
    through_the_fifos();
}

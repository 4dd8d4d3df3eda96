// PIO against the system clock: a square wave by a fractional divider, and words through the FIFO
// to a waiting machine. Context: main.
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

// `divider_times_2`: the clock divider in halves.
void check_pio(int divider_times_2) {
    square_wave((float)divider_times_2 / 2);
    through_the_fifos();
}

// Pins as plain inputs and outputs. The UART console's pins go to whoever wants them, and come back
// to the console when both are free again. Context: main.
#include "hal/hal.h"
#include "hal/hal_io.h"

#include "hardware/adc.h"
#include "hardware/gpio.h"

#include "rp2_port.h"

#define UART_ITSELF (1u << 31) // a program has the UART, on whatever pins

static uint32_t taken_from_uart; // the UART's pins that serve as plain ones now

static void take(unsigned gpio) {
    if (rp2_uart_has_pin(gpio)) {
        taken_from_uart |= pins_mask(gpio);
        rp2_uart_stop();
    }
}

void rp2_pins_take_uart(void) {
    taken_from_uart |= UART_ITSELF;
    rp2_uart_stop();
}

static void give_back(uint32_t mask) {
    taken_from_uart &= ~mask;
    if (taken_from_uart == 0) {
        rp2_uart_start();
    }
}

void rp2_pins_give_uart_back(void) {
    give_back(UART_ITSELF);
}

void hal_pin_output(unsigned gpio, bool level) {
    take(gpio);
    gpio_disable_pulls(gpio);
    gpio_put(gpio, level);
    gpio_set_dir(gpio, GPIO_OUT);
    gpio_set_function(gpio, GPIO_FUNC_SIO); // last: the pad now gets level and driver at once
}

void hal_pin_input(unsigned gpio, hal_pull_t pull) {
    take(gpio);
    gpio_set_dir(gpio, GPIO_IN);
    gpio_set_pulls(gpio, pull == HAL_PULL_UP, pull == HAL_PULL_DOWN);
    gpio_set_function(gpio, GPIO_FUNC_SIO);
}

void hal_pin_analog(unsigned gpio) {
    adc_gpio_init(gpio);
}

void hal_pin_pwm(unsigned gpio) {
    take(gpio);
    gpio_disable_pulls(gpio);
    gpio_set_function(gpio, GPIO_FUNC_PWM);
}

void hal_pin_release(unsigned gpio) {
    gpio_set_dir(gpio, GPIO_IN);
    gpio_put(gpio, false);
    gpio_disable_pulls(gpio);
    gpio_set_function(gpio, GPIO_FUNC_NULL);
    if (rp2_uart_has_pin(gpio)) {
        give_back(pins_mask(gpio));
    }
}

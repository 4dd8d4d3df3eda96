// UART0 at 115200 Bd on GP0 and GP1. Context: main.
#include <stdio.h>

#include "hardware/gpio.h"
#include "hardware/uart.h"
#include "pico/stdlib.h"

#include "check.h"

void check_uart(int argument) {
    (void)argument;
    uart_init(uart0, 115200);
    gpio_set_function(0, GPIO_FUNC_UART);
    gpio_set_function(1, GPIO_FUNC_UART);
    uint64_t start_us = time_us_64();
    for (int i = 0; i < 100; i++) {
        uart_putc_raw(uart0, (char)('0' + i % 10));
    }
    uint64_t queued_us = time_us_64();
    uart_tx_wait_blocking(uart0);
    printf("queued %lu us sent %lu us\n", (unsigned long)(queued_us - start_us),
           (unsigned long)(time_us_64() - start_us));
    sleep_ms(5);
    printf("received ");
    while (uart_is_readable(uart0)) {
        printf("%c", uart_getc(uart0));
    }
    printf(".\n");
    gpio_deinit(0);
    gpio_deinit(1);
    uart_deinit(uart0);
}

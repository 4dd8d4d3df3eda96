// The console's serial port: UART0 on GP0 (out) and GP1 (in), 115200 baud 8N1, a ring each way.
// Contexts: main, and uart_irq() in the UART's interrupt.
#include "base/base.h"
#include "hal/hal.h"

#include "hardware/gpio.h"
#include "hardware/irq.h"
#include "hardware/uart.h"

#include "rp2_port.h"

#define UART uart0
#define UART_IRQ UART0_IRQ
#define TX_GPIO 0u
#define RX_GPIO 1u
#define BAUD 115200u
#define TX_SIZE 512u
#define RX_SIZE 1024u // 0.09 s of input while main is busy
#define RX_ERROR_BITS (UART_UARTDR_BE_BITS | UART_UARTDR_PE_BITS | UART_UARTDR_FE_BITS)
// Stands in the input where bytes were lost. No command contains it, so the line is refused:
// without one digit it would mean something else.
#define LOST_BYTE 0xFFu

static struct {
    ring_t tx; // written by main, read by the interrupt
    ring_t rx; // written by the interrupt, read by main
    uint8_t tx_bytes[TX_SIZE];
    uint8_t rx_bytes[RX_SIZE];
    bool in_line; // the interrupt's: the last byte was not the end of a line
    bool gap;     // the interrupt's: something is missing here
    bool running;
} uart;

// Context: the interrupt, or main with the interrupt off.
static void send_from_ring(void) {
    while (ring_used(&uart.tx) > 0 && uart_is_writable(UART)) {
        uart_get_hw(UART)->dr = uart.tx_bytes[uart.tx.take_slot];
        ring_take(&uart.tx);
    }
    uart_set_irq_enables(UART, true, ring_used(&uart.tx) > 0);
}

static void keep(uint8_t byte) {
    if (ring_free(&uart.rx) == 0) {
        uart.gap = true;
        return;
    }
    uart.rx_bytes[uart.rx.put_slot] = byte;
    ring_put(&uart.rx);
    rp2_input_came = true;
    uart.in_line = byte != '\r' && byte != '\n';
}

static void receive_to_ring(void) {
    while (uart_is_readable(UART)) {
        uint32_t received = uart_get_hw(UART)->dr;
        // Between two lines a byte with an error is noise (a cable being plugged in), not input.
        bool spoiled = (received & RX_ERROR_BITS) != 0;
        if ((spoiled && uart.in_line) || (received & UART_UARTDR_OE_BITS) != 0) {
            uart.gap = true;
        }
        if (uart.gap && ring_free(&uart.rx) > 0) {
            uart.gap = false;
            keep(LOST_BYTE);
        }
        if (!spoiled) {
            keep((uint8_t)received);
        }
    }
}

static void uart_irq(void) {
    receive_to_ring();
    send_from_ring();
    rp2_wake = true;
}

void rp2_uart_start(void) {
    if (uart.running) {
        return;
    }
    ring_reset(&uart.tx, TX_SIZE);
    ring_reset(&uart.rx, RX_SIZE);
    uart.in_line = uart.gap = false;
    uart_init(UART, BAUD);
    gpio_set_function(TX_GPIO, UART_FUNCSEL_NUM(UART, TX_GPIO));
    gpio_set_function(RX_GPIO, UART_FUNCSEL_NUM(UART, RX_GPIO));
    gpio_pull_up(RX_GPIO); // idle level if nothing is connected
    irq_set_exclusive_handler(UART_IRQ, uart_irq);
    uart_set_irq_enables(UART, true, false);
    rp2_irq_on(UART_IRQ);
    uart.running = true;
}

// What was printed still goes out, and a word of farewell: who sits at this port should not have to
// wonder.
static void send_farewell(void) {
    static const char text[] = "\r\nGP0 and GP1 are taken: the console goes on over USB only\r\n";
    while (rp2_uart_write_room() < sizeof text) {
        __wfe();
    }
    rp2_uart_write((const uint8_t *)text, sizeof text - 1);
    while (ring_used(&uart.tx) > 0) {
        __wfe();
    }
    uart_tx_wait_blocking(UART);
}

void rp2_uart_stop(void) {
    if (!uart.running) {
        return;
    }
    send_farewell();
    uart.running = false;
    rp2_irq_off(UART_IRQ);
    irq_remove_handler(UART_IRQ, uart_irq);
    uart_deinit(UART);
    static const unsigned gpios[] = {TX_GPIO, RX_GPIO};
    for (size_t i = 0; i < COUNT_OF_ARRAY(gpios); i++) {
        gpio_disable_pulls(gpios[i]);
        gpio_set_function(gpios[i], GPIO_FUNC_NULL);
    }
}

bool rp2_uart_running(void) {
    return uart.running;
}

bool rp2_uart_has_pin(unsigned gpio) {
    return gpio == TX_GPIO || gpio == RX_GPIO;
}

size_t rp2_uart_read(uint8_t *bytes, size_t size) {
    size_t count = 0;
    while (uart.running && count < size && ring_used(&uart.rx) > 0) {
        bytes[count++] = uart.rx_bytes[uart.rx.take_slot];
        ring_take(&uart.rx);
    }
    return count;
}

size_t rp2_uart_write_room(void) {
    return uart.running ? ring_free(&uart.tx) : 0;
}

size_t rp2_uart_write(const uint8_t *bytes, size_t size) {
    size_t count = 0;
    while (count < size && rp2_uart_write_room() > 0) {
        uart.tx_bytes[uart.tx.put_slot] = bytes[count++];
        ring_put(&uart.tx);
    }
    if (count > 0) {
        rp2_irq_off(UART_IRQ);
        send_from_ring();
        rp2_irq_on(UART_IRQ);
    }
    return count;
}

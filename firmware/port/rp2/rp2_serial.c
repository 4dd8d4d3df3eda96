// The two UARTs as serial ports of a program, with a ring each way. Contexts: main; irq_0() and
// irq_1() in the UARTs' interrupts, which the tick preempts.
#include "hal/hal_serial.h"

#include "base/base.h"
#include "hal/hal.h"

#include "hardware/gpio.h"
#include "hardware/irq.h"
#include "hardware/uart.h"

#include "rp2_port.h"

#define CONSOLE_PORT 0u
#define ERROR_BITS (UART_UARTDR_BE_BITS | UART_UARTDR_PE_BITS | UART_UARTDR_FE_BITS)

typedef struct {
    ring_t rx; // written by the interrupt, read by main
    ring_t tx; // written by main, read by the interrupt
    uint8_t rx_bytes[HAL_SERIAL_RECEIVE_SIZE];
    uint8_t tx_bytes[HAL_SERIAL_SEND_SIZE];
    bool open;
} serial_t;

static serial_t ports[HAL_SERIAL_PORTS];

static uart_inst_t *uart_of(unsigned port) {
    return port == 0 ? uart0 : uart1;
}

static unsigned irq_of(unsigned port) {
    return port == 0 ? UART0_IRQ : UART1_IRQ;
}

// Context: the interrupt, or main with the interrupt off.
static void send_from_ring(unsigned port) {
    serial_t *serial = &ports[port];
    uart_inst_t *uart = uart_of(port);
    while (ring_used(&serial->tx) > 0 && uart_is_writable(uart)) {
        uart_get_hw(uart)->dr = serial->tx_bytes[serial->tx.take_slot];
        ring_take(&serial->tx);
    }
    uart_set_irq_enables(uart, true, ring_used(&serial->tx) > 0);
}

static void receive_to_ring(unsigned port) {
    serial_t *serial = &ports[port];
    uart_inst_t *uart = uart_of(port);
    while (uart_is_readable(uart)) {
        uint32_t received = uart_get_hw(uart)->dr;
        if ((received & ERROR_BITS) == 0 && ring_free(&serial->rx) > 0) {
            serial->rx_bytes[serial->rx.put_slot] = (uint8_t)received;
            ring_put(&serial->rx);
        }
    }
}

static void serve(unsigned port) {
    receive_to_ring(port);
    send_from_ring(port);
    rp2_wake = true;
}

static void irq_0(void) {
    serve(0);
}

static void irq_1(void) {
    serve(1);
}

void hal_serial_open(unsigned port, unsigned receive_gpio, unsigned send_gpio,
                     const hal_serial_t *settings) {
    static const uart_parity_t parities[] = {UART_PARITY_NONE, UART_PARITY_EVEN, UART_PARITY_ODD};
    if (port == CONSOLE_PORT) {
        rp2_pins_take_uart();
    }
    serial_t *serial = &ports[port];
    uart_inst_t *uart = uart_of(port);
    ring_reset(&serial->tx, HAL_SERIAL_SEND_SIZE);
    ring_reset(&serial->rx, settings->receive_size);
    uart_init(uart, settings->baud);
    uart_set_format(uart, settings->data_bits, settings->stop_bits, parities[settings->parity]);
    gpio_set_function(send_gpio, UART_FUNCSEL_NUM(uart, send_gpio));
    gpio_set_function(receive_gpio, UART_FUNCSEL_NUM(uart, receive_gpio));
    gpio_pull_up(receive_gpio); // idle level if nothing is connected
    irq_set_exclusive_handler(irq_of(port), port == 0 ? irq_0 : irq_1);
    uart_set_irq_enables(uart, true, false);
    rp2_irq_on(irq_of(port));
    serial->open = true;
}

void hal_serial_close(unsigned port) {
    if (!ports[port].open) {
        return;
    }
    ports[port].open = false;
    rp2_irq_off(irq_of(port));
    irq_remove_handler(irq_of(port), port == 0 ? irq_0 : irq_1);
    uart_deinit(uart_of(port));
    if (port == CONSOLE_PORT) {
        rp2_pins_give_uart_back();
    }
}

size_t hal_serial_waiting(unsigned port) {
    return ports[port].open ? ring_used(&ports[port].rx) : 0;
}

size_t hal_serial_read(unsigned port, uint8_t *bytes, size_t size) {
    serial_t *serial = &ports[port];
    size_t count = 0;
    while (serial->open && count < size && ring_used(&serial->rx) > 0) {
        bytes[count++] = serial->rx_bytes[serial->rx.take_slot];
        ring_take(&serial->rx);
    }
    return count;
}

size_t hal_serial_room(unsigned port) {
    return ports[port].open ? ring_free(&ports[port].tx) : 0;
}

bool hal_serial_is_sent(unsigned port) {
    return !ports[port].open || (ring_used(&ports[port].tx) == 0 &&
                                 (uart_get_hw(uart_of(port))->fr & UART_UARTFR_BUSY_BITS) == 0);
}

size_t hal_serial_write(unsigned port, const uint8_t *bytes, size_t size) {
    serial_t *serial = &ports[port];
    size_t count = 0;
    while (count < size && hal_serial_room(port) > 0) {
        serial->tx_bytes[serial->tx.put_slot] = bytes[count++];
        ring_put(&serial->tx);
    }
    if (count > 0) {
        rp2_irq_off(irq_of(port));
        send_from_ring(port);
        rp2_irq_on(irq_of(port));
    }
    return count;
}

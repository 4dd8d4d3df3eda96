// One console of two ways, USB serial and UART0. Input is merged, output goes to both. One of the
// two leads: the one used last. Its speed is the console's speed; the other gets what it can take,
// so that a terminal that does not read, or a slow one, does not hold up the one in use. Contexts:
// main; rp2_console_on_usb_line() in the USB interrupt.
#include "hal/hal.h"

#include <string.h>

#include "rp2_port.h"

#define GREETING_SIZE 512u

static volatile bool usb_leads;

// What was printed since the start, for the first terminal that comes over USB: it cannot have been
// there in time. Held back only until someone uses the console.
static struct {
    uint8_t bytes[GREETING_SIZE];
    size_t length;
    bool closed;
} greeting;

static void keep_for_greeting(const uint8_t *bytes, size_t size) {
    rp2_irq_off(RP2_USB_IRQ);
    size_t room = GREETING_SIZE - greeting.length;
    if (!greeting.closed && size <= room) {
        memcpy(greeting.bytes + greeting.length, bytes, size);
        greeting.length += size;
    } else {
        greeting.closed = true;
    }
    rp2_irq_on(RP2_USB_IRQ);
}

void rp2_console_init(void) {
    rp2_usb_start();
    rp2_uart_start();
    const char *report = rp2_fault_report();
    if (report != NULL) {
        hal_console_write((const uint8_t *)report, strlen(report));
    }
}

void rp2_console_on_usb_line(bool connected) {
    usb_leads = connected;
    if (connected && !greeting.closed) {
        greeting.closed = true;
        rp2_usb_write(greeting.bytes, greeting.length);
    }
}

// The port itself gives no byte a meaning.
void hal_console_set_raw(bool raw) {
    (void)raw;
}

bool hal_console_break_is_inband(void) {
    return true;
}

size_t hal_console_read(uint8_t *bytes, size_t size) {
    rp2_fault_feed(); // who takes input is alive, even if it never comes to a statement or a pause
    size_t count = rp2_usb_read(bytes, size);
    if (count > 0) {
        usb_leads = rp2_usb_connected();
        return count;
    }
    count = rp2_uart_read(bytes, size);
    if (count > 0) {
        usb_leads = false;
        greeting.closed = true;
    }
    return count;
}

size_t hal_console_write(const uint8_t *bytes, size_t size) {
    if (usb_leads && rp2_usb_connected()) {
        size_t count = rp2_usb_write(bytes, size);
        if (rp2_usb_connected()) { // still
            rp2_uart_write(bytes, count);
            return count;
        }
    }
    size_t count = rp2_uart_running() ? rp2_uart_write(bytes, size) : size;
    if (rp2_usb_connected()) {
        rp2_usb_write(bytes, count);
    } else {
        keep_for_greeting(bytes, count);
    }
    return count;
}

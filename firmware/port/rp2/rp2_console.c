// One console of two ways, USB serial and UART0. Input is merged, output goes to both. One of the two
// leads: the one used last. Its speed is the console's speed; the other gets what it can take, so that a
// terminal that does not read, or a slow one, does not hold up the one in use.
// Contexts: main; rp2_console_on_usb_line() in the USB interrupt.
#include "hal/hal.h"

#include <string.h>

#include "rp2_port.h"

static volatile bool usb_leads;
static bool fault_told;

static void write_text_to_usb(const char *text) {
    rp2_usb_write((const uint8_t *)text, strlen(text));
}

void rp2_console_init(void) {
    rp2_usb_start();
    rp2_uart_start();
    const char *report = rp2_fault_report();
    if (report != NULL) {
        rp2_uart_write((const uint8_t *)report, strlen(report));
    }
}

void rp2_console_on_usb_line(bool connected) {
    usb_leads = connected;
    const char *report = rp2_fault_report();
    if (connected && !fault_told && report != NULL) {
        fault_told = true;
        write_text_to_usb(report);
    }
}

size_t hal_console_read(uint8_t *bytes, size_t size) {
    size_t count = rp2_usb_read(bytes, size);
    if (count > 0) {
        usb_leads = rp2_usb_connected();
        return count;
    }
    count = rp2_uart_read(bytes, size);
    if (count > 0) {
        usb_leads = false;
    }
    return count;
}

size_t hal_console_write(const uint8_t *bytes, size_t size) {
    if (usb_leads && rp2_usb_connected()) {
        size_t count = rp2_usb_write(bytes, size);
        rp2_uart_write(bytes, count);
        return count;
    }
    size_t count = rp2_uart_running() ? rp2_uart_write(bytes, size) : size;
    if (rp2_usb_connected()) {
        rp2_usb_write(bytes, count);
    }
    return count;
}

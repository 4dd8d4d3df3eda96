// The console's USB serial port. The SDK's stdio_usb brings the descriptors, the low-priority
// interrupt that serves TinyUSB, and picotool's reset; bytes pass by its stdio and go in blocks
// straight to and from TinyUSB's buffers, with that interrupt held off meanwhile. Contexts: main;
// tud_...() in the interrupt.
#include "hal/hal.h"

#include "hardware/timer.h"
#include "pico/bootrom.h"
#include "pico/stdio_usb.h"
#include "tusb.h"

#include "rp2_port.h"

#define BOOTLOADER_BAUD 1200u // opening the port at this speed asks for the UF2 boot loader
#define SILENT_US                                                                                  \
    500000u // a terminal that shows itself only by what it sends may not read for so long

// Most programs raise DTR while they have the port open. Some do not (.NET's default): such a
// terminal is there once it has sent something, until it no longer takes what is printed.
static struct {
    volatile bool dtr;
    volatile bool heard;
    volatile uint32_t moved_us; // when output last went in or out, without DTR
} terminal;

void rp2_usb_start(void) {
    stdio_usb_init();
}

bool rp2_usb_connected(void) {
    return tud_ready() && (terminal.dtr || terminal.heard);
}

size_t rp2_usb_read(uint8_t *bytes, size_t size) {
    if (tud_cdc_available() == 0) {
        return 0;
    }
    rp2_irq_off(RP2_USB_IRQ);
    size_t count = tud_cdc_read(bytes, size);
    rp2_irq_on(RP2_USB_IRQ);
    return count;
}

size_t rp2_usb_write_room(void) {
    return rp2_usb_connected() ? tud_cdc_write_available() : 0;
}

size_t rp2_usb_write(const uint8_t *bytes, size_t size) {
    rp2_irq_off(RP2_USB_IRQ);
    // Not more than fits: without DTR TinyUSB writes over what still waits.
    size_t room = rp2_usb_write_room();
    size_t count = tud_cdc_write(bytes, size < room ? size : room);
    tud_cdc_write_flush();
    if (count > 0) {
        terminal.moved_us = time_us_32();
    } else if (size > 0 && !terminal.dtr && time_us_32() - terminal.moved_us > SILENT_US) {
        terminal.heard = false;
    }
    rp2_irq_on(RP2_USB_IRQ);
    return count;
}

// ---- Called by TinyUSB --------------------------------------------------------------------------

void tud_mount_cb(void) {
    terminal.dtr = terminal.heard = false; // plugged in again: who has the port open will say so
}

void tud_cdc_rx_cb(uint8_t itf) {
    (void)itf;
    if (!rp2_usb_connected()) {
        terminal.heard = true;
        terminal.moved_us = time_us_32();
        rp2_console_on_usb_line(true);
    }
    rp2_input_came = true;
    rp2_wake = true;
}

void tud_cdc_tx_complete_cb(uint8_t itf) {
    (void)itf;
    terminal.moved_us = time_us_32();
    rp2_wake = true;
}

// Also comes when only RTS changes, as the second half of opening a port: output must not be lost
// to that.
void tud_cdc_line_state_cb(uint8_t itf, bool dtr, bool rts) {
    (void)itf;
    (void)rts;
    bool changed = dtr != terminal.dtr;
    terminal.dtr = dtr;
    terminal.heard = false;
    if (changed) {
        tud_cdc_write_clear(); // what nobody read is not for the next who comes
        rp2_console_on_usb_line(dtr);
    }
    rp2_wake = true;
}

void tud_cdc_line_coding_cb(uint8_t itf, const cdc_line_coding_t *line_coding) {
    (void)itf;
    // Some programs try every speed on every port they find; a job under way is not lost to that.
    if (line_coding->bit_rate == BOOTLOADER_BAUD && !hal_tick_running()) {
        rom_reset_usb_boot(0, 0);
    }
}

// What the files of this port need of each other. Context: main loop unless said otherwise.
#ifndef RP2_PORT_H
#define RP2_PORT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "hardware/structs/watchdog.h"

// Interrupt priorities, low numbers first. Between these two lies everything of the SDK, at 0x80.
#define RP2_PRIORITY_TICK 0x00u
#define RP2_PRIORITY_GOVERNOR 0xC0u

// ---- Start-up, called by hal_init() -------------------------------------------------------------
void rp2_tick_init(void);
void rp2_governor_init(void);
void rp2_idle_init(void);
void rp2_alarm_init(void);
void rp2_console_init(void);

// ---- Faults -------------------------------------------------------------------------------------

// Takes note of why the board restarted, and starts the watchdog.
void rp2_fault_init(void);

// Tells the watchdog that the main loop is alive. To be called at least every RP2_FAULT_FEED_US.
// Inline: this is asked at each BASIC statement.
#define RP2_FAULT_FEED_US 2000000u
#define RP2_FAULT_WATCHDOG_MS 8000u // the RP2040's limit is 8.3 s
#if PICO_RP2040
#define RP2_FAULT_COUNTS_PER_US 2u // its watchdog counts twice in a microsecond
#else
#define RP2_FAULT_COUNTS_PER_US 1u
#endif

static inline void rp2_fault_feed(void) {
    watchdog_hw->load = RP2_FAULT_WATCHDOG_MS * 1000u * RP2_FAULT_COUNTS_PER_US;
}

// A line about the last restart if a fault was the reason, else NULL. Any context.
const char *rp2_fault_report(void);

// Stores the reason and restarts the board at once. Any context.
_Noreturn void rp2_fault_restart(uint32_t reason, uint32_t pc, uint32_t lr);

// Called by the SDK's panic().
_Noreturn void rp2_fault_panic(const char *format, ...);

// The HardFault handler; the vector table has it by this name.
void isr_hardfault(void);

// ---- Memory -------------------------------------------------------------------------------------

// Makes running over the end of main's stack a fault.
void rp2_stack_guard(void);

// Addresses the linker fills in (rp2_memory.ld): the end of all variables, and main's stack.
extern uint8_t rp2_variables_end[], rp2_main_stack[], rp2_main_stack_top[];

// ---- Console ------------------------------------------------------------------------------------

// Set by interrupts when console input came; cleared by hal_statement().
extern volatile bool rp2_input_came;

// ---- UART console -------------------------------------------------------------------------------

void rp2_uart_start(void);
void rp2_uart_stop(void);
bool rp2_uart_running(void);
size_t rp2_uart_read(uint8_t *bytes, size_t size);
size_t rp2_uart_write(const uint8_t *bytes, size_t size); // takes what fits
size_t rp2_uart_write_room(void);

// True if `gpio` is one of the console's two pins.
bool rp2_uart_has_pin(unsigned gpio);

// A program takes the console's UART for a port of its own, and gives it back.
void rp2_pins_take_uart(void);
void rp2_pins_give_uart_back(void);

// ---- USB console --------------------------------------------------------------------------------

void rp2_usb_start(void);
bool rp2_usb_connected(void); // a terminal has the port open
size_t rp2_usb_read(uint8_t *bytes, size_t size);
size_t rp2_usb_write(const uint8_t *bytes, size_t size); // takes what fits
size_t rp2_usb_write_room(void);

// Implemented by the console: a terminal opened or closed the port. Context: USB interrupt.
void rp2_console_on_usb_line(bool connected);

#endif

// The seam to the hardware: what the firmware asks of a board. Implemented by firmware/port/rp2
// (RP2040, RP2350) and firmware/port/host (POSIX, virtual time). Linked functions, no pointers;
// what the tick needs is inline in the port's hal_port.h. Four functions are called upwards and
// belong to the core: hal_on_tick(), hal_on_governor(), hal_on_storage_begin() and
// hal_on_storage_end().
//
// Contexts, highest priority first:
//   tick      hal_on_tick(), every 10 us while the tick runs; interrupts everything
//   governor  hal_on_governor(), soon after hal_governor_request(); below every other interrupt
//   main      everything else
// Functions are for the main loop unless they say otherwise.
#ifndef HAL_H
#define HAL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/base.h"
#include "hal_port.h" // inline: hal_pins_set() and others, see below
#include "hal/pins.h"

#define HAL_TICK_HZ 100000u

// ---- Start and end ------------------------------------------------------------------------------

// Brings the board up: clocks, console, interrupt priorities. The host port reads its options from
// the command line and leaves with a message if they are wrong.
void hal_init(int argc, char **argv);

// The BASIC program to run at start, as text with \n at the ends of lines, or NULL. Stays valid.
// (Host: FILE.bas.)
const char *hal_startup_program(size_t *length);

// True once no more console input can come and the firmware should leave. Never on a board.
bool hal_end_of_input(void);

// Leaves the program. A board restarts instead.
_Noreturn void hal_exit(int code);

// Starts the firmware afresh, as after power-up: all pins go back to inputs. `watchdog`: because
// the program's watchdog ran out; the next start knows. (Host: leaves the program, code 4 or 5.)
_Noreturn void hal_restart(bool watchdog);

// Starts the boot loader, which waits for a UF2 on USB. (Host: leaves the program, code 4.)
_Noreturn void hal_bootloader(void);

// Why the firmware was started.
typedef enum {
    HAL_START_POWER,    // power-up, or the board's reset
    HAL_START_RESTART,  // hal_restart(false)
    HAL_START_WATCHDOG, // hal_restart(true)
    HAL_START_HUNG,     // the main loop did not come round for seconds
    HAL_START_FAULT     // of the processor, or a panic
} hal_start_t;
hal_start_t hal_start_reason(void);

// "Raspberry Pi Pico", "Raspberry Pi Pico 2", "host".
const char *hal_board_name(void);

// From `git describe`, for instance "0.1.0-12-gabc1234".
const char *hal_firmware_version(void);

// All memory that is left over, 8-aligned, for whoever takes it at start-up.
void *hal_memory(size_t *size);

// ---- Time ---------------------------------------------------------------------------------------

// Microseconds since start. Any context.
uint64_t hal_time_us(void);

// Sleeps until something may have happened (an interrupt, console input) or until `until_us`,
// whichever comes first; may return early. UINT64_MAX: no time limit.
void hal_idle(uint64_t until_us);

// Called once for each BASIC statement. Costs next to nothing on a board; the host port lets a
// statement's worth of virtual time pass, so that a program that only computes sees motion go on.
// True if console input has come since the last call: worth a look at once.
bool hal_statement(void);

// ---- Tick and governor --------------------------------------------------------------------------

// Starts the 100 kHz tick; the first hal_on_tick() comes 10 us later. No effect while it runs.
// Contexts: main, governor.
void hal_tick_start(void);

// Stops the tick. Contexts: main, governor, and hal_on_tick() itself (which is then the last one).
void hal_tick_stop(void);

// Any context.
bool hal_tick_running(void);

// Implemented by the core (stepper/step_isr.c), in RAM on a board.
void hal_on_tick(void);

// Asks for one hal_on_governor() call; several requests before it comes are one. Any context.
// (In main it comes before this function returns unless locked.)
void hal_governor_request(void);

// Implemented by the core (stepper/governor.c).
void hal_on_governor(void);

// Holds hal_on_governor() off, for the main loop's short critical sections; does not nest.
void hal_governor_lock(void);
void hal_governor_unlock(void);

// ---- Pins ---------------------------------------------------------------------------------------
// A mask has bit n for GPIO n. From hal_port.h, inline, any context:
//   void     hal_pins_set(uint32_t mask);      drive these outputs high
//   void     hal_pins_clear(uint32_t mask);    drive these outputs low
//   uint32_t hal_pins_read(void);              levels of all pins as they are now
// A place takes the level of both outputs of a PWM slice (hal_io.h); at the end of a period it
// counts. HAL_PWM_SLICES for `slice`: a place without effect.
//   hal_pwm_place_t hal_pwm_place(unsigned slice);
//   void     hal_pwm_level(hal_pwm_place_t place, uint16_t level);
//   HAL_RAM_FUNC(name)                         places a function in RAM

typedef enum { HAL_PULL_NONE, HAL_PULL_UP, HAL_PULL_DOWN } hal_pull_t;

// Makes the pin an output that starts at `level`, without a glitch. `gpio` must be a user pin. Also
// governor, for a pin that was an output before.
void hal_pin_output(unsigned gpio, bool level);
void hal_pin_input(unsigned gpio, hal_pull_t pull);
// Back to the state after reset: input, no driver, no pull.
void hal_pin_release(unsigned gpio);

// ---- Console ------------------------------------------------------------------------------------
// Bytes, not characters. On a board USB serial and UART0 are one console: input from both is
// merged, output goes to both.

// Takes up to `size` received bytes; 0 if there are none.
size_t hal_console_read(uint8_t *bytes, size_t size);

// True if Ctrl-C and other control keys come in the same stream as everything else, as from a
// terminal, and may therefore stand behind input that nobody takes. False: Ctrl-C comes ahead of
// all input.
bool hal_console_break_is_inband(void);

// While on, every byte received is data: a protocol has the console. (Otherwise the host port takes
// Ctrl-D from a terminal for the end of input.)
void hal_console_set_raw(bool raw);

// Takes up to `size` bytes for sending and returns how many it took; 0 if the way is full just now.
// A board drops output for USB while no terminal is connected.
size_t hal_console_write(const uint8_t *bytes, size_t size);

// ---- Storage ------------------------------------------------------------------------------------
// NOR flash for the user's data: erased bytes are 0xFF, programming clears bits. Offsets count from
// the start of this area. Erase and program stop every context on a board for up to 50 ms (400 ms
// is the chip's worst) and are therefore refused (false) while motion is under way.

#define HAL_STORAGE_SIZE (1280u * 1024u)
#define HAL_STORAGE_SECTOR 4096u // unit of erase
#define HAL_STORAGE_PAGE 256u    // unit of program

void hal_storage_read(uint32_t offset, void *bytes, size_t size);
bool hal_storage_erase(uint32_t offset);                     // one sector
bool hal_storage_program(uint32_t offset, const void *page); // one page

// The storage as memory to be read. Stays valid.
const void *hal_storage_map(uint32_t offset);

// True if erase and program would not be refused now. Nothing but the main loop can change that.
bool hal_storage_is_writable(void);

// Implemented by the core (stepper/stepper_storage.c); called around each erase and program.
// `begin` stops the tick if it only watches inputs; false: motion is under way, nothing is to be
// written, and `end` does not follow.
bool hal_on_storage_begin(void);
void hal_on_storage_end(void);

#endif

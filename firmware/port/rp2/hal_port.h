// The inline part of the seam, RP2040 and RP2350: what the tick needs, each a few cycles and no
// call.
#ifndef HAL_PORT_H
#define HAL_PORT_H

#include <stdbool.h>
#include <stdint.h>

#include "hardware/structs/pwm.h"
#include "hardware/structs/scb.h"
#include "hardware/structs/sio.h"
#include "hardware/structs/systick.h"
#include "hardware/sync.h"
#include "pico/platform.h"
#include "pico/platform/cpu_regs.h"

// Places a function in RAM: it never waits for the flash.
#define HAL_RAM_FUNC(name) __not_in_flash_func(name)

// ---- Pins: single-cycle I/O ---------------------------------------------------------------------

static __force_inline void hal_pins_set(uint32_t mask) {
    sio_hw->gpio_set = mask;
}

static __force_inline void hal_pins_clear(uint32_t mask) {
    sio_hw->gpio_clr = mask;
}

static __force_inline uint32_t hal_pins_read(void) {
    return sio_hw->gpio_in;
}

// ---- PWM: the level of a slice ------------------------------------------------------------------

// 16 bits that are written to a peripheral reach both halves of its register, here A and B (RP2040
// datasheet 2.1.4, RP2350 datasheet 2.1.5: narrow I/O register writes).
typedef volatile uint16_t *hal_pwm_place_t;
extern volatile uint16_t rp2_pwm_nowhere;

static __force_inline hal_pwm_place_t hal_pwm_place(unsigned slice) {
    return slice < 8 ? (hal_pwm_place_t)&pwm_hw->slice[slice].cc : &rp2_pwm_nowhere;
}

static __force_inline void hal_pwm_level(hal_pwm_place_t place, uint16_t level) {
    *place = level;
}

// ---- Interrupt lines of the NVIC ----------------------------------------------------------------
// Register addresses from the Armv6-M and Armv8-M architecture manuals; the same on both chips. The
// SDK's functions forget a pending interrupt when they switch its line on; these do not.

#define RP2_NVIC_REGISTER(offset, irq)                                                             \
    (*(volatile uint32_t *)(PPB_BASE + (offset) + 4u * ((irq) / 32u)))
#define RP2_NVIC_ENABLE 0xE100u
#define RP2_NVIC_DISABLE 0xE180u
#define RP2_NVIC_PEND 0xE200u

// User interrupts: lines no peripheral is wired to. The first calls the governor, the second serves
// USB.
#define RP2_GOVERNOR_IRQ ((unsigned)FIRST_USER_IRQ)
#define RP2_USB_IRQ ((unsigned)FIRST_USER_IRQ + 1u)

// Afterwards the handler does not run, and what it wrote is there to be read.
static __force_inline void rp2_irq_off(unsigned irq) {
    RP2_NVIC_REGISTER(RP2_NVIC_DISABLE, irq) = 1u << (irq % 32u);
    __dsb();
    __isb();
}

// If the interrupt is pending it has been taken when this returns, priorities permitting.
static __force_inline void rp2_irq_on(unsigned irq) {
    RP2_NVIC_REGISTER(RP2_NVIC_ENABLE, irq) = 1u << (irq % 32u);
    __dsb();
    __isb();
}

static __force_inline void rp2_irq_pend(unsigned irq) {
    RP2_NVIC_REGISTER(RP2_NVIC_PEND, irq) = 1u << (irq % 32u);
    __dsb();
    __isb();
}

// ---- Waking the main loop -----------------------------------------------------------------------

// Set by interrupts when something happened that main may be waiting for; cleared by hal_idle().
extern volatile bool rp2_wake;

// ---- Tick: SysTick at the highest priority ------------------------------------------------------

static __force_inline bool hal_tick_running(void) {
    return (systick_hw->csr & ARM_CPU_PREFIXED(SYST_CSR_ENABLE_BITS)) != 0;
}

static __force_inline void hal_tick_stop(void) {
    systick_hw->csr = 0;
    scb_hw->icsr = ARM_CPU_PREFIXED(ICSR_PENDSTCLR_BITS); // one that was due just now does not come
    __dsb(); // not even while the stores are on their way: behind this line no tick runs
    __isb();
    rp2_wake = true;
}

// ---- Governor: a user interrupt at the lowest priority ------------------------------------------

static __force_inline void hal_governor_request(void) {
    rp2_irq_pend(RP2_GOVERNOR_IRQ);
}

#endif

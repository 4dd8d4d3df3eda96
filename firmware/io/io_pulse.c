// Pulses: an output inverted for a time, several at once. Contexts: main; io_pulse_run() alarm.
#include "io_pulse.h"

#include "io.h"
#include "io_alarm.h"
#include "io_pins.h"

// Written by main with the alarm locked, and by the alarm.
static struct {
    uint64_t end_us[IO_PULSES];
    uint8_t gpio[IO_PULSES];
    bool after[IO_PULSES];    // the level that comes back
    volatile uint8_t running; // a bit for each that is under way
} pulses;

static void set_level(unsigned gpio, bool level) {
    if (level) {
        hal_pins_set(pins_mask(gpio));
    } else {
        hal_pins_clear(pins_mask(gpio));
    }
}

static bool is_running(unsigned slot) {
    return ((unsigned)pulses.running >> slot & 1u) != 0;
}

static void end(unsigned slot) {
    pulses.running &= (uint8_t)~(1u << slot);
}

uint64_t io_pulse_next_us(void) {
    uint64_t next_us = UINT64_MAX;
    for (unsigned slot = 0; slot < IO_PULSES; slot++) {
        if (is_running(slot) && pulses.end_us[slot] < next_us) {
            next_us = pulses.end_us[slot];
        }
    }
    return next_us;
}

void io_pulse_run(uint64_t now_us) {
    for (unsigned slot = 0; slot < IO_PULSES; slot++) {
        if (is_running(slot) && pulses.end_us[slot] <= now_us) {
            set_level(pulses.gpio[slot], pulses.after[slot]);
            end(slot);
        }
    }
}

// The slot of the pin's pulse; IO_PULSES: none. With the alarm locked.
static unsigned slot_of(unsigned gpio) {
    unsigned slot = 0;
    while (slot < IO_PULSES && !(is_running(slot) && pulses.gpio[slot] == gpio)) {
        slot++;
    }
    return slot;
}

static unsigned free_slot(void) {
    unsigned slot = 0;
    while (slot < IO_PULSES && is_running(slot)) {
        slot++;
    }
    return slot;
}

void io_pulse_forget(unsigned gpio) {
    if (pulses.running == 0) {
        return;
    }
    hal_alarm_lock();
    unsigned slot = slot_of(gpio);
    if (slot < IO_PULSES) {
        end(slot);
        io_alarm_update();
    }
    hal_alarm_unlock();
}

// With the alarm locked. False: no room.
static bool start(unsigned gpio, uint64_t end_us) {
    unsigned slot = slot_of(gpio);
    if (slot == IO_PULSES) {
        slot = free_slot();
        if (slot == IO_PULSES) {
            return false;
        }
        bool level = (hal_pins_read() & pins_mask(gpio)) != 0;
        pulses.gpio[slot] = (uint8_t)gpio;
        pulses.after[slot] = level;
        set_level(gpio, !level);
    }
    pulses.end_us[slot] = end_us;
    pulses.running |= (uint8_t)(1u << slot);
    io_alarm_update();
    return true;
}

// Short ones are measured out here: the end of the statement would come too late to matter.
static void pulse_and_wait(unsigned gpio, uint32_t us) {
    io_pulse_forget(gpio);
    bool level = (hal_pins_read() & pins_mask(gpio)) != 0;
    set_level(gpio, !level);
    hal_wait_us(us);
    set_level(gpio, level);
}

// Puts the level back at once.
static void stop(unsigned gpio) {
    hal_alarm_lock();
    unsigned slot = slot_of(gpio);
    if (slot < IO_PULSES) {
        pulses.end_us[slot] = 0;
        io_pulse_run(0);
        io_alarm_update();
    }
    hal_alarm_unlock();
}

err_t io_pulse(unsigned gpio, double ms) {
    if (io_pins_use(gpio) != IO_PINS_OUTPUT) {
        err_t err = io_pins_check(gpio);
        return err != ERR_OK ? err : err_raise(ERR_PIN_NOT_OUTPUT, "%s", pins_name(gpio));
    }
    uint64_t us = (uint64_t)(ms * 1000.0 + 0.5);
    if (us == 0) {
        stop(gpio);
        return ERR_OK;
    }
    if (ms < IO_PULSE_WAIT_MS) {
        pulse_and_wait(gpio, (uint32_t)us);
        return ERR_OK;
    }
    hal_alarm_lock();
    bool started = start(gpio, hal_time_us() + us);
    hal_alarm_unlock();
    return started ? ERR_OK : err_raise(ERR_TOO_MANY_PULSES, NULL);
}

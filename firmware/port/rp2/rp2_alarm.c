// The alarm, one of the timer's, and short waits. Context: main; call_handler() in the timer's
// interrupt, which the tick preempts and which holds the governor off.
#include "hal/hal.h"
#include "hal/hal_io.h"

#include "hardware/timer.h"
#include "pico/time.h"

#include "rp2_port.h"

static struct {
    unsigned number;
    unsigned irq;
    hal_alarm_t volatile handler; // NULL: none is set
} alarm;

static void call_handler(unsigned number) {
    (void)number;
    hal_alarm_t handler = alarm.handler;
    alarm.handler = NULL;
    if (handler != NULL) {
        handler();
    }
}

void rp2_alarm_init(void) {
    alarm.number = (unsigned)hardware_alarm_claim_unused(true);
    alarm.irq = hardware_alarm_get_irq_num(alarm.number);
    hardware_alarm_set_callback(alarm.number, call_handler);
}

void hal_alarm_set(uint64_t at_us, hal_alarm_t handler) {
    if (at_us == UINT64_MAX) {
        alarm.handler = NULL;
        return;
    }
    alarm.handler = handler;
    if (hardware_alarm_set_target(alarm.number, from_us_since_boot(at_us))) {
        hardware_alarm_force_irq(alarm.number); // it is past already
    }
}

void hal_alarm_lock(void) {
    rp2_irq_off(alarm.irq);
}

void hal_alarm_unlock(void) {
    rp2_irq_on(alarm.irq);
}

void hal_wait_us(uint32_t us) {
    busy_wait_us_32(us);
}

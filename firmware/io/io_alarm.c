// The ends of pulses and of counting gates. Context: alarm, except io_alarm_update().
#include "io_alarm.h"

#include "hal/hal.h"
#include "hal/hal_io.h"
#include "io_count.h"
#include "io_pulse.h"

static void run_due(void) {
    uint64_t now_us = hal_time_us();
    io_pulse_run(now_us);
    io_count_run(now_us);
    io_alarm_update();
}

void io_alarm_update(void) {
    uint64_t pulse_us = io_pulse_next_us();
    uint64_t gate_us = io_count_next_us();
    hal_alarm_set(pulse_us < gate_us ? pulse_us : gate_us, run_due);
}

// The tables of rows and what the language asks of the product. Context: main loop.
#include "basic_cmds/basic_cmds.h"

#include "basic_cmds/com.h"
#include "basic_cmds/control.h"
#include "basic_cmds/gcode_lines.h"
#include "basic_cmds/homing.h"
#include "basic_cmds/i2c.h"
#include "basic_cmds/job.h"
#include "basic_cmds/machine_outputs.h"
#include "basic_cmds/safety.h"
#include "basic_cmds/setpin.h"
#include "basic_cmds/tables.h"
#include "basic_cmds/tmc.h"
#include "basic_cmds/tmc_homing.h"
#include "gcode/gcode_job.h"
#include "stepper/stepper_safety.h"

#define CTRL_F 6
#define CTRL_R 18

const basic_rows_t *const basic_cmds_tables[] = {
    &stepper_config_rows,
    &stepper_control_rows,
    &stepper_gcode_rows,
    &stepper_homing_rows,
    &stepper_report_rows,
    &stepper_safety_rows,
    &tmc_rows,
    &pin_rows,
    &bus_rows,
};
const size_t basic_cmds_table_count = COUNT_OF_ARRAY(basic_cmds_tables);

const basic_device_t *const basic_cmds_devices[] = {&com_device};
const size_t basic_cmds_device_count = COUNT_OF_ARRAY(basic_cmds_devices);

void basic_cmds_start(void) {
    tmc_homing_start();
}

void basic_cmds_clear(void) {
    com_clear();
    i2c_clear();
    setpin_clear();
    safety_clear();
}

void basic_cmds_new(void) {
    if (stepper_active() > 0) {
        basic_notice("Motion stops for the new program, what was queued is dropped");
    }
    control_await_stop();
    if (stepper_active() >= 0) {
        stepper_close();
    }
    tmc_homing_finish();
    tmc_new();
}

void basic_cmds_background(void) {
    setpin_background();
    com_background();
    homing_background();
    gcode_lines_background();
    safety_background();
    job_background();
    machine_outputs_background();
    tmc_background();
}

void basic_cmds_break(void) {
    if (stepper_active() > 0) {
        basic_notice("Ctrl-C: motion stops, what was queued is dropped");
    }
    stepper_stop();
}

void basic_cmds_error(void) {
    control_error();
}

err_t basic_cmds_may_restart(void) {
    bool active = stepper_active() > 0 || gcode_job_runs();
    return active ? err_raise(ERR_STEPPER_BUSY, "%s", "") : ERR_OK;
}

bool basic_cmds_job_runs(void) {
    return gcode_job_runs();
}

bool basic_cmds_control(char c) {
    stepper_status_t status;
    stepper_status(&status);
    if ((c != CTRL_F && c != CTRL_R) || (!status.moving && !status.holding)) {
        return false;
    }
    bool hold = c == CTRL_F;
    if (hold != status.holding && !status.stopping && stepper_hold(hold) == ERR_OK) {
        basic_notice(hold ? "Feed hold (Ctrl-R or STEPPER RESUME goes on)" : "Resumed");
    }
    return true;
}

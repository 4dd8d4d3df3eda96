// Start-up and the loop. Context: main loop.
#include "basic/basic.h"
#include "basic_cmds/basic_cmds.h"
#include "hal/hal.h"
#include "stepper/stepper.h"

static char banner[120];

static void start_basic(void) {
    size_t arena_size;
    void *arena = hal_memory(&arena_size);
    format_text(banner, sizeof banner, "StepMite %s on %s", hal_firmware_version(),
                hal_board_name());
    static basic_config_t config = {
        .background = basic_cmds_background,
        .on_break = basic_cmds_break,
        .on_control = basic_cmds_control,
        .on_clear = basic_cmds_clear,
        .on_new = basic_cmds_new,
        .on_error = basic_cmds_error,
        .may_restart = basic_cmds_may_restart,
        .banner = banner,
    };
    config.arena = arena;
    config.arena_size = arena_size;
    config.tables = basic_cmds_tables;
    config.table_count = basic_cmds_table_count;
    config.devices = basic_cmds_devices;
    config.device_count = basic_cmds_device_count;
    basic_cmds_start();
    basic_start(&config);
}

// Motion that is under way when input or program end is carried out to its end, unless it is held.
static void wait_until_idle(void) {
    stepper_status_t status;
    stepper_status(&status);
    while ((status.moving || basic_cmds_job_runs()) && !status.holding) {
        basic_wait(hal_time_us() + 1000);
        stepper_status(&status);
    }
    basic_wait(0); // what was told in the end
}

int main(int argc, char **argv) {
    hal_init(argc, argv);
    start_basic();
    size_t length;
    const char *program = hal_startup_program(&length);
    err_t err = ERR_OK;
    if (program != NULL) {
        err = basic_run_program(program, length);
    } else {
        basic_boot();
        while (basic_prompt()) {
        }
    }
    wait_until_idle();
    hal_exit(err == ERR_OK ? 0 : 1);
}

// Start and end of the board, and what it is called. Context: main.
#include "hal/hal.h"

#include "hardware/watchdog.h"
#include "pico/binary_info.h"
#include "pico/bootrom.h"

#include "rp2_port.h"
#include "version.h"

bi_decl(bi_program_version_string(STEPMITE_VERSION));

void hal_init(int argc, char **argv) {
    (void)argc;
    (void)argv;
    rp2_stack_guard();
    rp2_fault_init();
    rp2_idle_init();
    rp2_alarm_init();
    rp2_tick_init();
    rp2_governor_init();
    rp2_console_init();
}

const char *hal_startup_program(size_t *length) {
    *length = 0;
    return NULL;
}

bool hal_end_of_input(void) {
    return false;
}

_Noreturn void hal_exit(int code) {
    (void)code;
    watchdog_reboot(0, 0, 0);
    for (;;) {
        __wfi();
    }
}

_Noreturn void hal_bootloader(void) {
    rom_reset_usb_boot(0, 0);
    for (;;) {
        __wfi();
    }
}

const char *hal_board_name(void) {
#if PICO_RP2040
    return "Raspberry Pi Pico";
#else
    return "Raspberry Pi Pico 2";
#endif
}

const char *hal_firmware_version(void) {
    return STEPMITE_VERSION;
}

// TMC22xx: set-up of drivers, WIRE, AXIS, VERIFY, MONITOR, CLOSE. Context: main loop.
#include "basic_cmds/tmc.h"

#include "basic_cmds/control.h"
#include "basic_cmds/report.h"
#include "basic_cmds/tmc_homing.h"

#define CURRENT_IS_FAR 1.2 // times what was asked for

// Somebody has used drivers since RUN. Without any, the background of each statement costs nothing.
static bool in_use;

// ---- Waiting for drivers ------------------------------------------------------------------------

// A statement that Ctrl-C ends fails, so that no variable takes a value that nobody has read. The
// language does not show the error.
static err_t await_job(void) {
    while (tmc22xx_busy()) {
        if (!basic_wait(tmc22xx_wake_us())) {
            return err_raise(ERR_TMC_BROKEN_OFF, NULL);
        }
    }
    return ERR_OK;
}

err_t tmc_await_turn(void) {
    in_use = true;
    return await_job();
}

err_t tmc_finish(err_t begun) {
    if (begun != ERR_OK) {
        return begun;
    }
    err_t err = await_job();
    if (err != ERR_OK) {
        tmc22xx_give_up();
        return err;
    }
    return tmc22xx_result();
}

// ---- What the arguments mean --------------------------------------------------------------------

// Several drivers may belong to an axis; the wire, if it is given, tells which is meant.
static err_t find_axis(unsigned axis, unsigned tx_gpio, unsigned *driver) {
    tmc22xx_info_t info;
    for (unsigned i = 0; i < TMC22XX_DRIVERS && tx_gpio != PINS_NONE; i++) {
        if (tmc22xx_info(i, &info) && info.axis == axis && tmc22xx_driver(i)->tx_gpio == tx_gpio) {
            *driver = i;
            return ERR_OK;
        }
    }
    if (tx_gpio != PINS_NONE) {
        return err_raise(ERR_ARGUMENT, "driver: none on %s is tied to the %c axis",
                         pins_name(tx_gpio), STEPPER_AXIS_LETTERS[axis]);
    }
    return tmc22xx_find_axis(axis, driver);
}

static err_t find(const basic_arg_t *driver, const basic_arg_t *wire, unsigned *found) {
    unsigned choice = (unsigned)driver->integer;
    unsigned tx_gpio = (unsigned)wire->integer;
    return choice >= TMC_FIRST_AXIS ? find_axis(choice - TMC_FIRST_AXIS, tx_gpio, found)
                                    : tmc22xx_find(choice, (uint8_t)tx_gpio, found);
}

err_t tmc_begin(const basic_arg_t *driver, const basic_arg_t *wire, unsigned *found) {
    err_t err = tmc_await_turn(); // first: whoever closes a wire has his turn as well
    return err != ERR_OK ? err : find(driver, wire, found);
}

err_t tmc_check_feed(unsigned axis, double feed) {
    stepper_axis_t config;
    stepper_axis_config((axis_id_t)axis, &config);
    if (feed <= config.max_velocity) {
        return ERR_OK;
    }
    return err_raise(ERR_ARGUMENT,
                     "feed: %.9g is invalid (valid is above 0 to %.9g, the max_vel of %c)", feed,
                     config.max_velocity, STEPPER_AXIS_LETTERS[axis]);
}

uint32_t tmc_tstep(unsigned driver, double feed) {
    tmc22xx_info_t info;
    stepper_axis_t config;
    tmc22xx_info(driver, &info);
    stepper_axis_config((axis_id_t)info.axis, &config);
    return tmc22xx_tstep(feed / 60.0 * config.steps_per_unit, tmc22xx_driver(driver)->microsteps);
}

bool tmc_is_stealthy(unsigned driver, double feed) {
    tmc22xx_info_t info;
    tmc22xx_info(driver, &info);
    return tmc22xx_driver(driver)->stealth && tmc_tstep(driver, feed) > info.tpwmthrs;
}

err_t tmc_check_still(const char *what) {
    stepper_status_t status;
    stepper_status(&status);
    bool queued = status.initialized && status.blocks_free != status.blocks;
    if (report_active() <= 0 && !queued) {
        return ERR_OK;
    }
    return err_raise(ERR_ARGUMENT, "%s: cannot change while motion is active or queued", what);
}

void tmc_warn_of_current(unsigned driver) {
    const tmc22xx_settings_t *settings = tmc22xx_driver(driver);
    tmc22xx_current_t current;
    if (settings == NULL ||
        tmc22xx_current(settings->run_ma, settings->r_sense_ohm, &current) != ERR_OK) {
        return;
    }
    if (current.limited) {
        basic_printf("Warning: run_mA: %.6g is more than %.3g ohm allow, the motor gets %.0f mA\n",
                     settings->run_ma, settings->r_sense_ohm, current.real_ma);
    } else if (current.real_ma > CURRENT_IS_FAR * settings->run_ma) { // steps are coarse down there
        basic_printf("Warning: run_mA: the nearest to %.6g with %.3g ohm is %.0f mA\n",
                     settings->run_ma, settings->r_sense_ohm, current.real_ma);
    }
}

void tmc_warn_of_scale(unsigned driver, unsigned before) {
    tmc22xx_info_t info;
    unsigned now = tmc22xx_driver(driver) != NULL ? tmc22xx_driver(driver)->microsteps : 0;
    if (before == 0 || now == 0 || before == now || !tmc22xx_info(driver, &info) ||
        info.axis == TMC22XX_NO_AXIS || !stepper_axis_configured((axis_id_t)info.axis)) {
        return;
    }
    stepper_axis_t config;
    stepper_axis_config((axis_id_t)info.axis, &config);
    char letter = STEPPER_AXIS_LETTERS[info.axis];
    basic_printf("Warning: with %u instead of %u microsteps the %c axis needs STEPPER TUNE "
                 "%c,,%.9g\n",
                 now, before, letter, letter, config.steps_per_unit * now / before);
}

// ---- Set-up -------------------------------------------------------------------------------------

// The microsteps of a driver that is there, 0 of others.
static unsigned microsteps_of(const tmc22xx_settings_t *settings) {
    unsigned driver;
    bool found = tmc22xx_find(settings->address, settings->tx_gpio, &driver) == ERR_OK;
    return found ? tmc22xx_driver(driver)->microsteps : 0;
}

static err_t set_up(const tmc22xx_settings_t *settings) {
    unsigned driver;
    unsigned before = microsteps_of(settings);
    err_t err = ERR_OK;
    if (before != 0 && before != settings->microsteps) {
        err = tmc_check_still("microsteps");
    }
    if (err == ERR_OK) {
        err = tmc_finish(tmc22xx_set_up(settings));
    }
    if (err == ERR_OK && tmc22xx_find(settings->address, settings->tx_gpio, &driver) == ERR_OK) {
        tmc_warn_of_current(driver);
        tmc_warn_of_scale(driver, before);
    }
    return err;
}

err_t tmc_set_up(const basic_arg_t *args, size_t count) {
    (void)count;
    const tmc22xx_settings_t settings = {
        .tx_gpio = (uint8_t)args[TMC_SET_UP_PIN].integer,
        .address = (uint8_t)args[TMC_SET_UP_ADDRESS].integer,
        .chip = args[TMC_SET_UP_CHIP].integer == 0 ? 2208 : 2209, // in the order of TMC_CHIPS
        .run_ma = args[TMC_SET_UP_RUN].number,
        .hold_percent = args[TMC_SET_UP_HOLD].number,
        .microsteps = (uint16_t)(1u << args[TMC_SET_UP_MICROSTEPS].integer),
        .r_sense_ohm = args[TMC_SET_UP_R_SENSE].number,
        .stealth = args[TMC_SET_UP_STEALTH].integer != 0,
    };
    err_t err = tmc_await_turn();
    return err != ERR_OK ? err : set_up(&settings);
}

// ---- Wires, axes, switches ----------------------------------------------------------------------

err_t tmc_wire(const basic_arg_t *args, size_t count) {
    (void)count;
    uint8_t tx_gpio = (uint8_t)args[0].integer;
    uint8_t rx_gpio = args[1].integer == PINS_NONE ? tx_gpio : (uint8_t)args[1].integer;
    err_t err = tmc_homing_await();
    err = err != ERR_OK ? err : tmc_await_turn();
    return err != ERR_OK ? err : tmc22xx_wire(tx_gpio, rx_gpio, (uint32_t)args[2].integer);
}

err_t tmc_axis(const basic_arg_t *args, size_t count) {
    (void)count;
    unsigned driver;
    err_t err = find(&args[0], &args[2], &driver);
    if (err == ERR_OK) {
        bool none = !args[1].given || args[1].integer == 0;
        tmc22xx_tie(driver, none ? TMC22XX_NO_AXIS : (unsigned)args[1].integer - 1);
    }
    return err;
}

err_t tmc_verify(const basic_arg_t *args, size_t count) {
    (void)count;
    tmc22xx_verify(args[0].integer != 0);
    return ERR_OK;
}

err_t tmc_monitor(const basic_arg_t *args, size_t count) {
    (void)count;
    tmc22xx_monitor(args[0].integer != 0);
    return ERR_OK;
}

// Waits, so that no frame is cut off.
err_t tmc_close(const basic_arg_t *args, size_t count) {
    (void)count;
    err_t err = tmc_homing_await();
    err = err != ERR_OK ? err : tmc_await_turn();
    return err != ERR_OK ? err : tmc22xx_close((uint8_t)args[0].integer);
}

// ---- Life cycle ---------------------------------------------------------------------------------

// What is on a wire comes to its end first: a driver that has heard half of a frame could take the
// first one of the new program for the rest of it.
void tmc_new(void) {
    while (tmc22xx_busy()) {
        control_wait(tmc22xx_wake_us());
    }
    if (in_use) {
        tmc22xx_close(PINS_NONE); // no error for us if there is no wire
        in_use = false;
    }
    tmc22xx_verify(true);
    tmc22xx_monitor(true);
}

// Apart, so that its stack costs nothing where there are no drivers.
static __attribute__((noinline)) void tend(void) {
    tmc22xx_background();
    char text[ERR_MESSAGE_SIZE];
    if (tmc22xx_next_event(text, sizeof text)) {
        basic_notice("%s", text);
        tmc_homing_look();
    }
    if (tmc22xx_wake_us() != UINT64_MAX) {
        basic_wake_at(tmc22xx_wake_us());
    }
}

void tmc_background(void) {
    if (in_use) {
        tend();
    }
}

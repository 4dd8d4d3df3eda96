// Rows of the Trinamic drivers. Context: main loop.
#include "basic_cmds/row_args.h"
#include "basic_cmds/tables.h"
#include "basic_cmds/tmc.h"
#include "basic_cmds/tmc_report.h"
#include "basic_cmds/tmc_sgtune.h"
#include "basic_cmds/tmc_status.h"
#include "basic_cmds/tmc_tune.h"

#define DRIVER_ARG                                                                                 \
    {"driver", BASIC_ARG_CHOICE, .choices = TMC_DRIVERS,                                           \
     .help = "its address, or the axis it is tied to"}
#define WIRE_ARG                                                                                   \
    {"tx_pin", BASIC_ARG_PIN, OPTIONAL,                                                            \
     .help = "its wire, needed where two wires have a driver with this address"}

static const basic_arg_spec_t set_up_args[TMC_SET_UP_ARGS] = {
    [TMC_SET_UP_PIN] = {"tx_pin", BASIC_ARG_PIN,
                        .help = "the wire: through 1 k to PDN_UART; several drivers may share it"},
    [TMC_SET_UP_CHIP] = {"chip_type", BASIC_ARG_CHOICE, .choices = TMC_CHIPS, .help = "the chip"},
    [TMC_SET_UP_ADDRESS] = {"address", BASIC_ARG_INTEGER, .min = 0, .max = 3,
                            .help = "by MS1 and MS2 of a TMC2209; 0 for a TMC2208"},
    [TMC_SET_UP_RUN] = {"run_mA", BASIC_ARG_NUMBER, ABOVE, .min = 0, .max = TMC22XX_RUN_MA_MAX,
                        .unit = "mA RMS", .help = "current of a coil in motion"},
    [TMC_SET_UP_HOLD] = {"hold_pct", BASIC_ARG_NUMBER, .min = 0, .max = 100, .unit = "%",
                         .help = "part of it that holds the motor at standstill"},
    [TMC_SET_UP_MICROSTEPS] = {"microsteps", BASIC_ARG_CHOICE, .choices = TMC_MICROSTEPS,
                               .help = "to a full step; interpolated to 256"},
    [TMC_SET_UP_R_SENSE] = {"r_sense_ohm", BASIC_ARG_NUMBER, DEFAULTS,
                            .min = TMC22XX_R_SENSE_MIN_OHM, .max = TMC22XX_R_SENSE_MAX_OHM,
                            .fallback = TMC22XX_R_SENSE_OHM, .unit = "ohm",
                            .help = "resistors of the module"},
    [TMC_SET_UP_STEALTH] = {"stealthchop", BASIC_ARG_INTEGER, DEFAULTS, .min = 0, .max = 1,
                            .fallback = 1, .help = "1: StealthChop, 0: SpreadCycle"},
};

static const basic_arg_spec_t wire_args[] = {
    {"tx_pin", BASIC_ARG_PIN, .help = "the pin that sends"},
    {"rx_pin", BASIC_ARG_PIN, OPTIONAL, .help = "the pin that listens; left out: tx_pin does both"},
    {"baud", BASIC_ARG_INTEGER, DEFAULTS, .min = TMC22XX_BAUD_MIN, .max = TMC22XX_BAUD_MAX,
     .fallback = TMC22XX_BAUD, .unit = "bit/s", .help = "the drivers find it out by themselves"},
};

static const basic_arg_spec_t current_args[] = {
    DRIVER_ARG,
    {"run_mA", BASIC_ARG_NUMBER, ABOVE, .min = 0, .max = TMC22XX_RUN_MA_MAX, .unit = "mA RMS",
     .help = "current of a coil in motion"},
    {"hold_pct", BASIC_ARG_NUMBER, OPTIONAL, .min = 0, .max = 100, .unit = "%",
     .help = "part of it at standstill; left out: as it is"},
    WIRE_ARG,
};

static const basic_arg_spec_t sgthrs_args[] = {
    DRIVER_ARG,
    {"value", BASIC_ARG_INTEGER, .min = 0, .max = 255,
     .help = "a stall is SG_RESULT at or below twice this: more is more sensitive, 0 is never"},
    WIRE_ARG,
};

static const basic_arg_spec_t tcoolthrs_args[] = {
    DRIVER_ARG,
    {"value", BASIC_ARG_INTEGER, .min = 0, .max = TMC22XX_TSTEP_MAX,
     .help = "StallGuard and CoolStep work while TSTEP is at or below this; 0: never"},
    WIRE_ARG,
};

static const basic_arg_spec_t stall_args[] = {
    DRIVER_ARG,
    {"feed", BASIC_ARG_NUMBER, .min = 0, .max = 10000000, .unit = "mm/min or deg/min",
     .help = "speed of its axis from which on stalls are told; 0: homing chooses by itself"},
    {"always", BASIC_ARG_INTEGER, DEFAULTS, .min = 0, .max = 1,
     .help = "1: at once and for good; 0: only while homing, which switches it on and off"},
    WIRE_ARG,
};

static const basic_arg_spec_t sgtune_args[SGTUNE_ARGS] = {
    [SGTUNE_DRIVER] = DRIVER_ARG,
    [SGTUNE_FEED] = {"feed", BASIC_ARG_NUMBER, ABOVE, .min = 0, .max = 10000000,
                     .unit = "mm/min or deg/min", .help = "speed of the jog, that of homing"},
    [SGTUNE_DISTANCE] = {"distance", BASIC_ARG_NUMBER, OPTIONAL, .min = -100000, .max = 100000,
                         .unit = "mm or deg",
                         .help = "its way; left out: one second's at the feed"},
    [SGTUNE_TX_PIN] = WIRE_ARG,
};

static const basic_arg_spec_t coolstep_args[] = {
    DRIVER_ARG,
    {"semin", BASIC_ARG_INTEGER, .min = 0, .max = 15,
     .help = "more current when SG_RESULT is below 32 times this; 0: CoolStep is off"},
    {"semax", BASIC_ARG_INTEGER, DEFAULTS, .min = 0, .max = 15,
     .help = "less current when it is at or above 32 times (semin + semax + 1)"},
    {"seup", BASIC_ARG_INTEGER, DEFAULTS, .min = 0, .max = 3,
     .help = "step upwards: 0 to 3 for 1, 2, 4, 8 of 32"},
    {"sedn", BASIC_ARG_INTEGER, DEFAULTS, .min = 0, .max = 3,
     .help = "values of SG_RESULT for a step downwards: 0 to 3 for 32, 8, 2, 1"},
    {"seimin", BASIC_ARG_INTEGER, DEFAULTS, .min = 0, .max = 1,
     .help = "least current: 0: half of run_mA, 1: a quarter"},
    WIRE_ARG,
};

static const basic_arg_spec_t stealth_args[] = {
    DRIVER_ARG,
    {"threshold", BASIC_ARG_INTEGER, OPTIONAL, .min = 0, .max = TMC22XX_TSTEP_MAX, .choices = "OFF",
     .help = "StealthChop while TSTEP is at or above this, SpreadCycle when faster; 0 or left out: "
             "StealthChop at all speeds; OFF: at none"},
    {"feed", BASIC_ARG_NUMBER, OPTIONAL | ABOVE, .min = 0, .max = 10000000,
     .unit = "mm/min or deg/min",
     .help = "instead of threshold: the speed of its axis up to which StealthChop works"},
    WIRE_ARG,
};

static const basic_arg_spec_t axis_args[] = {
    DRIVER_ARG,
    {"axis", BASIC_ARG_CHOICE, OPTIONAL, .choices = "0|" TMC_AXES,
     .help = "the axis whose motor it drives; 0 or left out: none"},
    WIRE_ARG,
};

static const basic_arg_spec_t read_args[] = {
    DRIVER_ARG,
    {"register", BASIC_ARG_WORD, BASIC_ARG_OR_NUMBER, .min = 0, .max = 127,
     .help = "its name, as DRV_STATUS, or its address"},
    WIRE_ARG,
};

static const basic_arg_spec_t write_args[] = {
    DRIVER_ARG,
    {"register", BASIC_ARG_WORD, BASIC_ARG_OR_NUMBER, .min = 0, .max = 127,
     .help = "its name, as CHOPCONF, or its address"},
    {"value", BASIC_ARG_INTEGER, .min = 0, .max = 4294967295.0, .help = "its 32 bits"},
    WIRE_ARG,
};

static const basic_arg_spec_t status_args[] = {
    {"driver", BASIC_ARG_CHOICE, OPTIONAL, .choices = TMC_DRIVERS,
     .help = "its address, or the axis it is tied to; left out: all"},
    WIRE_ARG,
};

static const basic_arg_spec_t verify_args[] = {
    {"on", BASIC_ARG_INTEGER, .min = 0, .max = 1,
     .help = "1: each write is confirmed by the driver; 0: for boards on which it cannot answer"},
};

static const basic_arg_spec_t monitor_args[] = {
    {"on", BASIC_ARG_INTEGER, .min = 0, .max = 1,
     .help = "1: each driver is asked once a second, and what is wrong is told; 0: nobody asks"},
};

static const basic_arg_spec_t close_args[] = {
    {"tx_pin", BASIC_ARG_PIN, OPTIONAL, .help = "the wire; left out: all"},
};

static const basic_arg_spec_t peek_args[] = {
    DRIVER_ARG,
    {"what", BASIC_ARG_WORD, BASIC_ARG_OR_NUMBER, .min = 0, .max = 127,
     .help = "SG: load, the lower the heavier, 0 to 510; CS: current scale, 0 to 31; TEMP: highest "
             "threshold reached, 0, 120, 143, 150, 157 degrees Celsius; STATUS: DRV_STATUS; "
             "IFCNT: writes it has taken; or a register"},
    WIRE_ARG,
};

static const basic_command_t commands[] = {
    {"TMC22XX", ARGS(set_up_args), tmc_set_up,
     "Sets a TMC2208 or TMC2209 up over its wire; to be said again for other settings"},
    {"TMC22XX WIRE", ARGS(wire_args), tmc_wire,
     "Says how a wire is connected, where it has a pin of its own for replies or another speed"},
    {"TMC22XX CURRENT", ARGS(current_args), tmc_tune_current, "Sets the current of a motor"},
    {"TMC22XX SGTHRS", ARGS(sgthrs_args), tmc_tune_sgthrs,
     "Sets how sensitive StallGuard is; TMC2209 only"},
    {"TMC22XX SGTTHRS", ARGS(sgthrs_args), tmc_tune_sgthrs, "The same as TMC22XX SGTHRS"},
    {"TMC22XX TCOOLTHRS", ARGS(tcoolthrs_args), tmc_tune_tcoolthrs,
     "Sets the speed from which on StallGuard and CoolStep work; TMC2209 only"},
    {"TMC22XX STALL", ARGS(stall_args), tmc_tune_stall,
     "Sets TCOOLTHRS by a speed of the axis it is tied to, by default for homing; shows it"},
    {"TMC22XX SGTUNE", ARGS(sgtune_args), tmc_sgtune,
     "Jogs the axis of a TMC2209, shows SG_RESULT meanwhile and proposes SGTHRS and TCOOLTHRS"},
    {"TMC22XX COOLSTEP", ARGS(coolstep_args), tmc_tune_coolstep,
     "Lets the current follow the load, where TCOOLTHRS allows it; TMC2209 only"},
    {"TMC22XX STEALTH", ARGS(stealth_args), tmc_tune_stealth,
     "Chooses StealthChop, and the speed above which it becomes SpreadCycle; shows TPWMTHRS"},
    {"TMC22XX AXIS", ARGS(axis_args), tmc_axis,
     "Ties a driver to an axis: it has its letter as a name, and homing arms its StallGuard"},
    {"TMC22XX READ", ARGS(read_args), tmc_report_read, "Shows a register and its fields"},
    {"TMC22XX WRITE", ARGS(write_args), tmc_report_write,
     "Writes a register; a later set-up does not know of it"},
    {"TMC22XX STATUS", ARGS(status_args), tmc_status,
     "Shows settings, faults, current and load of one driver or all"},
    {"TMC22XX VERIFY", ARGS(verify_args), tmc_verify,
     "Chooses whether the drivers are listened to"},
    {"TMC22XX MONITOR", ARGS(monitor_args), tmc_monitor,
     "Chooses whether the drivers are watched in the background"},
    {"TMC22XX CLOSE", ARGS(close_args), tmc_close,
     "Releases the pins; the drivers keep what they have"},
};

static const basic_function_t functions[] = {
    {"PEEK", "TMC", ARGS(peek_args), tmc_report_peek, "What a driver says"},
};

const basic_rows_t tmc_rows = {COMMANDS(commands), FUNCTIONS(functions)};

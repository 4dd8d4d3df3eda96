// The tables of rows, one for each subject. Inside basic_cmds/ only.
#ifndef BASIC_CMDS_TABLES_H
#define BASIC_CMDS_TABLES_H

#include "basic/basic.h"

extern const basic_rows_t stepper_config_rows;
extern const basic_rows_t stepper_control_rows;
extern const basic_rows_t stepper_gcode_rows;
extern const basic_rows_t stepper_homing_rows;
extern const basic_rows_t stepper_report_rows;
extern const basic_rows_t stepper_safety_rows;
extern const basic_rows_t tmc_rows;
extern const basic_rows_t pin_rows;
extern const basic_rows_t bus_rows;

#endif

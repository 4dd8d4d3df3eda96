// Handlers of the commands that take G-code. Inside basic_cmds/ only. Context: main loop.
#ifndef BASIC_CMDS_GCODE_LINES_H
#define BASIC_CMDS_GCODE_LINES_H

#include "basic/basic.h"

err_t gcode_lines_text(const basic_arg_t *args, size_t count);
err_t gcode_lines_words(const basic_arg_t *args, size_t count);
err_t gcode_lines_arc_legacy(const basic_arg_t *args, size_t count);
err_t gcode_lines_block_delete(const basic_arg_t *args, size_t count);
err_t gcode_lines_optional_stop(const basic_arg_t *args, size_t count);

// In the order of these indexes.
#define GCODE_LINES_DIALECTS "REFERENCE|NIST"
err_t gcode_lines_dialect(const basic_arg_t *args, size_t count);

// Takes what lines have left to do on, and tells what became of them.
void gcode_lines_background(void);

// The lines of STEPPER STATUS.
void gcode_lines_report(void);

// The system has just been initialised.
void gcode_lines_reset(void);

#endif

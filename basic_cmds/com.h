// Serial ports as channels: OPEN "COM1:9600" AS #1. Inside basic_cmds/ only. Context: main loop.
#ifndef BASIC_CMDS_COM_H
#define BASIC_CMDS_COM_H

#include "basic/basic.h"
#include "basic/basic_device.h"

extern const basic_device_t com_device;

extern const basic_arg_spec_t com_setpin_args[3];

// SETPIN receive, send, COM1|COM2.
err_t com_setpin(const basic_arg_t *args, size_t count);

// For the background hook: raises the events of ports that have received enough.
void com_background(void);

// For the hook of RUN and NEW.
void com_clear(void);

#endif

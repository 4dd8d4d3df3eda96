// Who has which of the product's events. Inside basic_cmds/ only.
#ifndef BASIC_CMDS_EVENTS_H
#define BASIC_CMDS_EVENTS_H

#include "basic/basic.h"

enum {
    EVENTS_PINS = BASIC_EVENT_PRODUCT, // SETPIN INTH and its companions
    EVENTS_PINS_COUNT = 10,
    EVENTS_COM = EVENTS_PINS + EVENTS_PINS_COUNT, // a serial port has received something
    EVENTS_COM_COUNT = 2,
    EVENTS_STEPPER = EVENTS_COM + EVENTS_COM_COUNT, // ON STEPPER EVENT
    EVENTS_END
};
_Static_assert((int)EVENTS_END <= (int)BASIC_EVENTS, "too many events");

#endif

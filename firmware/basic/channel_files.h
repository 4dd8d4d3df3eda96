// Files as a kind of channel. Context: main loop.
#ifndef BASIC_CHANNEL_FILES_H
#define BASIC_CHANNEL_FILES_H

#include "basic/basic_device.h"

extern const basic_device_t channel_files;

#endif

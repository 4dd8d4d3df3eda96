// XMODEM SEND and RECEIVE: files and the program. Context: main loop.
#ifndef BASIC_TRANSFER_H
#define BASIC_TRANSFER_H

#include "base/base.h"

// The file is as it was unless all of it has come.
err_t transfer_receive_file(const char *path);
err_t transfer_send_file(const char *path);

// A new program; the old one stays unless all of it has come and is stored. Only while none runs.
err_t transfer_receive_program(void);
err_t transfer_send_program(void);

#endif

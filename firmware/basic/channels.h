// Numbered channels: what OPEN makes and PRINT #, INPUT #, EOF() and their like use. Files and the
// devices of the configuration (basic_device.h) are kinds of channels; number 0 is the console.
// Functions end the statement by an error unless they say otherwise. Context: main loop.
#ifndef BASIC_CHANNELS_H
#define BASIC_CHANNELS_H

#include "basic/basic_device.h"
#include "value.h"

#define CHANNELS_MAX 10

// No channel is open; takes the devices of the configuration.
void channels_start(const basic_config_t *config);

// The number a value says, 0 to CHANNELS_MAX. Error: out of range.
unsigned channels_number(const value_t *value);

// Errors: the number is in use or 0, and what the file or device says.
void channels_open(unsigned number, basic_text_t name, basic_device_mode_t mode);
void channels_close(unsigned number);

// Closes all up to the first that makes an error.
void channels_close_open(void);

// Closes all when a program starts or ends. Returns an error that one of them has met.
err_t channels_end_program(void);

// Writes the text as a whole: an error means that nothing of it was taken. Ctrl-C ends the wait for
// a device that has no room.
void channels_write(unsigned number, const char *text, size_t length);

// Column of the next character, from 0.
unsigned channels_column(unsigned number);

// The column behind `text` if it starts in `column`.
unsigned channels_column_behind(unsigned column, const char *text, size_t length);

// A line without its end, which is CR, LF or both; `line` has VALUE_STRING_MAX bytes. At the end of
// a file it is empty. Errors: longer than that (the file's position stays, a port gives it in
// parts).
size_t channels_read_line(unsigned number, char *line);

// Up to `size` bytes of what is there.
size_t channels_read(unsigned number, char *bytes, size_t size);

bool channels_at_end(unsigned number);
uint32_t channels_length(unsigned number);
uint32_t channels_position(unsigned number);
void channels_seek(unsigned number, int64_t position);
void channels_flush(unsigned number);

#endif

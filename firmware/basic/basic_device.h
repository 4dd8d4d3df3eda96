// What OPEN makes a channel of, besides files: a kind of device, for instance serial ports. A
// second face of firmware/basic. Context: main loop.
#ifndef BASIC_DEVICE_H
#define BASIC_DEVICE_H

#include "basic/basic.h"

// OPEN name$ FOR ...; a device other than a file is mostly opened without FOR.
typedef enum {
    BASIC_DEVICE_UNSAID,
    BASIC_DEVICE_INPUT,
    BASIC_DEVICE_OUTPUT,
    BASIC_DEVICE_APPEND,
    BASIC_DEVICE_RANDOM,
} basic_device_mode_t;

// Those that return err_t raise the error; `handle` is what open() gave.
typedef struct basic_device {
    // OPEN takes this device for names that start with these letters (any case) and in which a
    // digit or a colon follows: "COM" for "COM2:115200".
    const char *name;

    // `text` is all of the name in OPEN. *handle is the device's own number for what it opened.
    err_t (*open)(basic_text_t text, basic_device_mode_t mode, int *handle);

    // The handle is free, whatever comes of it.
    err_t (*close)(int handle);

    // Sends. *took is how many bytes were taken; fewer than `size` without an error: there is no
    // room just now, and the caller waits and offers the rest. With an error nothing was taken.
    err_t (*write)(int handle, const void *bytes, size_t size, size_t *took);

    // Takes up to `size` bytes of what is there; *got may be 0.
    err_t (*read)(int handle, void *bytes, size_t size, size_t *got);

    bool (*at_end)(int handle);     // EOF(): there is nothing to read (now)
    uint32_t (*length)(int handle); // LOF(): a file's size; a port: bytes that can be sent at once
    uint32_t (*position)(int handle); // LOC(): a file's next byte, from 1; a port: bytes received

    // SEEK, `position` from 1. NULL: a stream. Whoever reads a line from a stream waits for it.
    err_t (*seek)(int handle, uint32_t position);

    // FLUSH: returns when nothing waits to be stored or sent. NULL: nothing to do.
    err_t (*flush)(int handle);
} basic_device_t;

#endif

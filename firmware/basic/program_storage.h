// The program in flash. Two places take turns: the old program is there, whole, until the new one
// is complete. Context: main loop.
#ifndef BASIC_PROGRAM_STORAGE_H
#define BASIC_PROGRAM_STORAGE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/base.h"
#include "hal/hal.h"

#define PROGRAM_STORAGE_PLACE (128u * 1024u)
// Longest program that can be kept.
#define PROGRAM_STORAGE_MAX (PROGRAM_STORAGE_PLACE - HAL_STORAGE_PAGE)

// A program on its way to the flash. Belongs to whoever writes it; giving it up needs nothing.
typedef struct {
    uint8_t page[HAL_STORAGE_PAGE]; // not written yet
    uint32_t used;                  // of the page
    uint32_t base;                  // of the place
    uint32_t written;               // bytes of text before the page
    uint32_t sequence;
    uint32_t crc;
    bool after_return; // a \n now is the second half of a line end
} program_storage_t;

// Starts a new program. The one that is stored stays until the commit.
void program_storage_begin(program_storage_t *writer);

// Adds text, which may lie in flash; line ends become \n.
// Errors: motion is under way, the flash failed, too long. The new program is given up then.
err_t program_storage_add(program_storage_t *writer, const char *text, size_t size);

// What was added is the program from now on. Errors: as above.
err_t program_storage_commit(program_storage_t *writer);

// The program and its length; valid until the next commit. An empty text if there is none.
// `damaged` becomes true if a newer one is not whole: it was spoiled, or its writing was cut off.
const char *program_storage_text(size_t *length, bool *damaged);

#endif

// What XMODEM carries, and where to. Context: main loop.
#include "transfer.h"

#include <string.h>

#include "console.h"
#include "file_output.h"
#include "files/files.h"
#include "hal/hal.h"
#include "memory.h"
#include "program.h"
#include "xmodem.h"

#define RESERVE 1024u // of the arena, left free beside a program that comes in

static struct {
    int file;      // being sent
    char *text;    // of a program, in the free part of the arena
    size_t size;   // of that
    size_t length; // of what came or went so far
} transfer;

// The other side writes to the terminal's line; this shows that it is the prompt's again.
static void report(const char *done) {
    char line[48];
    format_text(line, sizeof line, "%u bytes %s\r\n", (unsigned)transfer.length, done);
    console_fresh_line();
    console_print(line);
}

// ---- Files --------------------------------------------------------------------------------------

static err_t take_for_file(const void *bytes, size_t size) {
    transfer.length += size;
    return file_output_write(bytes, size);
}

err_t transfer_receive_file(const char *path) {
    uint8_t *buffer = memory_scratch(XMODEM_BUFFER_SIZE);
    transfer.length = 0;
    err_t error = file_output_start(path);
    if (error != ERR_OK) {
        return error;
    }
    error = file_output_end(xmodem_receive(take_for_file, buffer));
    if (error == ERR_OK) {
        report("received");
    }
    return error;
}

static err_t give_file(void *bytes, size_t size, size_t *got) {
    err_t error = files_read(transfer.file, bytes, size, got);
    transfer.length += *got;
    return error;
}

err_t transfer_send_file(const char *path) {
    uint8_t *buffer = memory_scratch(XMODEM_BUFFER_SIZE);
    transfer.length = 0;
    err_t error = files_open(path, FILES_READ, &transfer.file);
    if (error != ERR_OK) {
        return error;
    }
    error = xmodem_send(give_file, buffer);
    files_close(transfer.file);
    if (error == ERR_OK) {
        report("sent");
    }
    return error;
}

// ---- The program --------------------------------------------------------------------------------

static err_t take_for_program(const void *bytes, size_t size) {
    if (size > transfer.size - transfer.length) {
        return err_raise(ERR_NO_MEMORY, NULL);
    }
    memcpy(transfer.text + transfer.length, bytes, size);
    transfer.length += size;
    return ERR_OK;
}

err_t transfer_receive_program(void) {
    if (!hal_storage_is_writable()) {
        return err_raise(ERR_STORAGE_BUSY, NULL);
    }
    uint8_t *scratch = memory.scratch;
    uint8_t *buffer = memory_scratch(XMODEM_BUFFER_SIZE);
    transfer.length = 0;
    transfer.text = (char *)memory.heap;
    transfer.size = memory_free() > RESERVE ? memory_free() - RESERVE : 0;
    err_t error = xmodem_receive(take_for_program, buffer);
    memory.scratch = scratch;
    while (transfer.length > 0 && transfer.text[transfer.length - 1] == '\0') {
        transfer.length--; // how some programs fill the last block
    }
    size_t received = transfer.length;
    if (error == ERR_OK) {
        error = program_set_text(transfer.text, transfer.length);
    }
    transfer.length = received;
    if (error == ERR_OK) {
        report("received");
    }
    return error;
}

static err_t give_program(void *bytes, size_t size, size_t *got) {
    size_t left = program_length() - transfer.length;
    *got = left < size ? left : size;
    memcpy(bytes, program_text() + transfer.length, *got);
    transfer.length += *got;
    return ERR_OK;
}

err_t transfer_send_program(void) {
    transfer.length = 0;
    if (program_length() == 0) {
        return err_raise(ERR_NO_PROGRAM, NULL);
    }
    err_t error = xmodem_send(give_program, memory_scratch(XMODEM_BUFFER_SIZE));
    if (error == ERR_OK) {
        report("sent");
    }
    return error;
}

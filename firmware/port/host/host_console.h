// The console on stdin and stdout, both buffered here so that neither a slow reader nor a slow
// writer ever holds the firmware. Context: main.
#ifndef HOST_CONSOLE_H
#define HOST_CONSOLE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

// Takes in what has been typed and sends what can go, without waiting.
void host_console_poll(void);

// True if there is input that the firmware has not had a chance to take: it came, or part of it was
// taken, since this was last asked. Input the firmware leaves lying is no news.
bool host_console_has_news(void);

// True if input, or SIGINT, came since this was last asked.
bool host_console_take_came(void);

// True once stdin has ended; input may still be waiting to be taken.
bool host_console_at_end(void);

// True if there is output that could not be sent yet.
bool host_console_is_blocked(void);

// Sleeps until there is new input, blocked output can move, a signal comes, or for `timeout_ns` of
// wall time (UINT64_MAX: no limit).
void host_console_wait(uint64_t timeout_ns);

// Sends what is left, however slow the reader, unless a signal ends the program.
void host_console_finish(void);

// A peer in the same program that takes the place of stdin and stdout, for tests.
typedef struct {
    size_t (*send)(uint8_t *bytes,
                   size_t size); // input for the firmware, up to `size`; 0: none now
    bool (*at_end)(void);        // no more will come
    void (*receive)(const uint8_t *bytes, size_t size); // output of the firmware
} host_console_peer_t;

void host_console_attach(const host_console_peer_t *peer);

#endif

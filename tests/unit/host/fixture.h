// What the tests of the host port share: a core to be called by the port, files, and expected
// exits.
#ifndef FIXTURE_H
#define FIXTURE_H

#include <stddef.h>

// What the port calls in place of the core; NULL: nothing. Reset by fixture_reset().
typedef struct {
    void (*on_tick)(void);
    void (*on_governor)(void);
} fixture_core_t;

extern fixture_core_t fixture_core;

// Stops the tick, unlocks the governor and forgets the core.
void fixture_reset(void);

// Writes a file in a directory of this run, which is removed at its end. Returns its path.
const char *fixture_file(const char *name, const void *bytes, size_t size);

// Reads at most `size` - 1 bytes and ends them with a zero. Returns how many.
size_t fixture_read(const char *path, char *buffer, size_t size);

// Runs `action` in a child process. Its exit code; what it wrote to stderr goes to `message`.
int fixture_exit_code(void (*action)(void *), void *argument, char *message, size_t size);

#endif

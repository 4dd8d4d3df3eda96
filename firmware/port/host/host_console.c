// Moves bytes between the firmware and stdin, stdout. Context: main.
#include "host_console.h"

#include <errno.h>
#include <poll.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "hal/hal.h"
#include "host_signals.h"
#include "host_terminal.h"

#define BUFFER_SIZE 65536
#define SEND_CHUNK 512    // poll() promises room for this much: POSIX's smallest PIPE_BUF
#define SEND_EARLY 4096   // output waiting that is sent without being asked
#define READS_PER_POLL 64 // a program may ask for input at every statement; a system call is dearer
#define KEY_CTRL_C 3
#define KEY_CTRL_D 4

typedef struct {
    uint8_t bytes[BUFFER_SIZE];
    size_t start; // first byte waiting
    size_t end;   // behind the last
} queue_t;

static struct {
    queue_t input;
    queue_t output;
    bool at_end;
    bool raw;              // Ctrl-D is data
    bool came;             // input, since host_console_take_came()
    uint64_t changes;      // times input came or was taken
    uint64_t changes_seen; // as of the last host_console_has_news()
    unsigned idle_reads;   // hal_console_read() in vain since the last look at stdin
    const host_console_peer_t *peer;
} console;

static size_t queue_used(const queue_t *queue) {
    return queue->end - queue->start;
}

// Moves what is waiting to the front. Returns the room behind it.
static size_t queue_room(queue_t *queue) {
    if (queue->start > 0) {
        memmove(queue->bytes, queue->bytes + queue->start, queue_used(queue));
        queue->end -= queue->start;
        queue->start = 0;
    }
    return BUFFER_SIZE - queue->end;
}

static bool can(int file, short events) {
    struct pollfd state = {.fd = file, .events = events};
    return poll(&state, 1, 0) > 0;
}

// ---- Input --------------------------------------------------------------------------------------

static void take_input(void) {
    size_t room = queue_room(&console.input);
    if (console.at_end || room == 0) {
        return;
    }
    uint8_t *to = console.input.bytes + console.input.end;
    if (console.peer != NULL) {
        size_t got = console.peer->send(to, room);
        console.input.end += got;
        console.changes += got > 0;
        console.came |= got > 0;
        console.at_end = console.peer->at_end();
        return;
    }
    if (!can(STDIN_FILENO, POLLIN)) {
        return;
    }
    ssize_t got = read(STDIN_FILENO, to, room);
    if (got < 0 && (errno == EINTR || errno == EAGAIN)) {
        return;
    }
    if (got <= 0) { // end of file, or the terminal has gone
        console.at_end = true;
        return;
    }
    bool is_key = host_terminal_is_raw() && !console.raw;
    uint8_t *ctrl_d = is_key ? memchr(to, KEY_CTRL_D, (size_t)got) : NULL;
    if (ctrl_d != NULL) {
        console.at_end = true;
        got = ctrl_d - to;
    }
    console.input.end += (size_t)got;
    console.changes++;
    console.came = true;
}

size_t hal_console_read(uint8_t *bytes, size_t size) {
    host_signals_check();
    if (host_signals_interrupted() && size > 0) { // before what is waiting: it is to stop just that
        host_signals_take_interrupt();
        bytes[0] = KEY_CTRL_C;
        return 1;
    }
    if (queue_used(&console.input) == 0 && console.idle_reads++ % READS_PER_POLL == 0) {
        host_console_poll();
    }
    size_t count = queue_used(&console.input) < size ? queue_used(&console.input) : size;
    memcpy(bytes, console.input.bytes + console.input.start, count);
    console.input.start += count;
    console.changes += count > 0;
    return count;
}

void hal_console_set_raw(bool raw) {
    console.raw = raw;
}

// Not on a terminal: there SIGINT is Ctrl-C.
bool hal_console_break_is_inband(void) {
    return host_terminal_is_raw() || console.peer != NULL;
}

bool host_console_has_news(void) {
    bool news = console.changes != console.changes_seen && queue_used(&console.input) > 0;
    console.changes_seen = console.changes;
    return news || host_signals_interrupted();
}

bool host_console_take_came(void) {
    bool came = console.came;
    console.came = false;
    return came || host_signals_interrupted();
}

bool host_console_at_end(void) {
    return console.at_end;
}

bool hal_end_of_input(void) {
    return console.at_end && queue_used(&console.input) == 0 && !host_signals_interrupted();
}

// ---- Output -------------------------------------------------------------------------------------

// The reader has gone: nobody is left to be told, so this ends without a word.
static _Noreturn void leave_quietly(void) {
    console.output.start = console.output.end;
    exit(1);
}

// Sends up to a chunk. Returns false if nothing could be sent now.
static bool send_chunk(void) {
    const uint8_t *from = console.output.bytes + console.output.start;
    size_t count = queue_used(&console.output);
    if (count == 0) {
        return false;
    }
    if (console.peer != NULL) {
        console.peer->receive(from, count);
        console.output.start += count;
        return true;
    }
    if (!can(STDOUT_FILENO, POLLOUT)) {
        return false;
    }
    ssize_t done = write(STDOUT_FILENO, from, count < SEND_CHUNK ? count : SEND_CHUNK);
    if (done < 0 && errno != EINTR && errno != EAGAIN) {
        leave_quietly();
    }
    console.output.start += done > 0 ? (size_t)done : 0;
    return done > 0;
}

static void send_output(void) {
    while (send_chunk()) {
    }
}

size_t hal_console_write(const uint8_t *bytes, size_t size) {
    host_signals_check();
    size_t room = queue_room(&console.output);
    if (room < size) {
        send_output();
        room = queue_room(&console.output);
    }
    size_t count = size < room ? size : room;
    memcpy(console.output.bytes + console.output.end, bytes, count);
    console.output.end += count;
    if (queue_used(&console.output) >= SEND_EARLY) {
        send_output();
    }
    return count;
}

bool host_console_is_blocked(void) {
    return queue_used(&console.output) > 0;
}

// ---- Both ---------------------------------------------------------------------------------------

void host_console_poll(void) {
    console.idle_reads = 1;
    send_output();
    take_input();
}

void host_console_wait(uint64_t timeout_ns) {
    if (console.peer == NULL) {
        bool can_take = !console.at_end && queue_room(&console.input) > 0;
        host_signals_wait(can_take ? STDIN_FILENO : -1,
                          host_console_is_blocked() ? STDOUT_FILENO : -1, timeout_ns);
    }
    host_console_poll();
}

void host_console_finish(void) {
    send_output();
    while (host_console_is_blocked() && !host_signals_leaving() && !host_signals_interrupted()) {
        host_signals_wait(-1, STDOUT_FILENO, UINT64_MAX);
        send_output();
    }
}

void host_console_attach(const host_console_peer_t *peer) {
    console.peer = peer;
    console.at_end = false;
}

// Writes the edge file through a buffer; rows are formatted by hand because long jobs have hundreds
// of millions of them. Context: any.
#include "host_trace.h"

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <unistd.h>

#include "host_clock.h"
#include "host_pwm.h"
#include "host_system.h"

#define BUFFER_SIZE 65536
#define ROW_SIZE_MAX 26 // 20 digits, comma, 2 digits, comma, level, newline

static struct {
    int file;
    const char *path;
    size_t used;
    char buffer[BUFFER_SIZE];
} trace = {.file = -1};

static void write_out(void) {
    const char *from = trace.buffer;
    while (trace.used > 0) {
        ssize_t done = write(trace.file, from, trace.used);
        if (done < 0 && errno != EINTR) {
            trace.file = -1; // so that leaving does not try again
            host_system_fail("%s: %s", trace.path, strerror(errno));
        }
        if (done > 0) {
            from += done;
            trace.used -= (size_t)done;
        }
    }
}

static void append_number(uint64_t value) {
    char digits[20];
    size_t count = 0;
    do {
        digits[count++] = (char)('0' + value % 10);
        value /= 10;
    } while (value > 0);
    while (count > 0) {
        trace.buffer[trace.used++] = digits[--count];
    }
}

bool host_trace_is_open(void) {
    return trace.file >= 0;
}

void host_trace_row(uint64_t time_ns, unsigned gpio, bool level) {
    if (trace.file < 0) {
        return;
    }
    if (trace.used > BUFFER_SIZE - ROW_SIZE_MAX) {
        write_out();
    }
    append_number(time_ns);
    trace.buffer[trace.used++] = ',';
    append_number(gpio);
    trace.buffer[trace.used++] = ',';
    trace.buffer[trace.used++] = level ? '1' : '0';
    trace.buffer[trace.used++] = '\n';
}

void host_trace_open(const char *path) {
    static const char header[] = "time_ns,gpio,level\n";
    trace.path = path;
    trace.file = open(path, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (trace.file < 0) {
        host_system_fail("%s: %s", path, strerror(errno));
    }
    memcpy(trace.buffer, header, sizeof header - 1);
    trace.used = sizeof header - 1;
}

void host_trace_edges(uint64_t time_ns, uint32_t changed, uint32_t levels) {
    if (trace.file < 0) {
        return;
    }
    host_pwm_record(time_ns);
    for (; changed != 0; changed &= changed - 1) {
        unsigned gpio = (unsigned)__builtin_ctz(changed);
        host_trace_row(time_ns, gpio, (levels >> gpio & 1u) != 0);
    }
}

void host_trace_close(void) {
    if (trace.file >= 0) {
        host_pwm_record(host_clock_now_ns());
        write_out();
        close(trace.file);
        trace.file = -1;
    }
}

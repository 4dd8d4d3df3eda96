// Signal handlers and the flags they set. Context: main; the handlers run in between anywhere and
// use only what a handler may use.
#include "host_signals.h"

#include <errno.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/select.h>
#include <time.h>
#include <unistd.h>

#include "host_terminal.h"

#define QUIT_WINDOW_NS 2000000000u // two SIGINT within this time mean "quit"

static volatile sig_atomic_t exit_code; // 0: stay
static volatile sig_atomic_t interrupted;
static uint64_t last_interrupt_ns; // handler only

uint64_t host_signals_wall_ns(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (uint64_t)now.tv_sec * 1000000000u + (uint64_t)now.tv_nsec;
}

// The second request does not wait for a place where it is safe.
static void leave(int signal_number) {
    if (exit_code != 0) {
        host_terminal_restore();
        _exit(128 + signal_number);
    }
    exit_code = 128 + signal_number;
}

static void on_interrupt(int signal_number) {
    int saved_errno = errno;
    uint64_t now_ns = host_signals_wall_ns();
    if (last_interrupt_ns != 0 && now_ns - last_interrupt_ns < QUIT_WINDOW_NS) {
        leave(signal_number);
    }
    last_interrupt_ns = now_ns;
    interrupted = 1;
    errno = saved_errno;
}

static void handle(int signal_number, void (*handler)(int)) {
    struct sigaction action = {.sa_handler = handler};
    sigfillset(&action.sa_mask); // handlers do not interrupt each other
    sigaction(signal_number, &action, NULL);
}

void host_signals_init(void) {
    handle(SIGINT, on_interrupt);
    handle(SIGTERM, leave);
    handle(SIGHUP, leave);
    handle(SIGQUIT, leave);
    handle(SIGPIPE, SIG_IGN);
}

void host_signals_check(void) {
    if (exit_code != 0) {
        exit(exit_code);
    }
}

bool host_signals_leaving(void) {
    return exit_code != 0;
}

bool host_signals_interrupted(void) {
    return interrupted != 0;
}

void host_signals_take_interrupt(void) {
    interrupted = 0;
}

static int add_file(fd_set *set, int file) {
    FD_ZERO(set);
    if (file >= 0) {
        FD_SET(file, set);
    }
    return file + 1;
}

void host_signals_wait(int read_file, int write_file, uint64_t timeout_ns) {
    fd_set readable;
    fd_set writable;
    int read_count = add_file(&readable, read_file);
    int write_count = add_file(&writable, write_file);
    sigset_t all;
    sigset_t before;
    sigfillset(&all);
    sigprocmask(SIG_SETMASK, &all, &before);
    if (exit_code != 0 || interrupted != 0) {
        timeout_ns = 0;
    }
    struct timespec timeout = {.tv_sec = (time_t)(timeout_ns / 1000000000u),
                               .tv_nsec = (long)(timeout_ns % 1000000000u)};
    pselect(read_count > write_count ? read_count : write_count, &readable, &writable, NULL,
            timeout_ns == UINT64_MAX ? NULL : &timeout, &before);
    sigprocmask(SIG_SETMASK, &before, NULL);
}

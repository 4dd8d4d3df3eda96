// Raw mode of the terminal and its way back. Context: main; the handlers at the end run anywhere.
#include "host_terminal.h"

#include <signal.h>
#include <termios.h>
#include <unistd.h>

#include "base/base.h"

static const int crash_signals[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT};

static struct {
    struct termios before;
    struct termios raw;
    struct sigaction crash_actions[COUNT_OF_ARRAY(crash_signals)];
    volatile sig_atomic_t is_raw;
} terminal;

void host_terminal_restore(void) {
    if (terminal.is_raw) {
        tcsetattr(STDIN_FILENO, TCSANOW, &terminal.before);
        terminal.is_raw = 0;
    }
}

bool host_terminal_is_raw(void) {
    return terminal.is_raw != 0;
}

// Puts the action back that was there before (a sanitizer has one) and leaves the rest to it: a
// fault repeats itself on return, a signal that somebody sent has to be sent again.
static void on_crash(int signal_number, siginfo_t *info, void *context) {
    (void)context;
    host_terminal_restore();
    for (size_t i = 0; i < COUNT_OF_ARRAY(crash_signals); i++) {
        if (crash_signals[i] == signal_number) {
            sigaction(signal_number, &terminal.crash_actions[i], NULL);
        }
    }
    bool was_sent = info->si_code <= 0;
    if (was_sent) {
        raise(signal_number);
    }
}

// Somebody stops the program from outside: the shell wants its terminal back meanwhile.
static void on_stop(int signal_number) {
    (void)signal_number;
    host_terminal_restore();
    raise(SIGSTOP);
    tcsetattr(STDIN_FILENO, TCSANOW, &terminal.raw);
    terminal.is_raw = 1;
}

static void make_raw(struct termios *settings) {
    settings->c_iflag &= ~(tcflag_t)(BRKINT | ICRNL | INLCR | IGNCR | INPCK | ISTRIP | IXON);
    settings->c_oflag &= ~(tcflag_t)OPOST;
    settings->c_lflag &= ~(tcflag_t)(ECHO | ECHONL | ICANON | IEXTEN);
    settings->c_cc[VINTR] = _POSIX_VDISABLE;
    settings->c_cc[VSUSP] = _POSIX_VDISABLE;
    settings->c_cc[VMIN] = 1;
    settings->c_cc[VTIME] = 0;
}

void host_terminal_raw(void) {
    if (tcgetattr(STDIN_FILENO, &terminal.before) != 0) {
        return; // not a terminal
    }
    terminal.raw = terminal.before;
    make_raw(&terminal.raw);
    for (size_t i = 0; i < COUNT_OF_ARRAY(crash_signals); i++) {
        struct sigaction action = {.sa_sigaction = on_crash, .sa_flags = SA_SIGINFO};
        sigaction(crash_signals[i], &action, &terminal.crash_actions[i]);
    }
    struct sigaction stop = {.sa_handler = on_stop};
    sigaction(SIGTSTP, &stop, NULL);
    if (tcsetattr(STDIN_FILENO, TCSANOW, &terminal.raw) == 0) {
        terminal.is_raw = 1;
    }
}

// Start and end of the host program. Context: main.
#ifndef HOST_SYSTEM_H
#define HOST_SYSTEM_H

// Exit code for a wrong command line, an unreadable file and the like.
#define HOST_SYSTEM_EXIT_USAGE 2

// Writes "stepmite: " and the message as one line to stderr, saves what is to be saved and leaves
// with HOST_SYSTEM_EXIT_USAGE.
_Noreturn void host_system_fail(const char *format, ...) __attribute__((format(printf, 1, 2)));

#endif

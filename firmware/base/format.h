// Text from a format, as the C library's snprintf() makes it, without its heap and its kilobytes of
// stack. Context: any that may use some 600 bytes of stack, but doubles only in the main loop.
#ifndef BASE_FORMAT_H
#define BASE_FORMAT_H

#include <stdarg.h>
#include <stddef.h>

// Known are d i u x X c s f e g and %, the flags - 0 + and blank, width and precision (a number or
// *), and the lengths hh h l ll z. Anything else is written as it stands. Doubles are rounded as
// num_text.h does it: half away from zero, 17 digits at most.
// Returns the length the text has or would have; what does not fit `size` with its closing zero is
// cut.
size_t format_text(char *buffer, size_t size, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
size_t format_list(char *buffer, size_t size, const char *format, va_list args)
    __attribute__((format(printf, 3, 0)));

#endif

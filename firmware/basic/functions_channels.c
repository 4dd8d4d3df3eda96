// EOF(), LOC(), LOF(), INPUT$(). The number of a channel may be written with #. Context: main loop.
#include "channels.h"
#include "errors.h"
#include "functions.h"
#include "memory.h"

#define FUNCTION(name) void functions_##name(value_t *arguments, unsigned count, value_t *result)

FUNCTION(eof) {
    (void)count;
    value_set_integer(result, channels_at_end((unsigned)arguments[0].integer));
}

FUNCTION(loc) {
    (void)count;
    value_set_integer(result, channels_position((unsigned)arguments[0].integer));
}

FUNCTION(lof) {
    (void)count;
    value_set_integer(result, channels_length((unsigned)arguments[0].integer));
}

FUNCTION(input) {
    (void)count;
    int64_t size = arguments[0].integer;
    if (size < 0 || size > VALUE_STRING_MAX) {
        errors_fail(ERR_NUMBER_OUT_OF_BOUNDS);
    }
    char *text = memory_text((size_t)size);
    value_set_text(result, text, channels_read((unsigned)arguments[1].integer, text, (size_t)size));
}

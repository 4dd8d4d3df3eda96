// Words of a line of a machine file. Context: main.
#include "host_machine_words.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "hal/hal.h"
#include "host_system.h"

#define NUMBER_MAX 1000000000

static struct {
    const char *path;
    unsigned line;
} place;

void host_machine_words_file(const char *path) {
    place.path = path;
    place.line = 0;
}

void host_machine_words_next_line(void) {
    place.line++;
}

_Noreturn void host_machine_complain(const char *what, const char *word) {
    host_system_fail("%s:%u: %s '%s'", place.path, place.line, what, word);
}

const char *host_machine_value(const char *word, const char *key) {
    size_t length = strlen(key);
    return strncmp(word, key, length) == 0 && word[length] == '=' ? word + length + 1 : NULL;
}

long long host_machine_number(const char *word, const char *text, char end_char, const char **end) {
    char *behind;
    errno = 0;
    long long value = strtoll(text, &behind, 10);
    if (behind == text || *behind != end_char || errno != 0) {
        host_machine_complain("no whole number in", word);
    }
    *end = behind + 1;
    return value;
}

bool host_machine_take_number(const char *word, const char *key, int64_t *value) {
    const char *text = host_machine_value(word, key);
    if (text != NULL) {
        *value = host_machine_number(word, text, '\0', &text);
    }
    return text != NULL;
}

bool host_machine_take_unsigned(const char *word, const char *key, uint32_t *value) {
    int64_t number = 0;
    if (!host_machine_take_number(word, key, &number)) {
        return false;
    }
    if (number < 0 || number > NUMBER_MAX) {
        host_machine_complain("out of range (0 to 1000000000):", word);
    }
    *value = (uint32_t)number;
    return true;
}

bool host_machine_take_pin(const char *word, const char *key, unsigned *gpio) {
    const char *text = host_machine_value(word, key);
    if (text == NULL) {
        return false;
    }
    const char *end;
    const char *digits = strncmp(text, "GP", 2) == 0 ? text + 2 : text;
    long long number = host_machine_number(word, digits, '\0', &end);
    if (number < 0 || number >= PINS_COUNT) {
        host_machine_complain("no such pin:", word);
    }
    *gpio = (unsigned)number;
    return true;
}

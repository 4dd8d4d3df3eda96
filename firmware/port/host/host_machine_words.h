// Words of a line of a machine file, as key=value. A word that is wrong ends the program with file,
// line and reason. Context: main.
#ifndef HOST_MACHINE_WORDS_H
#define HOST_MACHINE_WORDS_H

#include <stdbool.h>
#include <stdint.h>

// What the messages name.
void host_machine_words_file(const char *path);
void host_machine_words_next_line(void);

_Noreturn void host_machine_complain(const char *what, const char *word);

// The text behind "key=", NULL if the word is something else.
const char *host_machine_value(const char *word, const char *key);

// The whole number at the start of `text`, which has to be followed by `end_char`; `end` is behind
// that.
long long host_machine_number(const char *word, const char *text, char end_char, const char **end);

// True if the word is this key; then its value is taken. A pin may have GP before its number.
bool host_machine_take_number(const char *word, const char *key, int64_t *value);
bool host_machine_take_unsigned(const char *word, const char *key, uint32_t *value);
bool host_machine_take_pin(const char *word, const char *key, unsigned *gpio);

#endif

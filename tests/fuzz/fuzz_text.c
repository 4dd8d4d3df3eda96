// Builds and spoils pieces of input.
#include "fuzz_text.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "fuzz_random.h"

static const char *const awkward_numbers[] = {
    "0",
    "-0",
    "1",
    "-1",
    "0.5",
    ".5",
    "5.",
    "+3",
    "--3",
    "+-3",
    "1.2.3",
    ".",
    "-",
    "1e5",
    "1e-5",
    "1e999",
    "1e-999",
    "1e",
    "1e+",
    "&HFF",
    "&B102",
    "&H",
    "0x10",
    "nan",
    "inf",
    "127",
    "128",
    "255",
    "256",
    "1023",
    "1024",
    "1025",
    "32767",
    "-32768",
    "65536",
    "100000",
    "100001",
    "0.0001",
    "0.01",
    "1e-30",
    "2147483647",
    "2147483648",
    "1e9",
    "1.0e10",
    "-2147483649",
    "4294967296",
    "9007199254740993",
    "9223372036854775807",
    "9223372036854775808",
    "-9223372036854775809",
    "18446744073709551616",
    "1.7976931348623157e308",
    "1.8e308",
    "4.9e-324",
    "0.30000000000000004",
    "123456789012345678901234567890",
    "00000000000000000000000000000000000001",
    "0.000000000000000000000000000000000000000000001",
};

void fuzz_text_clear(fuzz_text_t *text) {
    text->length = 0;
}

void fuzz_text_byte(fuzz_text_t *text, char byte) {
    if (text->length < FUZZ_TEXT_MAX) {
        text->bytes[text->length++] = byte;
    }
}

void fuzz_text_add(fuzz_text_t *text, const char *format, ...) {
    char piece[256];
    va_list args;
    va_start(args, format);
    vsnprintf(piece, sizeof piece, format, args);
    va_end(args);
    for (const char *p = piece; *p != '\0'; p++) {
        fuzz_text_byte(text, *p);
    }
}

static void add_digits(fuzz_text_t *text, unsigned count) {
    while (count-- > 0) {
        fuzz_text_byte(text, (char)('0' + fuzz_random_below(10)));
    }
}

void fuzz_text_number(fuzz_text_t *text) {
    switch (fuzz_random_below(8)) {
    case 0:
    case 1:
        fuzz_text_add(text, "%s", FUZZ_RANDOM_PICK(awkward_numbers));
        break;
    case 2:
        fuzz_text_add(text, "%d", fuzz_random_between(-5, 40));
        break;
    case 3:
        fuzz_text_add(text, "%d.%03d", fuzz_random_between(-200, 200), fuzz_random_between(0, 999));
        break;
    case 4:
        fuzz_text_add(text, "%g", fuzz_random_between(1, 999) * 1e-2);
        break;
    case 5: // long, with a point somewhere
        add_digits(text, fuzz_random_below(30));
        fuzz_text_add(text, ".");
        add_digits(text, fuzz_random_below(fuzz_random_percent(3) ? 400 : 30));
        break;
    case 6:
        fuzz_text_add(text, "%de%d", fuzz_random_between(-99, 99), fuzz_random_between(-20, 20));
        break;
    default:
        fuzz_text_add(text, "%d", (int)(uint32_t)fuzz_random_bits());
        break;
    }
}

void fuzz_text_noise(fuzz_text_t *text, size_t count) {
    while (count-- > 0) {
        fuzz_text_byte(text, (char)fuzz_random_below(256));
    }
}

void fuzz_text_printable(fuzz_text_t *text, size_t count) {
    while (count-- > 0) {
        fuzz_text_byte(text, (char)fuzz_random_between(' ', '~'));
    }
}

static void remove_piece(fuzz_text_t *text, size_t at, size_t count) {
    count = count < text->length - at ? count : text->length - at;
    memmove(text->bytes + at, text->bytes + at + count, text->length - at - count);
    text->length -= count;
}

static void insert_piece(fuzz_text_t *text, size_t at, const char *piece, size_t count) {
    if (count > FUZZ_TEXT_MAX - text->length) {
        return;
    }
    memmove(text->bytes + at + count, text->bytes + at, text->length - at);
    memcpy(text->bytes + at, piece, count);
    text->length += count;
}

static void mutate_once(fuzz_text_t *text) {
    static const char *const telling[] = {"\"", "(", ")", ",", ":", ";",  "'",
                                          "=",  "$", "%", "#", " ", "\t", "-"};
    fuzz_text_t piece = {.length = 0};
    size_t at = fuzz_random_below((unsigned)text->length);
    size_t count = 1 + fuzz_random_below(8);
    size_t rest = text->length - at;
    switch (fuzz_random_below(7)) {
    case 0:
        text->bytes[at] = (char)fuzz_random_below(256);
        break;
    case 1:
        text->bytes[at] ^= (char)(1 << fuzz_random_below(8));
        break;
    case 2:
        remove_piece(text, at, count);
        break;
    case 3: // doubled
        memcpy(piece.bytes, text->bytes + at, count < rest ? count : rest);
        insert_piece(text, at, piece.bytes, count < rest ? count : rest);
        break;
    case 4:
        fuzz_text_number(&piece);
        insert_piece(text, at, piece.bytes, piece.length);
        break;
    case 5:
        insert_piece(text, at, FUZZ_RANDOM_PICK(telling), 1);
        break;
    default: // cut off
        text->length = at;
        break;
    }
}

void fuzz_text_mutate(fuzz_text_t *text) {
    for (unsigned times = 1 + fuzz_random_below(4); times > 0 && text->length > 0; times--) {
        mutate_once(text);
    }
}

// Numbers as bytes in a string, and checksums of bytes. Context: main loop.
#include <math.h>
#include <string.h>

#include "choices.h"
#include "errors.h"
#include "functions.h"
#include "memory.h"

#include "variables.h"

#define FUNCTION(name) void functions_##name(value_t *arguments, unsigned count, value_t *result)

// ---- STR2BIN, BIN2STR$ --------------------------------------------------------------------------

typedef enum { FORMAT_SIGNED, FORMAT_UNSIGNED, FORMAT_FLOAT } format_kind_t;

typedef struct {
    const char *name;
    uint8_t size; // bytes
    format_kind_t kind;
} format_t;

static const format_t formats[] = {
    {"INT8", 1, FORMAT_SIGNED},     {"UINT8", 1, FORMAT_UNSIGNED},  {"INT16", 2, FORMAT_SIGNED},
    {"UINT16", 2, FORMAT_UNSIGNED}, {"INT32", 4, FORMAT_SIGNED},    {"UINT32", 4, FORMAT_UNSIGNED},
    {"INT64", 8, FORMAT_SIGNED},    {"UINT64", 8, FORMAT_UNSIGNED}, {"SINGLE", 4, FORMAT_FLOAT},
    {"DOUBLE", 8, FORMAT_FLOAT},
};

static const format_t *format_of(const value_t *name) {
    for (size_t i = 0; i < COUNT_OF_ARRAY(formats); i++) {
        if (choices_find(formats[i].name, name->text, name->length) == 0) {
            return &formats[i];
        }
    }
    errors_fail_with(ERR_ARGUMENT,
                     "type is invalid (valid is INT8, UINT8 ... UINT64, SINGLE, DOUBLE)");
}

static bool is_big(const value_t *arguments, unsigned count) {
    if (count > 2 && choices_find("BIG", arguments[2].text, arguments[2].length) != 0) {
        errors_fail(ERR_SYNTAX);
    }
    return count > 2;
}

static uint64_t join_bytes(const char *bytes, unsigned size, bool big) {
    uint64_t bits = 0;
    for (unsigned i = 0; i < size; i++) {
        bits |= (uint64_t)(uint8_t)bytes[i] << 8 * (big ? size - 1 - i : i);
    }
    return bits;
}

static void split_bytes(char *bytes, uint64_t bits, unsigned size, bool big) {
    for (unsigned i = 0; i < size; i++) {
        bytes[i] = (char)(bits >> 8 * (big ? size - 1 - i : i));
    }
}

static double float_of_bits(uint64_t bits, unsigned size) {
    if (size == sizeof(double)) {
        double number;
        memcpy(&number, &bits, sizeof number);
        return number;
    }
    uint32_t low = (uint32_t)bits;
    float number;
    memcpy(&number, &low, sizeof number);
    return (double)number;
}

// type, text$ [, BIG]
FUNCTION(str2bin) {
    const format_t *format = format_of(&arguments[0]);
    if (arguments[1].length != format->size) {
        errors_fail_with(ERR_ARGUMENT, "The text must have %u bytes", format->size);
    }
    uint64_t bits = join_bytes(arguments[1].text, format->size, is_big(arguments, count));
    if (format->kind == FORMAT_FLOAT) {
        value_set_number(result, float_of_bits(bits, format->size));
        return;
    }
    unsigned unused = 64 - 8u * format->size;
    int64_t integer = (int64_t)(bits << unused);
    value_set_integer(result, format->kind == FORMAT_SIGNED ? integer >> unused : (int64_t)bits);
}

// Error if the number does not fit into so many bytes. All 64 bits may be either.
static void check_range(int64_t value, const format_t *format) {
    if (format->size == sizeof value) {
        return;
    }
    int64_t values = (int64_t)1 << 8 * format->size;
    int64_t least = format->kind == FORMAT_SIGNED ? -values / 2 : 0;
    if (value < least || value >= least + values) {
        errors_fail_with(ERR_ARGUMENT, "%lld is invalid (valid is %lld to %lld)", (long long)value,
                         (long long)least, (long long)(least + values - 1));
    }
}

static uint64_t bits_of_float(double number, unsigned size) {
    uint64_t bits = 0;
    if (size == sizeof number) {
        memcpy(&bits, &number, sizeof number);
        return bits;
    }
    float single = (float)number;
    if (!isfinite(single)) {
        errors_fail(ERR_OVERFLOW);
    }
    uint32_t low;
    memcpy(&low, &single, sizeof low);
    return low;
}

// type, value [, BIG]
FUNCTION(bin2str) {
    const format_t *format = format_of(&arguments[0]);
    uint64_t bits;
    if (format->kind == FORMAT_FLOAT) {
        bits = bits_of_float(value_to_number(&arguments[1]), format->size);
    } else {
        int64_t value = value_to_integer(&arguments[1]);
        check_range(value, format);
        bits = (uint64_t)value;
    }
    char *bytes = memory_text(format->size);
    split_bytes(bytes, bits, format->size, is_big(arguments, count));
    value_set_text(result, bytes, format->size);
}

// ---- BYTE, BIT ----------------------------------------------------------------------------------

static unsigned in_range(const value_t *argument, int64_t least, int64_t most) {
    if (argument->integer < least || argument->integer > most) {
        errors_fail_with(ERR_ARGUMENT, "%lld is invalid (valid is %d to %d)",
                         (long long)argument->integer, (int)least, (int)most);
    }
    return (unsigned)argument->integer;
}

FUNCTION(byte) {
    (void)count;
    unsigned place = in_range(&arguments[1], 1, arguments[0].length);
    value_set_integer(result, (uint8_t)arguments[0].text[place - 1]);
}

FUNCTION(bit) {
    (void)count;
    unsigned place = in_range(&arguments[1], 0, 63);
    value_set_integer(result, (int64_t)((uint64_t)arguments[0].integer >> place & 1));
}

// ---- Checksums ----------------------------------------------------------------------------------

typedef struct {
    unsigned width; // bits
    uint32_t polynomial, start, end;
    bool reverse_in, reverse_out;
} crc_t;

static uint32_t reversed(uint32_t bits, unsigned width) {
    uint32_t result = 0;
    for (unsigned i = 0; i < width; i++) {
        result |= (bits >> i & 1) << (width - 1 - i);
    }
    return result;
}

static uint32_t take_byte(const crc_t *how, uint32_t crc, uint8_t byte) {
    uint32_t top = 1u << (how->width - 1);
    uint32_t in = how->reverse_in ? reversed(byte, 8) : byte;
    crc ^= in << (how->width - 8);
    for (int bit = 0; bit < 8; bit++) {
        crc = crc & top ? crc << 1 ^ how->polynomial : crc << 1;
    }
    return crc;
}

// The bytes of a string, or of the elements of an array.
static uint8_t byte_of(const value_t *data, uint32_t index) {
    if (data->type == VALUE_STRING) {
        return (uint8_t)data->text[index];
    }
    value_t element;
    variables_nth(data->data, index, &element);
    value_fetch(&element);
    int64_t byte = value_to_integer(&element);
    if (byte < 0 || byte > UINT8_MAX) {
        errors_fail(ERR_NUMBER_OUT_OF_BOUNDS);
    }
    return (uint8_t)byte;
}

static int64_t argument_or(const value_t *arguments, unsigned count, unsigned index,
                           int64_t otherwise) {
    bool given = index < count && arguments[index].type != VALUE_NONE;
    return given ? arguments[index].integer : otherwise;
}

// data [, length] [, polynomial] [, start] [, end] [, reverse_in] [, reverse_out]
static void checksum(value_t *arguments, unsigned count, value_t *result, unsigned width,
                     uint32_t polynomial) {
    uint32_t mask = width == 32 ? UINT32_MAX : (1u << width) - 1;
    if (arguments[0].type != VALUE_ARRAY) {
        value_fetch(&arguments[0]);
    }
    if (value_is_numeric(&arguments[0])) {
        errors_fail(ERR_EXPECTED_STRING);
    }
    bool is_text = arguments[0].type == VALUE_STRING;
    uint32_t size =
        is_text ? arguments[0].length : ((const variables_array_t *)arguments[0].data)->count;
    int64_t length = argument_or(arguments, count, 1, size);
    if (length < 0 || length > size) {
        errors_fail(ERR_NUMBER_OUT_OF_BOUNDS);
    }
    const crc_t how = {
        .width = width,
        .polynomial = (uint32_t)argument_or(arguments, count, 2, polynomial) & mask,
        .start = (uint32_t)argument_or(arguments, count, 3, 0) & mask,
        .end = (uint32_t)argument_or(arguments, count, 4, 0) & mask,
        .reverse_in = argument_or(arguments, count, 5, 0) != 0,
        .reverse_out = argument_or(arguments, count, 6, 0) != 0,
    };
    uint32_t crc = how.start;
    for (uint32_t i = 0; i < length; i++) {
        crc = take_byte(&how, crc, byte_of(&arguments[0], i));
    }
    crc &= mask;
    value_set_integer(result, (how.reverse_out ? reversed(crc, width) : crc) ^ how.end);
}

FUNCTION(math_crc8) {
    checksum(arguments, count, result, 8, 0x07);
}

FUNCTION(math_crc16) {
    checksum(arguments, count, result, 16, 0x1021);
}

FUNCTION(math_crc32) {
    checksum(arguments, count, result, 32, 0x04C11DB7);
}

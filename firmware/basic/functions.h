// The built-in functions: one row each. Context: main loop.
#ifndef BASIC_FUNCTIONS_H
#define BASIC_FUNCTIONS_H

#include <stddef.h>
#include <stdint.h>

#include "value.h"

// Arguments arrive converted as `types` says; `result` arrives as integer 0.
typedef void (*functions_evaluate_t)(value_t *arguments, unsigned count, value_t *result);

typedef struct {
    const char *name;
    // A letter for each argument, the last one standing for all further ones: i integer, f float,
    // n either number, s string, v any value, a a whole array, c number of a channel, d a value or
    // a whole array, I integer or left blank (VALUE_NONE), r a variable to write to, w a word or
    // string, k a word without a comma behind it,
    // t the word NOW (VALUE_NONE) or any value, p a pin.
    // `(`: a family of functions whose keyword stands in the parentheses, rows "NAME(KEYWORD".
    const char *types;
    uint8_t least; // arguments
    uint8_t most;
    functions_evaluate_t evaluate; // NULL: expressions.c compiles it in a way of its own
    const char *help;              // usage
} functions_row_t;

extern const functions_row_t functions_table[];
extern const size_t functions_count;

// Computes row `row` of `count` values and leaves the result in values[0].
void functions_evaluate(unsigned row, value_t *values, unsigned count);

// Starts the sequence of RND at `seed`, and the clock of TIMER at `now_ms`.
void functions_seed(uint64_t seed);
void functions_set_timer(double now_ms);

// The rows' functions (functions_channels.c, functions_math.c, functions_string.c,
// functions_system.c).
#define FUNCTIONS_DECLARE(name)                                                                    \
    void functions_##name(value_t *arguments, unsigned count, value_t *result);
FUNCTIONS_DECLARE(abs)
FUNCTIONS_DECLARE(acos)
FUNCTIONS_DECLARE(asin)
FUNCTIONS_DECLARE(atn)
FUNCTIONS_DECLARE(atan2)
FUNCTIONS_DECLARE(cint)
FUNCTIONS_DECLARE(cos)
FUNCTIONS_DECLARE(deg)
FUNCTIONS_DECLARE(exp)
FUNCTIONS_DECLARE(fix)
FUNCTIONS_DECLARE(int)
FUNCTIONS_DECLARE(log)
FUNCTIONS_DECLARE(max)
FUNCTIONS_DECLARE(min)
FUNCTIONS_DECLARE(pi)
FUNCTIONS_DECLARE(rad)
FUNCTIONS_DECLARE(rnd)
FUNCTIONS_DECLARE(sgn)
FUNCTIONS_DECLARE(sin)
FUNCTIONS_DECLARE(sqr)
FUNCTIONS_DECLARE(tan)
FUNCTIONS_DECLARE(asc)
FUNCTIONS_DECLARE(bin)
FUNCTIONS_DECLARE(chr)
FUNCTIONS_DECLARE(field)
FUNCTIONS_DECLARE(format)
FUNCTIONS_DECLARE(hex)
FUNCTIONS_DECLARE(instr)
FUNCTIONS_DECLARE(lcase)
FUNCTIONS_DECLARE(left)
FUNCTIONS_DECLARE(len)
FUNCTIONS_DECLARE(mid)
FUNCTIONS_DECLARE(oct)
FUNCTIONS_DECLARE(right)
FUNCTIONS_DECLARE(space)
FUNCTIONS_DECLARE(str)
FUNCTIONS_DECLARE(string)
FUNCTIONS_DECLARE(trim)
FUNCTIONS_DECLARE(ucase)
FUNCTIONS_DECLARE(val)
FUNCTIONS_DECLARE(bound)
FUNCTIONS_DECLARE(choice)
FUNCTIONS_DECLARE(cwd)
FUNCTIONS_DECLARE(dir)
FUNCTIONS_DECLARE(eof)
FUNCTIONS_DECLARE(input)
FUNCTIONS_DECLARE(loc)
FUNCTIONS_DECLARE(lof)
FUNCTIONS_DECLARE(inkey)
FUNCTIONS_DECLARE(timer)
FUNCTIONS_DECLARE(mm_device)
FUNCTIONS_DECLARE(mm_errmsg)
FUNCTIONS_DECLARE(mm_cmdline)
FUNCTIONS_DECLARE(mm_errno)
FUNCTIONS_DECLARE(math_sum)
FUNCTIONS_DECLARE(math_mean)
FUNCTIONS_DECLARE(math_sd)
FUNCTIONS_DECLARE(math_max)
FUNCTIONS_DECLARE(math_min)
FUNCTIONS_DECLARE(math_median)
FUNCTIONS_DECLARE(math_atan3)
FUNCTIONS_DECLARE(math_cosh)
FUNCTIONS_DECLARE(math_sinh)
FUNCTIONS_DECLARE(math_tanh)
FUNCTIONS_DECLARE(math_log10)
FUNCTIONS_DECLARE(math_power)
FUNCTIONS_DECLARE(math_crc8)
FUNCTIONS_DECLARE(math_crc16)
FUNCTIONS_DECLARE(math_crc32)
FUNCTIONS_DECLARE(bit)
FUNCTIONS_DECLARE(byte)
FUNCTIONS_DECLARE(pos)
FUNCTIONS_DECLARE(str2bin)
FUNCTIONS_DECLARE(bin2str)
FUNCTIONS_DECLARE(mm_ver)
FUNCTIONS_DECLARE(mm_watchdog)
FUNCTIONS_DECLARE(info_boot)
FUNCTIONS_DECLARE(info_cpuspeed)
FUNCTIONS_DECLARE(info_disk)
FUNCTIONS_DECLARE(info_exists)
FUNCTIONS_DECLARE(info_filesize)
FUNCTIONS_DECLARE(info_free)
FUNCTIONS_DECLARE(info_heap)
FUNCTIONS_DECLARE(info_line)
FUNCTIONS_DECLARE(info_pin)
FUNCTIONS_DECLARE(info_pinno)
FUNCTIONS_DECLARE(info_program)
FUNCTIONS_DECLARE(info_uptime)
FUNCTIONS_DECLARE(date)
FUNCTIONS_DECLARE(datetime)
FUNCTIONS_DECLARE(day)
FUNCTIONS_DECLARE(epoch)
FUNCTIONS_DECLARE(time)
#undef FUNCTIONS_DECLARE

#endif

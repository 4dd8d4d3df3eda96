// The table of built-in functions. To add one: a row here, its declaration in functions.h, its body
// in the file of its subject. Context: main loop.
#include "functions.h"

#include <string.h>

#include "base/base.h"
#include "channels.h"
#include "errors.h"
#include "words.h"

const functions_row_t functions_table[] = {
    {"ABS", "n", 1, 1, functions_abs, "ABS(number): without its sign"},
    {"ACOS", "f", 1, 1, functions_acos, "ACOS(number): angle in radians"},
    {"ASC", "s", 1, 1, functions_asc,
     "ASC(text$): code of the first character, 0 for an empty text"},
    {"ASIN", "f", 1, 1, functions_asin, "ASIN(number): angle in radians"},
    {"ATAN2", "f", 2, 2, functions_atan2, "ATAN2(y, x): angle in radians"},
    {"ATN", "f", 1, 1, functions_atn, "ATN(number): angle in radians"},
    {"BIN2STR$", "wvw", 2, 3, functions_bin2str,
     "BIN2STR$(INT8|UINT8 ... UINT64|SINGLE|DOUBLE, number [, BIG]): its bytes, the lowest first"},
    {"BIN$", "i", 1, 2, functions_bin, "BIN$(number [, digits]): as binary digits"},
    {"BIT", "ii", 2, 2, functions_bit,
     "BIT(number, n): bit n, from 0; BIT(name%, n) = 0|1 sets it"},
    {"BOUND", "ai", 1, 2, functions_bound,
     "BOUND(array() [, dimension]): highest subscript; 0: OPTION BASE"},
    {"BYTE", "si", 2, 2, functions_byte,
     "BYTE(text$, n): code of character n; BYTE(name$, n) = code sets it"},
    {"CALL", "v", 1, 17, NULL, "CALL(name$ [, argument ...]): value of the FUNCTION of that name"},
    {"CHOICE", "fvv", 3, 3, functions_choice,
     "CHOICE(condition, if_true, if_false): one of two values"},
    {"CHR$", "i", 1, 1, functions_chr, "CHR$(code): the character of a code"},
    {"CINT", "n", 1, 1, functions_cint, "CINT(number): nearest integer, halves away from zero"},
    {"COS", "f", 1, 1, functions_cos, "COS(radians): cosine"},
    {"CWD$", "", 0, 0, functions_cwd, "CWD$: the current folder"},
    {"DATE$", "", 0, 0, functions_date, "DATE$: today; DATE$ = \"DD-MM-YYYY\" sets it"},
    {"DATETIME$", "t", 0, 1, functions_datetime, "DATETIME$(NOW|seconds): a date with its time"},
    {"DAY$", "t", 0, 1, functions_day, "DAY$(NOW|date$): day of the week"},
    {"DEG", "f", 1, 1, functions_deg, "DEG(radians): degrees"},
    {"DIR$", "sw", 0, 2, functions_dir,
     "DIR$(pattern$ [, ALL|DIR|FILE]): the first file; DIR$(): the next"},
    {"EOF", "c", 1, 1, functions_eof, "EOF([#]n): 1 if there is nothing left to read"},
    {"EVAL", "s", 1, 1, NULL, "EVAL(text$): value of the expression that the text holds"},
    {"EPOCH", "t", 0, 1, functions_epoch, "EPOCH(NOW|date$ and time): seconds since 1970"},
    {"EXP", "f", 1, 1, functions_exp, "EXP(number): e to the power of it"},
    {"FIELD$", "siss", 2, 4, functions_field,
     "FIELD$(text$, number [, separators$ [, quotes$]]): a part of a text, from 1"},
    {"FIX", "n", 1, 1, functions_fix, "FIX(number): without its decimals"},
    {"FORMAT$", "fs", 1, 2, functions_format,
     "FORMAT$(number [, \"%8.3f\"]): a number in the form of printf: %f, %e or %g"},
    {"HEX$", "i", 1, 2, functions_hex, "HEX$(number [, digits]): as hexadecimal digits"},
    {"INKEY$", "", 0, 0, functions_inkey, "INKEY$: the next typed character or an empty text"},
    {"INPUT$", "ic", 2, 2, functions_input, "INPUT$(count, [#]n): characters from a channel"},
    {"INSTR", "vvs", 2, 3, functions_instr, "INSTR([start,] text$, pattern$): position or 0"},
    {"INT", "n", 1, 1, functions_int, "INT(number): next integer below"},
    {"LCASE$", "s", 1, 1, functions_lcase, "LCASE$(text$): in small letters"},
    {"LEFT$", "si", 2, 2, functions_left, "LEFT$(text$, count): the first characters"},
    {"LEN", "s", 1, 1, functions_len, "LEN(text$): number of characters"},
    {"LOC", "c", 1, 1, functions_loc, "LOC([#]n): position in a file, from 1"},
    {"LOF", "c", 1, 1, functions_lof, "LOF([#]n): size of a file"},
    {"LOG", "f", 1, 1, functions_log, "LOG(number): natural logarithm"},
    {"MATH", "(", 1, 1, NULL,
     "MATH(SUM|MEAN|SD|MEDIAN array()) / MATH(MAX|MIN array() [, subscript]) / "
     "MATH(LOG10|SINH|COSH|TANH number) / MATH(ATAN3 x, y) / MATH(POWER number, exponent) / "
     "MATH(CRC8|CRC16|CRC32 text$|array() [, length] [, polynomial] [, start] [, end] "
     "[, reverse_in] [, reverse_out]): statistics of an array, functions, checksums"},
    {"MATH(ATAN3", "f", 2, 2, functions_math_atan3, NULL},
    {"MATH(COSH", "f", 1, 1, functions_math_cosh, NULL},
    {"MATH(CRC16", "dI", 1, 7, functions_math_crc16, NULL},
    {"MATH(CRC32", "dI", 1, 7, functions_math_crc32, NULL},
    {"MATH(CRC8", "dI", 1, 7, functions_math_crc8, NULL},
    {"MATH(LOG10", "f", 1, 1, functions_math_log10, NULL},
    {"MATH(MAX", "ar", 1, 2, functions_math_max, NULL},
    {"MATH(MEAN", "a", 1, 1, functions_math_mean, NULL},
    {"MATH(MEDIAN", "a", 1, 1, functions_math_median, NULL},
    {"MATH(MIN", "ar", 1, 2, functions_math_min, NULL},
    {"MATH(POWER", "f", 2, 2, functions_math_power, NULL},
    {"MATH(SD", "a", 1, 1, functions_math_sd, NULL},
    {"MATH(SINH", "f", 1, 1, functions_math_sinh, NULL},
    {"MATH(SUM", "a", 1, 1, functions_math_sum, NULL},
    {"MATH(TANH", "f", 1, 1, functions_math_tanh, NULL},
    {"MAX", "f", 1, 10, functions_max, "MAX(number, number ...): the greatest"},
    {"MID$", "si", 2, 3, functions_mid, "MID$(text$, start [, count]): characters from a place on"},
    {"MIN", "f", 1, 10, functions_min, "MIN(number, number ...): the least"},
    {"MM.CMDLINE$", "", 0, 0, functions_mm_cmdline,
     "MM.CMDLINE$: what RUN was given for the program"},
    {"MM.DEVICE$", "", 0, 0, functions_mm_device, "MM.DEVICE$: name of the board"},
    {"MM.ERRMSG$", "", 0, 0, functions_mm_errmsg, "MM.ERRMSG$: text of the last error"},
    {"MM.ERRNO", "", 0, 0, functions_mm_errno, "MM.ERRNO: 0 if there was no error"},
    {"MM.INFO", "(", 1, 1, NULL,
     "MM.INFO(BOOT|CPUSPEED|DEVICE|DISK SIZE|ERRMSG|ERRNO|EXISTS FILE name$|EXISTS DIR name$|"
     "FILESIZE name$|FREE SPACE|HEAP|LINE|PIN pin|PINNO pin|"
     "PROGRAM|UPTIME|VERSION): what there is to know of the board and the program"},
    {"MM.INFO$", "(", 1, 1, NULL, NULL},
    {"MM.INFO(BOOT", "", 0, 0, functions_info_boot, NULL},
    {"MM.INFO(CPUSPEED", "", 0, 0, functions_info_cpuspeed, NULL},
    {"MM.INFO(DEVICE", "", 0, 0, functions_mm_device, NULL},
    {"MM.INFO(DISK", "w", 1, 1, functions_info_disk, NULL},
    {"MM.INFO(ERRMSG", "", 0, 0, functions_mm_errmsg, NULL},
    {"MM.INFO(ERRNO", "", 0, 0, functions_mm_errno, NULL},
    {"MM.INFO(EXISTS", "ks", 2, 2, functions_info_exists, NULL},
    {"MM.INFO(FILESIZE", "s", 1, 1, functions_info_filesize, NULL},
    {"MM.INFO(FREE", "w", 1, 1, functions_info_free, NULL},
    {"MM.INFO(HEAP", "", 0, 0, functions_info_heap, NULL},
    {"MM.INFO(LINE", "", 0, 0, functions_info_line, NULL},
    {"MM.INFO(PIN", "p", 1, 1, functions_info_pin, NULL},
    {"MM.INFO(PINNO", "p", 1, 1, functions_info_pinno, NULL},
    {"MM.INFO(PROGRAM", "", 0, 0, functions_info_program, NULL},
    {"MM.INFO(UPTIME", "", 0, 0, functions_info_uptime, NULL},
    {"MM.INFO(VERSION", "", 0, 0, functions_mm_ver, NULL},
    {"MM.VER", "", 0, 0, functions_mm_ver, "MM.VER: version of the firmware as a number"},
    {"MM.WATCHDOG", "", 0, 0, functions_mm_watchdog,
     "MM.WATCHDOG: 1 if WATCHDOG restarted the board"},
    {"OCT$", "i", 1, 2, functions_oct, "OCT$(number [, digits]): as octal digits"},
    {"PI", "", 0, 0, functions_pi, "PI: 3.14159265358979"},
    {"POS", "", 0, 0, functions_pos, "POS: column of the cursor, from 1"},
    {"RAD", "f", 1, 1, functions_rad, "RAD(degrees): radians"},
    {"RIGHT$", "si", 2, 2, functions_right, "RIGHT$(text$, count): the last characters"},
    {"RND", "f", 0, 1, functions_rnd, "RND: a random number from 0 to below 1"},
    {"SGN", "f", 1, 1, functions_sgn, "SGN(number): -1, 0 or 1"},
    {"SIN", "f", 1, 1, functions_sin, "SIN(radians): sine"},
    {"SPACE$", "i", 1, 1, functions_space, "SPACE$(count): that many blanks"},
    {"SPC", "i", 1, 1, functions_space, "SPC(count): blanks"},
    {"SQR", "f", 1, 1, functions_sqr, "SQR(number): square root"},
    {"STR2BIN", "wsw", 2, 3, functions_str2bin,
     "STR2BIN(INT8|UINT8 ... UINT64|SINGLE|DOUBLE, text$ [, BIG]): the number these bytes are"},
    {"STR$", "niis", 1, 4, functions_str,
     "STR$(number [, width [, decimals [, filler$]]]): a number as text"},
    {"STRING$", "iv", 2, 2, functions_string,
     "STRING$(count, code or text$): the same over and over"},
    {"TAN", "f", 1, 1, functions_tan, "TAN(radians): tangent"},
    {"TIME$", "", 0, 0, functions_time, "TIME$: time of day; TIME$ = \"HH:MM:SS\" sets it"},
    {"TIMER", "", 0, 0, functions_timer, "TIMER: milliseconds; TIMER = 0 sets it"},
    {"TRIM$", "s", 1, 3, functions_trim,
     "TRIM$(text$ [, characters$ [, \"L\", \"R\" or \"B\"]]): without blanks, or these characters, "
     "at the left, right or both ends"},
    {"UCASE$", "s", 1, 1, functions_ucase, "UCASE$(text$): in capitals"},
    {"VAL", "s", 1, 1, functions_val, "VAL(text$): the number it starts with"},
};

_Static_assert(COUNT_OF_ARRAY(functions_table) <= WORDS_ROWS_MAX, "no word for the last rows");

const size_t functions_count = COUNT_OF_ARRAY(functions_table);

static void convert(value_t *argument, char type) {
    switch (type) {
    case 'i':
        value_set_integer(argument, value_to_integer(argument));
        break;
    case 'f':
        value_set_number(argument, value_to_number(argument));
        break;
    case 'n':
        if (!value_is_numeric(argument)) {
            errors_fail(ERR_EXPECTED_NUMBER);
        }
        break;
    case 'I':
        if (argument->type != VALUE_NONE) {
            value_set_integer(argument, value_to_integer(argument));
        }
        break;
    case 'c':
        value_set_integer(argument, channels_number(argument));
        break;
    case 'k':
    case 'w':
    case 's':
        if (argument->type != VALUE_STRING) {
            errors_fail(ERR_EXPECTED_STRING);
        }
        break;
    default:
        break;
    }
}

void functions_evaluate(unsigned row, value_t *values, unsigned count) {
    const functions_row_t *function = &functions_table[row];
    const char *type = function->types;
    for (unsigned i = 0; i < count; i++) {
        convert(&values[i], *type);
        type += type[1] != '\0';
    }
    value_t result = {.integer = 0, .type = VALUE_INTEGER};
    function->evaluate(values, count, &result);
    values[0] = result;
}

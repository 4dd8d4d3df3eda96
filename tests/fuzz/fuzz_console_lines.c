// Generates what is typed at the prompt. Placeholders in the templates: % number, $ string
// expression, # expression, & variable, @ comparison, ~ a whole G-code line.
#include "fuzz_console_lines.h"

#include <stdio.h>
#include <string.h>

#include "basic_cmds/basic_cmds.h"
#include "fuzz_corpus.h"
#include "fuzz_gcode_lines.h"
#include "fuzz_random.h"
#include "tmc22xx/tmc22xx_registers.h"

#define EXPRESSION_DEPTH 4

static const char *const setup_lines[] = {
    "stepper init 0.05,32",
    "STEPPER AXIS X,GP2,GP3,GP4,,80,6000,500",
    "STEPPER AXIS Y,GP5,GP6,,1,80,6000,500",
    "STEPPER AXIS Z,8,9,10,0,400,1200,200",
    "STEPPER AXIS A,GP11,GP12,,,8.888889,36000,2000",
    "STEPPER SPINDLE GP20",
    "STEPPER POSITION HOME",
    "STEPPER RUN",
    "STEPPER GC G90 G1 F3000 X5",
    "TMC22xx GP21,2209,0,800,30,16",
    "TMC22xx AXIS 0,X",
    "TMC22xx WIRE GP22,GP19",
    "TMC22xx GP22,2208,0,600,50,32",
};

static const char *const statements[] = {
    "PRINT #",
    "? #, $; @",
    "? $ ;",
    "&=#",
    "&%=#",
    "&$=$",
    "DIM &(%)",
    "DIM INTEGER &(%,%)=(1,2,3)",
    "DIM &$(%) LENGTH %",
    "&(%)=#",
    "? &(%,%)",
    "CONST &=#",
    "INC &,#",
    "IF @ THEN ? # ELSE ? $",
    "IF @ THEN GOTO %",
    "FOR &=% TO % STEP %:? &;:NEXT",
    "FOR i=1 TO 3:? i:NEXT i",
    "DO:&=&+1:IF &>5 THEN EXIT DO",
    "DO WHILE @:LOOP",
    "DO:LOOP UNTIL @",
    "SELECT CASE #:CASE %:? 1:CASE ELSE:? 2:END SELECT",
    "GOSUB %",
    "RETURN",
    "NEXT",
    "LOOP",
    "ENDIF",
    "END SUB",
    "SUB &(a,b$)",
    "FUNCTION &(x)",
    "LOCAL &",
    "READ &,&$",
    "DATA %,$",
    "RESTORE %",
    "ERASE &",
    "ERASE &(),&$",
    "DIM &%(%)",
    "REDIM &(%)",
    "REDIM PRESERVE &(%,%)",
    "REDIM PRESERVE &$(%) LENGTH %",
    "FOR i=1 TO 9:REDIM PRESERVE &(i):ERASE &:DIM &(5):NEXT",
    "SORT &()",
    "SORT &(),i%()",
    "SORT &$(),,%,%,%",
    "MATH SET #,&()",
    "MATH SCALE &(),#,&()",
    "MATH ADD &(),#,&()",
    "MATH INTERPOLATE &(),&(),#,&()",
    "? MATH(SUM &());MATH(MEDIAN &());MATH(SD &())",
    "? MATH(MAX &(),&)",
    "? MATH(CRC16 $);MATH(CRC32 &(),%,%)",
    "? BIN2STR$(INT16,#);STR2BIN(UINT32,$)",
    "EXECUTE $",
    "EXECUTE \"&=#:? &\"",
    "EXECUTE \"FOR i=1 TO 3:EXECUTE &$:NEXT\"",
    "&$=\"GOSUB %:ERASE &:DIM &(%)\":EXECUTE &$",
    "? EVAL($)",
    "? EVAL(\"#\")+EVAL(&$)",
    "CALL $,#",
    "? CALL($,&,&())",
    "CAT &$,$",
    "MID$(&$,%,%)=$",
    "BYTE(&$,%)=%:BIT(&%,%)=%",
    "CLEAR",
    "READ &()",
    "READ SAVE",
    "READ RESTORE",
    "STATIC &=#,&(%)",
    "OPTION ESCAPE",
    "OPTION ESCAPE OFF",
    "OPTION ANGLE DEGREES",
    "OPTION CONTINUATION LINES ON",
    "&=# + _",
    "PAUSE %",
    "PAUSE 1",
    "STEPPER JOG X,+,#:PAUSE 100:STEPPER JOG X,-",
    "STEPPER HOLD:PAUSE 20:STEPPER RESUME",
    "TIMER=%",
    "RANDOMIZE %",
    "OPTION BASE %",
    "OPTION EXPLICIT",
    "OPTION DEFAULT INTEGER",
    "ON ERROR SKIP %",
    "ON ERROR IGNORE",
    "ON ERROR CLEAR",
    "ON ERROR ABORT",
    "ERROR $",
    "? MM.ERRNO,MM.ERRMSG$",
    "INPUT &",
    "LINE INPUT &$",
    "LIST",
    "RUN",
    "NEW",
    "CLEAR",
    "END",
    "MEMORY",
    "HELP",
    "HELP STEPPER AXIS",
    "HELP $",
    "REM $",
    "' $",
    "STEPPER",
    "STEPPER $",
    "STEPPER GC ~",
    "STEPPER GC ~:STEPPER GC ~",
    "STEPPER GS \"~\"",
    "STEPPER GS $",
    "DO:PAUSE 10:LOOP UNTIL PEEK(STEPPER ACTIVE)=0",
    "FOR i=1 TO 20:STEPPER GCODE G1,X,i/10,F,#:NEXT",
    "? PEEK(STEPPER %)",
    "? PEEK(%)",
    "TMC22xx GP21,2209,1,#,%,16:TMC22xx CURRENT X,700+RND*300",
    "TMC22xx 21,2209,0,800,30,16:TMC22xx AXIS 0,X,GP21:TMC22xx STALL X,600,1",
    "FOR i=1 TO 9:TMC22xx SGTHRS X,i:? PEEK(TMC X,SG);PEEK(TMC X,CS);:NEXT",
    "&=PEEK(TMC X,TEMP)+PEEK(TMC 0,&H6F,GP21)+#",
    "TMC22xx STATUS:PAUSE 1500",
    "TMC22xx SGTUNE X,600,%/10",
    "TMC22xx SGTUNE X,#,2:STEPPER HOME RUN X",
    "STEPPER HWLIMITS GP16,0,0,0,0,0,1:TMC22xx SGTHRS X,100:STEPPER GC G28 X0",
    "TMC22xx READ X,$",
    "TMC22xx WRITE X,%,#",
    "TMC22xx VERIFY 0:TMC22xx CURRENT X,500:TMC22xx VERIFY 1",
    "TMC22xx CLOSE:TMC22xx GP21,2209,0,900,30,16",
    "? PEEK(STEPPER BUFFER),PEEK(STEPPER ACTIVE),PEEK(STEPPER X)",
    "#",
    "$",
    "&",
    "%",
};

static const char *const number_functions[] = {
    "ABS",  "INT",  "FIX", "CINT", "SGN",   "SQR", "SIN",   "COS",   "TAN",          "ATN",
    "ASIN", "ACOS", "LOG", "EXP",  "RAD",   "DEG", "ATAN2", "MIN",   "MAX",          "RND",
    "PI",   "LEN",  "ASC", "VAL",  "INSTR", "POS", "TIMER", "BOUND", "PEEK(STEPPER", "NOSUCH",
};

static const char *const text_functions[] = {
    "CHR$",   "STR$",    "HEX$",   "BIN$",   "OCT$",    "LEFT$",  "RIGHT$", "MID$",
    "SPACE$", "STRING$", "UCASE$", "LCASE$", "FORMAT$", "FIELD$", "TRIM$",  "INKEY$",
};

static const char *const operators[] = {"+",  "-",  "*",     "/",    "\\",    " MOD ", "^",
                                        "<<", ">>", " AND ", " OR ", " XOR ", "=",     "<>"};

static const char *const variables[] = {"a", "b", "c", "i", "x", "longname_1", "a.b", "q9"};

static void add_text_expression(fuzz_text_t *text, unsigned depth);

static void add_expression(fuzz_text_t *text, unsigned depth) {
    unsigned kind = depth == 0 ? fuzz_random_below(2) : fuzz_random_below(8);
    switch (kind) {
    case 0:
        fuzz_text_number(text);
        break;
    case 1:
        fuzz_text_add(text, "%s%s", FUZZ_RANDOM_PICK(variables),
                      fuzz_random_percent(30) ? "%" : "");
        break;
    case 2:
        fuzz_text_add(text, "%s", fuzz_random_percent(50) ? "(" : "-(");
        add_expression(text, depth - 1);
        fuzz_text_add(text, ")");
        break;
    case 3:
        fuzz_text_add(text, "%s(", FUZZ_RANDOM_PICK(number_functions));
        if (fuzz_random_percent(40)) {
            add_text_expression(text, depth - 1);
        } else {
            add_expression(text, depth - 1);
        }
        if (fuzz_random_percent(30)) {
            fuzz_text_add(text, ",");
            add_expression(text, depth - 1);
        }
        fuzz_text_add(text, ")");
        break;
    case 4:
        fuzz_text_add(text, "NOT ");
        add_expression(text, depth - 1);
        break;
    default:
        add_expression(text, depth - 1);
        fuzz_text_add(text, "%s", FUZZ_RANDOM_PICK(operators));
        add_expression(text, depth - 1);
        break;
    }
}

static void add_text_expression(fuzz_text_t *text, unsigned depth) {
    switch (depth == 0 ? 0 : fuzz_random_below(5)) {
    case 0:
    case 1:
        fuzz_text_add(text, "\"");
        fuzz_text_printable(text, fuzz_random_below(fuzz_random_percent(5) ? 300 : 12));
        fuzz_text_add(text, "\"");
        break;
    case 2:
        fuzz_text_add(text, "%s$", FUZZ_RANDOM_PICK(variables));
        break;
    case 3:
        add_text_expression(text, depth - 1);
        fuzz_text_add(text, "+");
        add_text_expression(text, depth - 1);
        break;
    default:
        fuzz_text_add(text, "%s(", FUZZ_RANDOM_PICK(text_functions));
        if (fuzz_random_percent(50)) {
            add_text_expression(text, depth - 1);
        } else {
            add_expression(text, depth - 1);
        }
        for (unsigned more = fuzz_random_below(3); more > 0; more--) {
            fuzz_text_add(text, ",");
            add_expression(text, depth - 1);
        }
        fuzz_text_add(text, ")");
        break;
    }
}

static void add_gcode(fuzz_text_t *text) {
    if (fuzz_random_percent(60)) {
        fuzz_text_add(text, "G%d X%d.%d Y%d F%d", fuzz_random_between(0, 1),
                      fuzz_random_between(-5, 20), fuzz_random_between(0, 99),
                      fuzz_random_between(-5, 20), fuzz_random_between(100, 6000));
    } else if (fuzz_random_percent(70)) {
        fuzz_gcode_any_line(text);
    } else {
        fuzz_corpus_pick(FUZZ_CORPUS_GCODE, text);
    }
}

static void expand(fuzz_text_t *text, const char *template) {
    for (const char *p = template; *p != '\0'; p++) {
        bool suffix = p > template && (p[-1] == '&' || (p[-1] >= 'A' && p[-1] <= 'Z'));
        if (*p == '%' && !suffix) {
            fuzz_text_number(text);
        } else if (*p == '$' && !suffix) {
            add_text_expression(text, fuzz_random_below(EXPRESSION_DEPTH));
        } else if (*p == '#') {
            add_expression(text, fuzz_random_below(EXPRESSION_DEPTH));
        } else if (*p == '@') {
            add_expression(text, 1);
            fuzz_text_add(text, "%s", fuzz_random_percent(50) ? "<" : "=");
            add_expression(text, 1);
        } else if (*p == '&') {
            fuzz_text_add(text, "%s", FUZZ_RANDOM_PICK(variables));
        } else if (*p == '~') {
            add_gcode(text);
        } else {
            fuzz_text_byte(text, *p);
        }
    }
}

bool fuzz_console_setup_line(fuzz_text_t *text, unsigned index) {
    if (index >= COUNT_OF_ARRAY(setup_lines)) {
        return false;
    }
    fuzz_text_add(text, "%s\r", setup_lines[index]);
    return true;
}

// ---- Commands from their rows -------------------------------------------------------------------

static void add_choice(fuzz_text_t *text, const char *choices) {
    unsigned count = 1;
    for (const char *p = choices; *p != '\0'; p++) {
        count += *p == '|';
    }
    for (unsigned skip = fuzz_random_below(count); skip > 0; skip--) {
        choices = strchr(choices, '|') + 1;
    }
    bool lower = fuzz_random_percent(30);
    for (; *choices != '\0' && *choices != '|'; choices++) {
        fuzz_text_byte(text, lower && *choices >= 'A' ? (char)(*choices + 32) : *choices);
    }
}

static void add_in_range(fuzz_text_t *text, const basic_arg_spec_t *spec) {
    bool limited = spec->min != 0 || spec->max != 0;
    double low = limited ? spec->min : -100;
    double high = limited && spec->max < 10000 ? spec->max : 10000;
    double value = low + (high - low) * fuzz_random_below(1001) / 1000;
    if (fuzz_random_percent(20)) {
        value = fuzz_random_percent(50) ? spec->min : spec->max;
    }
    fuzz_text_add(text, spec->kind == BASIC_ARG_INTEGER ? "%.0f" : "%.10g", value);
}

// Of a motor driver.
static void add_register(fuzz_text_t *text) {
    unsigned index = fuzz_random_below((unsigned)tmc22xx_register_count);
    const tmc22xx_register_t *reg = &tmc22xx_registers[index];
    if (fuzz_random_percent(60)) {
        fuzz_text_add(text, "%s", reg->name);
    } else {
        fuzz_text_add(text, "&H%X", reg->address);
    }
}

static void add_argument(fuzz_text_t *text, const basic_arg_spec_t *spec) {
    if (fuzz_random_percent(8)) {
        add_expression(text, 2); // of the wrong kind, perhaps
        return;
    }
    switch (spec->kind) {
    case BASIC_ARG_NUMBER:
    case BASIC_ARG_INTEGER:
        if (spec->choices != NULL && fuzz_random_percent(40)) {
            add_choice(text, spec->choices);
        } else {
            add_in_range(text, spec);
        }
        break;
    case BASIC_ARG_TEXT:
        fuzz_text_add(text, "\"");
        add_gcode(text);
        fuzz_text_add(text, "\"");
        break;
    case BASIC_ARG_CHOICE:
        add_choice(text, spec->choices);
        break;
    case BASIC_ARG_WORD:
        if (spec->flags & BASIC_ARG_OR_NUMBER) {
            add_register(text);
            break;
        }
        fuzz_text_add(text, "%s",
                      FUZZ_RANDOM_PICK(((const char *const[]){"G0", "G1", "X", "Y", "F", "P"})));
        break;
    case BASIC_ARG_PIN:
        if (strcmp(spec->name, "tx_pin") == 0 && fuzz_random_percent(70)) {
            fuzz_text_add(text, "GP%d", fuzz_random_between(21, 22)); // there are drivers
            break;
        }
        fuzz_text_add(text, fuzz_random_percent(60) ? "GP%d" : "%d", fuzz_random_between(0, 30));
        break;
    case BASIC_ARG_ROUTINE:
        fuzz_text_add(text, fuzz_random_percent(60) ? "handler" : "0");
        break;
    case BASIC_ARG_DATA:
        fuzz_text_add(text, "%s",
                      FUZZ_RANDOM_PICK(((const char *const[]){"1,2,3", "255", "b$", "d()"})));
        break;
    case BASIC_ARG_STORE:
        fuzz_text_add(text, "%s",
                      FUZZ_RANDOM_PICK(((const char *const[]){"b$", "b", "d()", "d(1)"})));
        break;
    case BASIC_ARG_RAW:
        add_gcode(text);
        break;
    }
}

void fuzz_console_command(fuzz_text_t *text) {
    const basic_rows_t *table =
        basic_cmds_tables[fuzz_random_below((unsigned)basic_cmds_table_count)];
    const basic_command_t *command =
        &table->commands[fuzz_random_below((unsigned)table->command_count)];
    if (fuzz_random_percent(50)) {
        fuzz_text_add(text, "STEPPER GC ");
        add_gcode(text);
        return;
    }
    fuzz_text_add(text, "%s ", command->name);
    for (size_t i = 0; i < command->arg_count; i++) {
        const basic_arg_spec_t *spec = &command->args[i];
        bool optional = (spec->flags & BASIC_ARG_OPTIONAL) != 0;
        if (optional && fuzz_random_percent(25)) {
            break;
        }
        fuzz_text_add(text, "%s", i > 0 ? "," : "");
        if (!fuzz_random_percent(optional ? 25 : 3)) {
            add_argument(text, spec);
        }
    }
    if (fuzz_random_percent(3)) {
        fuzz_text_add(text, ",1");
    }
}

// ---- BASIC --------------------------------------------------------------------------------------

void fuzz_console_basic(fuzz_text_t *text) {
    expand(text, FUZZ_RANDOM_PICK(statements));
    while (fuzz_random_percent(15)) {
        fuzz_text_add(text, ":");
        expand(text, FUZZ_RANDOM_PICK(statements));
    }
}

void fuzz_console_program(fuzz_text_t *text) {
    fuzz_text_add(text, "AUTOSAVE\r");
    for (unsigned lines = fuzz_random_below(25); lines > 0; lines--) {
        if (fuzz_random_percent(20)) {
            fuzz_text_add(text, "%d ", fuzz_random_between(0, 300));
        } else if (fuzz_random_percent(10)) {
            fuzz_text_add(text, "%s: ", FUZZ_RANDOM_PICK(variables));
        }
        fuzz_console_basic(text);
        fuzz_text_add(text, "\r");
    }
    fuzz_text_add(text, "\x1aRUN\r");
}

void fuzz_console_keys(fuzz_text_t *text) {
    static const char *const keys[] = {
        "\x1b[A",  "\x1b[B",  "\x1b[C", "\x1b[D",   "\x1b[H", "\x1b[F", "\x1b[1~", "\x1b[2~",
        "\x1b[3~", "\x1b[4~", "\x1bOP", "\x1b[11~", "\x1b[",  "\x1b",   "\b",      "\x7f",
        "\t",      "\x15",    "\x03",   "\x1a",     "\r",     "\n",     "\r\n",    "\x1b[999;999R",
        "\x06",    "\x06",    "\x12"};
    for (unsigned count = fuzz_random_below(60); count > 0; count--) {
        if (fuzz_random_percent(30)) {
            fuzz_text_add(text, "%s", FUZZ_RANDOM_PICK(keys));
        } else if (fuzz_random_percent(50)) {
            fuzz_text_printable(text, 1 + fuzz_random_below(10));
        } else {
            fuzz_text_noise(text, 1 + fuzz_random_below(6));
        }
    }
    fuzz_text_add(text, "\x1b[F\x15");
}

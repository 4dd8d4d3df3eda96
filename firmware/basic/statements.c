// The table of statements. To add one: a row here, its declaration in statements.h, its compile
// function in the file of its subject and, if it does something of its own at run time, an action.
// Context: main loop, while compiling.
#include "statements.h"

#include "base/base.h"
#include "compiler.h"
#include "emit.h"
#include "errors.h"
#include "expressions.h"
#include "lexer.h"
#include "memory.h"
#include "symbols.h"
#include "words.h"

const statements_row_t statements_table[] = {
    {"AUTOSAVE", statements_autosave, "AUTOSAVE [APPEND]",
     "Takes a program pasted or typed, up to Ctrl-Z or F1, F2 to run it; Ctrl-C gives up"},
    {"CALL", statements_call, "CALL name$ [, argument ...]", "Calls the SUB of that name"},
    {"CASE", statements_case, NULL, NULL},
    {"CHDIR", statements_chdir, "CHDIR folder$", "Goes to a folder; \"..\": the one above"},
    {"CLEAR", statements_clear, "CLEAR", "Deletes all variables; not in a SUB or FUNCTION"},
    {"CLOSE", statements_close, "CLOSE [[#]n [, ...]]", "Closes channels; alone, all of them"},
    {"CAT", statements_cat, "CAT name$, text$", "Appends to a string variable"},
    {"CLS", statements_cls, "CLS", "Clears the screen of the terminal"},
    {"CONST", statements_const, "CONST name = value [, ...]", "Names a value that cannot change"},
    {"CONTINUE", statements_continue, "CONTINUE FOR|DO", "Goes on with the next turn of a loop"},
    {"COPY", statements_copy, "COPY file$ TO file$", "Copies a file"},
    {"CPU", statements_cpu, "CPU RESTART [BOOTSEL]",
     "Starts afresh, or the boot loader for a new firmware"},
    {"DATA", statements_data, "DATA value [, ...]", "Values for READ"},
    {"DIM", statements_dim, "DIM [type] name[(size, ...)] [AS type] [LENGTH n] [= value] [, ...]",
     "Declares variables and arrays"},
    {"DO", statements_do, "DO [WHILE|UNTIL condition] ... LOOP [WHILE|UNTIL condition]", "Repeats"},
    {"EDIT", statements_edit, "EDIT [file$]", "Edits the program, or a file, on the whole screen"},
    {"ELSE", statements_else, NULL, NULL},
    {"ELSEIF", statements_elseif, NULL, NULL},
    {"END", statements_end, "END [NOEND]", "Ends the program; NOEND: without its SUB MM.END"},
    {"ENDIF", statements_endif, NULL, NULL},
    {"ERASE", statements_erase, "ERASE name [, ...]", "Deletes variables and arrays"},
    {"ERROR", statements_error, "ERROR [text$]", "Raises an error"},
    {"EXECUTE", statements_execute, "EXECUTE text$", "Carries out statements that a string holds"},
    {"EXIT", statements_exit, "EXIT FOR|DO|SUB|FUNCTION", "Leaves a loop or a routine"},
    {"FILES", statements_files, "FILES [pattern$]", "Lists files; * and ? stand for anything"},
    {"FLUSH", statements_flush, "FLUSH [#]n", "Stores or sends what was written to a channel"},
    {"FOR", statements_for, "FOR name = first TO last [STEP step] ... NEXT [name]", "Counts"},
    {"FUNCTION", statements_function, "FUNCTION name(parameters) ... END FUNCTION",
     "Defines a function; its value is assigned to its name"},
    {"GOSUB", statements_gosub, "GOSUB label", "Calls lines that end with RETURN"},
    {"GOTO", statements_goto, "GOTO label", "Goes on at a label or line number"},
    {"HELP", statements_help, "HELP [command]", "Explains a command; alone, lists them"},
    {"IF", statements_if, "IF condition THEN ... [ELSEIF condition THEN ...] [ELSE ...] ENDIF",
     "Decides"},
    {"INC", statements_inc, "INC name [, amount]", "Adds to a variable"},
    {"INPUT", statements_input, "INPUT [\"prompt\";] name [, ...] / INPUT #n, name [, ...]",
     "Reads values from the terminal or a channel"},
    {"KILL", statements_kill, "KILL file$ [, ALL]",
     "Deletes a file; with ALL those that fit a pattern"},
    {"LET", statements_let, "[LET] name = value", "Assigns"},
    {"LINE", statements_line, "LINE INPUT [prompt$,] name$ / LINE INPUT #n, name$",
     "Reads a line from the terminal or a channel"},
    {"LIST", statements_list, "LIST [ALL] [first[-last] | file$ | PINS] / LIST COMMANDS|FUNCTIONS",
     "Shows the program, some of its lines, a file or who uses which pin, with ALL without a "
     "stop; or all words"},
    {"LOAD", statements_load, "LOAD file$ [, R]",
     "Makes what a file holds the program; R: runs it"},
    {"LOCAL", statements_local, "LOCAL [type] name ...", "As DIM, for this SUB or FUNCTION only"},
    {"LOOP", statements_loop, NULL, NULL},
    {"MATH", statements_math,
     "MATH SET number, a() / SCALE a(), number, b() / ADD a(), number, b() / "
     "INTERPOLATE a(), b(), ratio, c()",
     "Computes with whole arrays; the last one gets the result"},
    {"MEMORY", statements_memory, "MEMORY", "Shows how much memory is in use"},
    {"MKDIR", statements_mkdir, "MKDIR folder$", "Makes a folder"},
    {"NEW", statements_new, "NEW", "Deletes the program and all variables"},
    {"NEXT", statements_next, NULL, NULL},
    {"ON", statements_on,
     "ON n GOTO|GOSUB label, ... / ERROR ABORT|IGNORE|SKIP [n]|CLEAR / KEY [code,] sub",
     "Chooses a label / says what errors do / calls a SUB for a key; 0: no more"},
    {"OPEN", statements_open, "OPEN name$ FOR INPUT|OUTPUT|APPEND|RANDOM AS [#]n",
     "Opens a file as a channel, 1 to 10"},
    {"OPTION", statements_option,
     "OPTION EXPLICIT / DEFAULT type|NONE / BASE 0|1 / ESCAPE / ANGLE DEGREES|RADIANS / "
     "CONTINUATION LINES ON|OFF / AUTORUN ON|OFF / BREAK key / COLOURCODE ON|OFF / "
     "DISPLAY lines [, columns] / F1 text$ ... F12 text$ / TAB 2|3|4|8 / LIST / RESET / "
     "FORMAT \"A:\"",
     "Sets how a program is read and computes; from AUTORUN on, what is kept over power-off"},
    {"PAUSE", statements_pause, "PAUSE milliseconds", "Waits"},
    {"PRINT", statements_print, "PRINT [#n,] value [;|, ...]",
     "Writes to the terminal or a channel; ? for short"},
    {"RANDOMIZE", statements_randomize, "RANDOMIZE [seed]", "Starts the sequence of RND"},
    {"READ", statements_read, "READ name|array() [, ...] / READ SAVE|RESTORE",
     "Takes the next values of DATA / keeps the place in it and goes back there"},
    {"REDIM", statements_redim, "REDIM [PRESERVE] array(size, ...) [, ...]",
     "Gives an array another size"},
    {"REM", statements_rem, "REM text", "A comment; ' for short"},
    {"RENAME", statements_rename, "RENAME file$ AS file$", "Gives a file another name"},
    {"RESTORE", statements_restore, "RESTORE [label]", "READ starts over"},
    {"RETURN", statements_return, NULL, NULL},
    {"RMDIR", statements_rmdir, "RMDIR folder$", "Deletes an empty folder"},
    {"RUN", statements_run, "RUN [file$] [, argument$]", "Runs the program, or the one in a file"},
    {"SAVE", statements_save, "SAVE file$", "Stores the program in a file of its own"},
    {"SEEK", statements_seek, "SEEK [#]n, position", "Goes to a place in a file; the first is 1"},
    {"SELECT", statements_select,
     "SELECT CASE value ... CASE a, b TO c, IS < d ... CASE ELSE ... END SELECT",
     "Decides among many"},
    {"SETTICK", statements_settick,
     "SETTICK milliseconds, sub [, 1..4] / PAUSE|RESUME [, sub] [, 1..4]",
     "Calls a SUB again and again; 0, 0: no more"},
    {"SORT", statements_sort, "SORT array() [, index()] [, flags] [, start] [, count]",
     "Sorts; index() gets the old subscripts; flags: 1 downwards, 2 any case, 4 empty ones last"},
    {"STATIC", statements_static, "STATIC [type] name[(size, ...)] [= value] [, ...]",
     "As LOCAL, but keeps its value from call to call"},
    {"SUB", statements_sub, "SUB name [parameters] ... END SUB", "Defines a command"},
    {"TIMER", statements_timer, "TIMER = milliseconds", "Sets the clock that TIMER reads"},
    {"TRACE", statements_trace, "TRACE ON|OFF / LIST [n]",
     "Shows the number of each line as it runs / of the last ones"},
    {"UPDATE", statements_update, "UPDATE FIRMWARE",
     "Starts the boot loader, as CPU RESTART BOOTSEL"},
    {"VAR", statements_var, "VAR SAVE name|array() [, ...] / VAR RESTORE / VAR CLEAR",
     "Keeps variables over power-off, brings them back, forgets them"},
    {"WATCHDOG", statements_watchdog, "WATCHDOG milliseconds|OFF",
     "Restarts the board unless it is called again in time"},
    {"WEND", statements_wend, NULL, NULL},
    {"WHILE", statements_while, "WHILE condition ... LOOP or WEND", "As DO WHILE"},
    {"XMODEM", statements_xmodem, "XMODEM SEND|RECEIVE [file$]",
     "Sends or receives a file, or the program, over the terminal"},
};

_Static_assert(COUNT_OF_ARRAY(statements_table) <= WORDS_ROWS_MAX, "no word for the last rows");

const size_t statements_count = COUNT_OF_ARRAY(statements_table);

// Where the parenthesis at the token at hand closes, as a place behind it; NULL: it does not.
static const char *behind_parentheses(void) {
    unsigned depth = 0;
    const char *start = lexer_now()->text;
    const char *behind = NULL;
    while (lexer_now()->kind != LEXER_END && behind == NULL) {
        depth += lexer_is('(');
        depth -= lexer_is(')');
        if (depth == 0) {
            behind = lexer_now()->behind;
        }
        lexer_next();
    }
    lexer_go(start);
    return behind;
}

// name = ... or name(...) = ...
static bool is_assignment(void) {
    const char *start = lexer_now()->text;
    lexer_next();
    if (lexer_is('(')) {
        const char *behind = behind_parentheses();
        if (behind != NULL) {
            lexer_go(behind);
        }
    }
    bool found = lexer_is('=');
    lexer_go(start);
    return found;
}

// `name a, b` or `name(a, b)`.
static void compile_sub_call(symbols_t *symbol) {
    if (symbol->routine->is_function) {
        errors_fail(ERR_SYNTAX);
    }
    emit_op(OP_BLANK);
    lexer_next();
    unsigned count;
    const char *behind = lexer_is('(') ? behind_parentheses() : NULL;
    bool enclosed = false;
    if (behind != NULL) {
        const char *start = lexer_now()->text;
        lexer_go(behind);
        enclosed = lexer_at_end();
        lexer_go(start);
    }
    if (enclosed) {
        lexer_next();
        count = expressions_compile_arguments(')');
        lexer_expect(')');
    } else {
        count = expressions_compile_arguments(0);
    }
    emit_op(OP_CALL);
    emit_u16(memory_handle(symbol));
    emit_byte(count);
}

static bool exists(const lexer_token_t *name) {
    const symbols_t *symbol =
        symbols_find(SYMBOLS_VARIABLE, 0, name->text, lexer_bare_length(name));
    return symbol != NULL && symbol->value.type != VALUE_NONE;
}

// True if the line can only be meant as an expression: it opens with a value, or a name that
// exists.
static bool is_expression(void) {
    const lexer_token_t *token = lexer_now();
    if (token->kind != LEXER_NAME) {
        return token->kind == LEXER_NUMBER || token->kind == LEXER_STRING || lexer_is('(') ||
               lexer_is('-') || lexer_is('+');
    }
    size_t length = lexer_bare_length(token);
    return lexer_is_word("NOT") || lexer_is_word("INV") ||
           words_find(WORDS_FUNCTION, token->text, token->length) != WORDS_NONE ||
           words_find(WORDS_HOST_FUNCTION, token->text, token->length) != WORDS_NONE ||
           exists(token) || symbols_find(SYMBOLS_ROUTINE, 0, token->text, length) != NULL;
}

bool statements_is_value(void) {
    bool is_timer = lexer_is_word("TIMER");
    if (!compiler_at_prompt() || !(is_timer || lexer_is_word("MATH"))) {
        return false;
    }
    const char *start = lexer_now()->text;
    lexer_next();
    bool is_value = is_timer ? !lexer_is('=') : lexer_is('(');
    lexer_go(start);
    return is_value;
}

bool statements_compile_other(void) {
    const lexer_token_t *token = lexer_now();
    if (token->kind == LEXER_NAME) {
        if (is_assignment()) {
            statements_let();
            return true;
        }
        symbols_t *symbol = symbols_find(SYMBOLS_ROUTINE, 0, token->text, lexer_bare_length(token));
        if (symbol != NULL && !symbol->routine->is_function) {
            compile_sub_call(symbol);
            return true;
        }
    }
    if (compiler_at_prompt() && is_expression()) {
        expressions_compile();
        emit_action(ACTIONS_PRINT_VALUE, 1);
        emit_action(ACTIONS_PRINT_LINE, 0);
        return true;
    }
    return false;
}

// Programs from a grammar. Its statements are data, in fuzz_grammar.c: templates in which {x}
// stands for a piece that is chosen anew, most of them as the place wants them, some not. Functions
// come from the language's own table, product commands from theirs, so new ones take part by
// themselves.
#include "fuzz_program.h"

#include <string.h>

#include "basic/functions.h"
#include "fuzz_console_lines.h"
#include "fuzz_grammar.h"
#include "fuzz_random.h"

#define DEPTH_MAX 4       // of blocks and of expressions
#define STATEMENTS_MAX 70 // of a program
#define ROUTINES 3        // of each kind

static const char *const numbers[] = {"a",  "b",  "x", "i%", "n%", "fa({d})", "ia%({d},{d})",
                                      "px", "pz%"};
static const char *const texts[] = {"s$", "t$", "sa$({d})", "py$"};
static const char *const arrays[] = {"fa", "ia%", "sa$", "la"};
static const char *const files[] = {"\"a.txt\"", "\"b.txt\"", "\"dir\"",     "\"dir/c.txt\"",
                                    "\"A:/a\"",  "\"..\"",    "{s}",         "\"x.bas\"",
                                    "\"*.txt\"", "\"\"",      "\"dir/no/f\""};
static const char *const operators[] = {"+",  "-",  "*",     "/",    "\\",    " MOD ", "^",
                                        "<<", ">>", " AND ", " OR ", " XOR ", "=",     "<>"};
static const char *const comparisons[] = {"=", "<>", "<", ">", "<=", ">="};

static struct {
    fuzz_text_t *text;
    unsigned statements; // left
    bool in_text;        // no quotes, no line ends
} program;

static void expand(const char *template, unsigned depth);
static void add_number(unsigned depth);
static void add_text(unsigned depth);

#define ADD(...) fuzz_text_add(program.text, __VA_ARGS__)

// ---- Expressions --------------------------------------------------------------------------------

static void add_function(bool text_wanted, unsigned depth) {
    const functions_row_t *row;
    bool is_text;
    do {
        row = &functions_table[fuzz_random_below((unsigned)functions_count)];
        is_text = row->name[strlen(row->name) - 1] == '$';
    } while (is_text != text_wanted && !fuzz_random_percent(2));
    ADD("%s", row->name);
    unsigned span = row->most > 4 ? 4u - row->least % 4u : (unsigned)(row->most - row->least);
    unsigned count = row->least + fuzz_random_below(span + 1);
    if (count == 0) {
        return;
    }
    const char *type = row->types;
    for (unsigned i = 0; i < count; i++) {
        ADD("%s", i == 0 ? "(" : ",");
        char kind = fuzz_random_percent(3) ? "nsac"[fuzz_random_below(4)] : *type;
        expand(kind == 's'   ? "{s}"
               : kind == 'a' ? "{a}"
               : kind == 'c' ? "#{k}"
               : kind == 'v' ? (fuzz_random_percent(50) ? "{n}" : "{s}")
               : kind == 'w' ? "FILE"
               : kind == 'i' ? "{i}"
                             : "{n}",
               depth);
        type += type[0] != '\0' && type[1] != '\0';
    }
    ADD(")");
}

static void add_small(void) {
    if (fuzz_random_percent(4)) {
        fuzz_text_number(program.text);
    } else {
        ADD("%d", fuzz_random_between(fuzz_random_percent(10) ? -3 : 0, 9));
    }
}

static void add_number(unsigned depth) {
    switch (depth == 0 ? fuzz_random_below(3) : fuzz_random_below(9)) {
    case 0:
        add_small();
        break;
    case 1:
        if (fuzz_random_percent(20)) {
            fuzz_text_number(program.text);
        } else {
            ADD("%g", fuzz_random_between(-500, 500) / 8.0);
        }
        break;
    case 2:
        expand("{v}", depth);
        break;
    case 3:
        expand("({n})", depth - 1);
        break;
    case 4:
        expand(fuzz_random_percent(50) ? "-{n}" : "NOT {n}", depth - 1);
        break;
    case 5:
        add_function(false, depth - 1);
        break;
    case 6:
        expand(fuzz_random_percent(50) ? "f{r}({n},{n})" : "({c})", depth - 1);
        break;
    default:
        add_number(depth - 1);
        ADD("%s", FUZZ_RANDOM_PICK(operators));
        add_number(depth - 1);
        break;
    }
}

static void add_literal(void) {
    if (program.in_text) {
        expand("{t}", 0);
        return;
    }
    ADD("\"");
    if (fuzz_random_percent(3)) {
        ADD("%.*s", fuzz_random_between(100, 250),
            "0123456789 0123456789 0123456789 0123456789 0123456789 0123456789 0123456789 "
            "0123456789 "
            "0123456789 0123456789 0123456789 0123456789 0123456789 0123456789 0123456789 "
            "0123456789 "
            "0123456789 0123456789 0123456789 0123456789 0123456789 0123456789 0123456789 "
            "0123456789");
    } else {
        for (unsigned count = fuzz_random_below(8); count > 0; count--) {
            ADD("%c", "abc,x 19.-+*?&"[fuzz_random_below(14)]);
        }
    }
    ADD("\"");
}

static void add_text(unsigned depth) {
    switch (depth == 0 ? fuzz_random_below(2) : fuzz_random_below(6)) {
    case 0:
        add_literal();
        break;
    case 1:
        expand("{t}", depth);
        break;
    case 2:
        expand("{s}+{s}", depth - 1);
        break;
    case 3:
        expand("g{r}$({s})", depth - 1);
        break;
    default:
        add_function(true, depth - 1);
        break;
    }
}

static void add_condition(unsigned depth) {
    bool text = fuzz_random_percent(25);
    for (int side = 0; side < 2; side++) {
        if (text && !fuzz_random_percent(2)) {
            add_text(depth);
        } else {
            add_number(depth);
        }
        ADD("%s", side == 0 ? FUZZ_RANDOM_PICK(comparisons) : "");
    }
}

// ---- Statements ---------------------------------------------------------------------------------

static void add_statement(unsigned depth);

static void add_block(unsigned depth) {
    for (unsigned count = 1 + fuzz_random_below(4); count > 0; count--) {
        add_statement(depth);
        ADD("\r");
    }
}

// A number expression or simple statements, without quotes, as EXECUTE and EVAL take them.
static void add_quotable(void) {
    bool outer = program.in_text;
    program.in_text = true;
    expand(fuzz_random_percent(50)   ? "{n}"
           : fuzz_random_percent(50) ? "{v}={n}:INC {v},{i}"
                                     : "PRINT {n};{t}",
           1);
    program.in_text = outer;
}

static void add_piece(char piece, unsigned depth) {
    switch (piece) {
    case 'n':
        add_number(fuzz_random_below(depth + 1));
        break;
    case 'i':
    case 'd':
        add_small();
        break;
    case 's':
        add_text(fuzz_random_below(depth + 1));
        break;
    case 'c':
        add_condition(depth > 2 ? 2 : depth);
        break;
    case 'v':
        expand(FUZZ_RANDOM_PICK(numbers), 0);
        break;
    case 't':
        expand(FUZZ_RANDOM_PICK(texts), 0);
        break;
    case 'a':
        ADD("%s()", FUZZ_RANDOM_PICK(arrays));
        break;
    case 'A':
        ADD("%s", FUZZ_RANDOM_PICK(arrays));
        break;
    case 'r':
        ADD("%d", fuzz_random_between(1, ROUTINES));
        break;
    case 'k':
        ADD("%d", fuzz_random_between(1, fuzz_random_percent(90) ? 3 : 11));
        break;
    case 'f':
        expand(FUZZ_RANDOM_PICK(files), 0);
        break;
    case 'p':
        ADD(fuzz_random_percent(60) ? "GP%d" : "%d", fuzz_random_between(0, 30));
        break;
    case 'l':
        ADD("l%d", fuzz_random_between(1, ROUTINES));
        break;
    case 'h':
        ADD("h%d", fuzz_random_between(1, ROUTINES));
        break;
    case 'x':
        fuzz_console_command(program.text);
        break;
    case 'q':
        add_quotable();
        break;
    case 'B':
        add_block(depth > 0 ? depth - 1 : 0);
        break;
    default:
        break;
    }
}

static void expand(const char *template, unsigned depth) {
    for (const char *p = template; *p != '\0'; p++) {
        if (*p != '{') {
            fuzz_text_byte(program.text, *p);
            continue;
        }
        add_piece(p[2] == '0' ? 'A' : p[1], depth);
        p = strchr(p, '}');
    }
}

static void add_statement(unsigned depth) {
    bool more = program.statements > 0;
    program.statements -= more;
    if (more && depth > 0 && fuzz_random_percent(35)) {
        expand(fuzz_grammar_block(), depth);
    } else {
        expand(fuzz_grammar_statement(), 2);
    }
    if (fuzz_random_percent(5)) {
        ADD(":");
        expand(fuzz_grammar_statement(), 1);
    }
}

// ---- Programs -----------------------------------------------------------------------------------

static void add_head(void) {
    static const char *const options[] = {"OPTION EXPLICIT", "OPTION BASE 1",
                                          "OPTION DEFAULT INTEGER", "OPTION DEFAULT NONE",
                                          "OPTION ESCAPE"};
    if (fuzz_random_percent(20)) {
        ADD("%s\r", FUZZ_RANDOM_PICK(options));
    }
    if (fuzz_random_percent(95)) {
        ADD("DIM a,b,x,i%%,n%%,s$,t$,guard%%,px,pz%%,py$,m,o%%,j1,j2,j3\r");
        ADD("DIM fa(9),ia%%(9,9)=(1,2,3),sa$(9) LENGTH 40,la(3)=(3,1,2,0)\r");
    }
    if (fuzz_random_percent(60)) {
        ADD("ON ERROR IGNORE\r");
    }
    if (fuzz_random_percent(30)) {
        expand("SETTICK {i},{h},{r}\rON KEY {h}\r", 0);
    }
}

static void add_routines(void) {
    for (int i = 1; i <= ROUTINES; i++) {
        ADD("l%d:\r", i);
        add_block(1);
        ADD("RETURN\r");
    }
    expand("DATA {i},abc,{n},\"x,y\",{i},{i},{i},,z\r", 1);
    for (int i = 1; i <= ROUTINES; i++) {
        ADD(fuzz_random_percent(70) ? "SUB p%d(px,py$,pz%%)\r" : "SUB p%d px\r", i);
        if (fuzz_random_percent(60)) {
            expand("LOCAL q,r$,c(3)\rSTATIC u%\rINC u%\r", 1);
        }
        add_block(2);
        ADD("END SUB\rFUNCTION f%d(px,pz%%)\r", i);
        if (fuzz_random_percent(30)) {
            ADD("IF px>0 AND px<20 THEN f%d=px*f%d(px-1,pz%%)\r", i, i);
        }
        add_block(1);
        ADD("f%d=px+pz%%\rEND FUNCTION\rFUNCTION g%d$(py$)\r", i, i);
        add_block(1);
        ADD("g%d$=py$+\"!\"\rEND FUNCTION\rSUB h%d\r", i, i);
        add_block(1);
        ADD("END SUB\r");
    }
}

void fuzz_program(fuzz_text_t *text) {
    program.text = text;
    program.statements = STATEMENTS_MAX;
    program.in_text = false;
    ADD("AUTOSAVE\r");
    size_t start = text->length;
    add_head();
    for (unsigned count = 3 + fuzz_random_below(12); count > 0; count--) {
        add_statement(DEPTH_MAX);
        ADD("\r");
    }
    ADD("END\r");
    add_routines();
    if (fuzz_random_percent(15)) {
        fuzz_text_t spoiled = {.length = text->length - start};
        memcpy(spoiled.bytes, text->bytes + start, spoiled.length);
        fuzz_text_mutate(&spoiled);
        memcpy(text->bytes + start, spoiled.bytes, spoiled.length);
        text->length = start + spoiled.length;
    }
    fuzz_text_add(text, "\r\x1aRUN\r");
}

void fuzz_program_line(fuzz_text_t *text) {
    program.text = text;
    program.statements = 0;
    program.in_text = false;
    add_statement(0);
}

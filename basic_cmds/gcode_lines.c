// STEPPER GC, GS, GCODE, DIALECT, ARC LEGACY, BLOCKDELETE, OPTIONALSTOP. Context: main loop.
#include "basic_cmds/gcode_lines.h"

#include <ctype.h>

#include "basic_cmds/job.h"
#include "gcode/gcode.h"
#include "gcode/gcode_job.h"
#include "stepper/rules.h"

#define POLL_US 1000u

static struct {
    bool waiting; // a statement waits for the end of its line and will raise the error itself
} lines;

// A statement that homes or probes ends when that has ended. Ctrl-C ends the waiting too.
static err_t finish(err_t err) {
    if (err != ERR_OK) {
        return err;
    }
    lines.waiting = true;
    while (gcode_must_wait() && basic_wait(hal_time_us() + POLL_US)) {
        gcode_background();
    }
    lines.waiting = false;
    return gcode_failure();
}

err_t gcode_lines_text(const basic_arg_t *args, size_t count) {
    (void)count;
    err_t err = job_check_free();
    return err != ERR_OK ? err : finish(gcode_line(args[0].text.text, args[0].text.length));
}

// A code such as G1 as one word of the command.
static err_t read_code(const basic_text_t *code, gcode_word_t *word) {
    num_t number;
    const char *end = code->text + code->length;
    char letter = (char)toupper((unsigned char)code->text[0]);
    if (!isalpha((unsigned char)letter) || num_parse(code->text + 1, end, false, &number) != end) {
        return err_raise(ERR_GCODE_UNSUPPORTED, "%.*s", (int)code->length, code->text);
    }
    *word = (gcode_word_t){.letter = letter, .value = number.value};
    return ERR_OK;
}

// The first argument is a code such as G1 or G92, the others are pairs of a letter and a value.
err_t gcode_lines_words(const basic_arg_t *args, size_t count) {
    gcode_word_t words[GCODE_WORDS_MAX];
    size_t used = 0;
    err_t err = job_check_free();
    if (err == ERR_OK && args[0].text.length > 0) {
        err = read_code(&args[0].text, &words[used++]);
    }
    if (err != ERR_OK) {
        return err;
    }
    for (size_t i = 1; i + 1 < count; i += 2) {
        const basic_text_t *name = &args[i].text;
        if (name->length != 1) {
            return err_raise(ERR_GCODE_UNKNOWN_WORD, "%.*s", (int)name->length, name->text);
        }
        if (used == GCODE_WORDS_MAX) {
            return err_raise(ERR_GCODE_TOO_MANY_WORDS, NULL);
        }
        words[used++] = (gcode_word_t){
            .letter = (char)toupper((unsigned char)name->text[0]),
            .value = args[i + 1].number,
        };
    }
    return finish(gcode_words(words, used));
}

// ---- Options ------------------------------------------------------------------------------------

static err_t set_options(const gcode_options_t *options) {
    err_t err = rules_check(RULES_DO_SETTING);
    if (err == ERR_OK) {
        gcode_set_options(options);
    }
    return err;
}

err_t gcode_lines_dialect(const basic_arg_t *args, size_t count) {
    (void)count;
    gcode_options_t options = *gcode_options();
    options.nist = args[0].integer != 0;
    err_t err = job_check_free(); // the rest of the file would mean something else
    return err == ERR_OK ? set_options(&options) : err;
}

err_t gcode_lines_arc_legacy(const basic_arg_t *args, size_t count) {
    (void)count;
    gcode_options_t options = *gcode_options();
    options.arc_legacy = args[0].integer != 0;
    return set_options(&options);
}

err_t gcode_lines_block_delete(const basic_arg_t *args, size_t count) {
    (void)count;
    gcode_options_t options = *gcode_options();
    options.block_delete = args[0].integer != 0;
    return set_options(&options);
}

err_t gcode_lines_optional_stop(const basic_arg_t *args, size_t count) {
    (void)count;
    gcode_options_t options = *gcode_options();
    options.optional_stop = args[0].integer != 0;
    return set_options(&options);
}

// ---- Report -------------------------------------------------------------------------------------

static void print_path_mode(void) {
    gcode_path_t path = gcode_path();
    switch (path.corner) {
    case STEPPER_CORNER_EXACT:
        basic_printf("Path mode: G61 exact path");
        break;
    case STEPPER_CORNER_STOP:
        basic_printf("Path mode: G61.1 exact stop");
        break;
    case STEPPER_CORNER_CONTINUOUS:
        basic_printf("Path mode: G64");
        break;
    case STEPPER_CORNER_BLEND:
        basic_printf("Path mode: G64 P%g", path.blend_mm);
        break;
    }
    basic_printf(", A on arcs: %s\n", gcode_options()->arc_legacy ? "ignored" : "turns along");
}

// Where work zero is, unless that is machine zero.
static void print_origin(void) {
    bool moved = false;
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        moved |= gcode_offset(axis) != 0.0;
    }
    if (!moved) {
        return;
    }
    basic_printf("Work zero at machine");
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        if (stepper_axis_configured(axis)) {
            basic_printf(" %c%.3f", STEPPER_AXIS_LETTERS[axis], gcode_offset(axis));
        }
    }
    basic_printf("\n");
}

void gcode_lines_report(void) {
    char modes[GCODE_MODES_SIZE];
    gcode_background(); // which notices that a stop has switched the spindle off
    gcode_modes(modes);
    basic_printf("G-code: %s\n", modes);
    print_path_mode();
    print_origin();
}

// ---- Background ---------------------------------------------------------------------------------

void gcode_lines_background(void) {
    bool tells = gcode_failed() && !lines.waiting && !gcode_job_runs();
    if (!gcode_busy() && !tells) {
        return;
    }
    err_kept_t kept; // the statement in the foreground may be about to tell its error
    err_keep(&kept);
    gcode_background();
    if (tells && gcode_failure() != ERR_OK) {
        basic_notice("Error: %s", err_message());
    }
    err_put_back(&kept);
}

static void tell(const char *text, size_t length) {
    basic_notice("%.*s", (int)length, text);
}

void gcode_lines_reset(void) {
    gcode_reset();
    gcode_set_listener(tell);
}

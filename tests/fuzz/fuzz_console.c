// A session at the prompt. The whole firmware runs, its main() included; this is the peer on the
// other end of the line, which is asked for input whenever the firmware looks for some. After each
// input it waits for the prompt and checks what must hold. Time is virtual and moves only while the
// firmware waits.
#include <ctype.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "fuzz_console_lines.h"
#include "fuzz_corpus.h"
#include "fuzz_drivers.h"
#include "fuzz_machine.h"
#include "fuzz_main_entry.h"
#include "fuzz_program.h"
#include "fuzz_random.h"
#include "fuzz_session.h"
#include "basic/memory.h"
#include "hal/hal.h"
#include "host_console.h"
#include "stepper/stepper.h"

#define INPUTS 120
#define PROGRAM_INPUTS 60
#define OUTPUT_SIZE 65536
#define QUIET_POLLS 10       // looks for input without output that make a prompt a prompt
#define PATIENCE_US 5000000u // virtual time that an input may take before it gets a Ctrl-C
#define PROGRAM_PATIENCE_US 1000000u
#define PATIENCE_POLLS 5000u // the same in looks, for waits in which time stands still
#define SETTLE_US 20000000u  // virtual time for motion to end by itself

typedef enum { STEP_SEND, STEP_WAIT, STEP_BREAK, STEP_DRAIN, STEP_DRAIN_STOP, STEP_END } step_t;

static struct {
    step_t step;
    fuzz_text_t input; // being sent
    size_t sent;
    unsigned inputs;
    unsigned setup_lines;
    bool single;     // the input is one command: an error means that nothing has happened
    bool canary;     // the input is a question whose answer is known
    bool programs;   // the session is about programs more than about single lines
    bool emptied;    // the input ends with NEW: everything must be given back
    size_t new_free; // bytes free after the first NEW; 0: there was none yet
    fuzz_machine_t before;
    uint64_t since_us;        // input sent, or motion left alone, at this time
    unsigned polls;           // looks for input since
    unsigned quiet;           // looks without output since
    unsigned exits;           // keys sent after a Ctrl-C that did not help
    uint64_t resume_us;       // no input before this time
    char output[OUTPUT_SIZE]; // since the input began; the first part if there is more
    size_t output_length;
    char tail[4]; // last bytes of all
} peer;

// ---- Checks -------------------------------------------------------------------------------------

static const char *find(const char *text, size_t length, const char *what) {
    size_t size = strlen(what);
    for (size_t i = 0; i + size <= length; i++) {
        if (memcmp(text + i, what, size) == 0) {
            return text + i;
        }
    }
    return NULL;
}

static const char *find_error(void) {
    return find(peer.output, peer.output_length, "\nError : ");
}

// The error is one line of text, and the prompt comes right behind it.
static void check_error_line(const char *error) {
    const char *end = peer.output + peer.output_length;
    const char *p = error + 1;
    while (p < end && isprint((unsigned char)*p)) {
        p++;
    }
    bool planted = fuzz_session_plant_now(FUZZ_PLANT_LONG_ERROR);
    FUZZ_SESSION_CHECK(end - p >= 4 && memcmp(p, "\r\n> ", 4) == 0 && !planted,
                       "the error is not followed by the prompt, or not one line of text: %.*s",
                       (int)(end - error - 1 < 200 ? end - error - 1 : 200), error + 1);
    FUZZ_SESSION_CHECK(p - error > 10, "an error without a message");
}

// What only certain commands may do: set the position instead of moving to it.
static bool may_set_position(void) {
    static const char *const words[] = {"POSITION", "INIT", "AXIS", "CLOSE", "ESTOP"};
    char upper[FUZZ_TEXT_MAX];
    for (size_t i = 0; i < peer.input.length; i++) {
        upper[i] = (char)toupper((unsigned char)peer.input.bytes[i]);
    }
    for (size_t i = 0; i < COUNT_OF_ARRAY(words); i++) {
        if (find(upper, peer.input.length, words[i]) != NULL) {
            return true;
        }
    }
    return !peer.single && !peer.canary;
}

static void show_output(void) {
    if (fuzz_session->show) {
        fuzz_text_t output = {.length = 0};
        for (size_t i = 0; i < peer.output_length; i++) {
            fuzz_text_byte(&output, peer.output[i]);
        }
        fuzz_session_print("output", &output);
    }
}

// What a program used is free again after NEW. (While motors turn NEW is refused.)
static void check_memory(void) {
    if (find_error() != NULL) {
        return;
    }
    size_t now = memory_free();
    if (peer.new_free == 0) {
        peer.new_free = now;
    }
    FUZZ_SESSION_CHECK(now == peer.new_free, "%zu bytes are free after NEW, once there were %zu",
                       now, peer.new_free);
}

// The error is no refusal: the line moved an axis and tells what it has learned.
static bool has_tuned(void) {
    return find(peer.output, peer.output_length, "\nSGTUNE     ms") != NULL;
}

static void check_input(void) {
    show_output();
    if (peer.input.length == 0) {
        return;
    }
    const char *error = find_error();
    if (peer.canary) {
        FUZZ_SESSION_CHECK(find(peer.output, peer.output_length, "\r\n 42\r\n> ") != NULL,
                           "the prompt does not calculate any more: %.*s", (int)peer.output_length,
                           peer.output);
    } else if (peer.single) {
        fuzz_session->accepted += error == NULL;
        fuzz_session->refused += error != NULL;
        if (error != NULL) {
            if (fuzz_session_plant_now(FUZZ_PLANT_REFUSED_MOVES)) {
                stepper_dwell(1);
            }
            if (fuzz_session_plant_now(FUZZ_PLANT_DRIVER_WRITE)) {
                fuzz_drivers_plant_write();
            }
            check_error_line(error);
            if (!has_tuned()) {
                fuzz_machine_check_unchanged(&peer.before);
            }
        } else {
            fuzz_session->moves += find(peer.input.bytes, peer.input.length, "STEPPER GC") != NULL;
        }
    }
    if (peer.emptied) {
        check_memory();
    }
    if (may_set_position()) {
        fuzz_machine_rebase();
    }
    fuzz_machine_check_pulses();
}

// ---- What is typed next -------------------------------------------------------------------------

static void make_wild_input(fuzz_text_t *text) {
    switch (fuzz_random_below(10)) {
    case 0:
        fuzz_console_program(text);
        break;
    case 1:
    case 2:
        fuzz_console_keys(text);
        break;
    case 3:
        fuzz_corpus_pick(FUZZ_CORPUS_CONSOLE, text);
        fuzz_text_mutate(text);
        break;
    case 4:
        fuzz_corpus_pick(FUZZ_CORPUS_CONSOLE, text);
        break;
    case 5:
        fuzz_console_command(text);
        fuzz_text_mutate(text);
        break;
    case 6:
        fuzz_console_basic(text);
        fuzz_text_mutate(text);
        break;
    case 7: // a line of 10 kB
        while (fuzz_random_percent(30) && text->length < 10000) {
            fuzz_console_basic(text);
            fuzz_text_add(text, ":");
        }
        fuzz_text_printable(text, 10000 - text->length);
        break;
    default:
        fuzz_console_basic(text);
        break;
    }
    fuzz_text_add(text, "\r");
}

// A program, what is typed while it may still run, a line of its kind, the editor, a transfer.
static void make_program_input(fuzz_text_t *text) {
    switch (fuzz_random_below(10)) {
    case 0:
        for (unsigned lines = 1 + fuzz_random_below(4); lines > 0; lines--) {
            fuzz_program_line(text);
            fuzz_text_add(text, "\r");
        }
        break;
    case 1:
        fuzz_text_add(text, "EDIT\r");
        fuzz_console_keys(text);
        fuzz_text_add(text, "%s", fuzz_random_percent(50) ? "\x1bOP" : "\x1b[11~");
        break;
    case 2:
        fuzz_text_add(text, "XMODEM %s\r", fuzz_random_percent(50) ? "RECEIVE \"x\"" : "SEND");
        fuzz_text_noise(text, fuzz_random_below(400));
        fuzz_text_add(text, "\x18\x18\x18\r");
        break;
    case 3:
        peer.emptied = true;
        fuzz_text_add(text, "\x03NEW\r");
        break;
    default:
        fuzz_program(text);
        if (fuzz_random_percent(30)) {
            fuzz_console_keys(text);
            fuzz_text_add(text, "\r");
        }
        break;
    }
}

// Neither colons, which separate statements, nor keys that end or edit a line.
static bool is_one_statement(const fuzz_text_t *text) {
    for (size_t i = 0; i < text->length; i++) {
        if (text->bytes[i] == ':' || !isprint((unsigned char)text->bytes[i])) {
            return false;
        }
    }
    return true;
}

static void make_input(void) {
    fuzz_text_clear(&peer.input);
    peer.single = peer.emptied = false;
    if (!stepper_axis_configured(AXIS_X) && fuzz_random_percent(30)) {
        peer.setup_lines = 0; // closed meanwhile: without this most of the session would be refused
    }
    // After anything at all the prompt must still calculate. Ctrl-C leaves whatever was left open.
    peer.canary = !peer.canary && peer.setup_lines > 0 && fuzz_random_percent(25);
    if (peer.canary) {
        fuzz_text_add(&peer.input, "\x03PRINT 6*7\r");
    } else if (fuzz_console_setup_line(&peer.input, peer.setup_lines)) {
        peer.setup_lines++;
    } else if (peer.programs && fuzz_random_percent(80)) {
        make_program_input(&peer.input);
    } else if (fuzz_random_percent(45)) {
        fuzz_console_command(&peer.input);
        peer.single = is_one_statement(&peer.input);
        fuzz_text_add(&peer.input, "\r");
    } else {
        make_wild_input(&peer.input);
    }
}

static void begin_input(void) {
    make_input();
    fuzz_session_input(&peer.input);
    fuzz_machine_look(&peer.before);
    peer.inputs++;
    peer.sent = 0;
    peer.output_length = 0;
    peer.step = STEP_SEND;
}

// ---- The peer -----------------------------------------------------------------------------------

static void start_waiting(step_t step) {
    peer.step = step;
    peer.since_us = hal_time_us();
    peer.polls = 0;
    peer.quiet = 0;
}

static bool is_out_of_patience(void) {
    uint64_t patience_us = peer.programs ? PROGRAM_PATIENCE_US : PATIENCE_US;
    bool is_late = hal_time_us() - peer.since_us > patience_us && peer.polls > 2 * QUIET_POLLS;
    return is_late || peer.polls > PATIENCE_POLLS;
}

// A program may leave the cursor behind a control character, which takes no place on the screen.
static bool is_at_prompt(void) {
    return peer.output_length > 0 && peer.quiet > QUIET_POLLS && (uint8_t)peer.tail[1] < ' ' &&
           memcmp(peer.tail + 2, "> ", 2) == 0;
}

static void drain(void) {
    bool moving = fuzz_machine_is_moving();
    if (moving && hal_time_us() - peer.since_us < SETTLE_US) {
        return;
    }
    if (moving && peer.step == STEP_DRAIN) {
        stepper_stop();
        start_waiting(STEP_DRAIN_STOP);
        return;
    }
    if (moving) { // braking takes days with some accelerations
        stepper_estop();
        fuzz_machine_rebase();
    }
    fuzz_machine_settle(0);
    peer.step = STEP_END;
}

static void go_on(void) {
    check_input();
    if (peer.inputs == (peer.programs ? PROGRAM_INPUTS : INPUTS)) {
        stepper_hold(false); // or it would never come to its end
        start_waiting(STEP_DRAIN);
        return;
    }
    if (fuzz_random_percent(30) && fuzz_machine_is_moving()) {
        peer.resume_us = hal_time_us() + fuzz_random_below(100000);
    }
    begin_input();
}

// Hands over some of the input: mostly all of it, sometimes in small pieces.
static size_t hand_over(uint8_t *bytes, size_t size) {
    size_t count = peer.input.length - peer.sent;
    count = count < size ? count : size;
    if (fuzz_random_percent(20) && count > 1) {
        count = 1 + fuzz_random_below((unsigned)count);
    }
    memcpy(bytes, peer.input.bytes + peer.sent, count);
    peer.sent += count;
    if (peer.sent == peer.input.length) {
        start_waiting(STEP_WAIT);
    }
    return count;
}

// A key that comes just when the firmware's waiting ends is taken for the end of noise: at random.
static bool is_time_for_exit(void) {
    return is_out_of_patience() && fuzz_random_percent(30);
}

// The next key to leave by what one Ctrl-C does not end: the editor (Esc does, when a question is
// answered), a transfer in the middle of a block; '\0': there is none.
static char next_exit(void) {
    bool edits = find(peer.output, peer.output_length, "EDIT") != NULL; // a function key types it
    bool transfers = find(peer.output, peer.output_length, "XMODEM") != NULL;
    const char *keys = edits       ? "\x1by\x1by"
                       : transfers ? "\x03\x03\x03\x03\x03\x03\x03\x03\x03"
                                   : "";
    return peer.exits < strlen(keys) ? keys[peer.exits++] : '\0';
}

static size_t type(uint8_t *bytes, size_t size) {
    peer.polls++;
    peer.quiet++;
    switch (peer.step) {
    case STEP_SEND:
        if (fuzz_machine_is_moving() && hal_time_us() < peer.resume_us) {
            return 0;
        }
        return hand_over(bytes, size);
    case STEP_WAIT:
        if (is_at_prompt()) {
            go_on();
        } else if (is_out_of_patience()) {
            start_waiting(STEP_BREAK);
            peer.exits = 0;
            bytes[0] = 3;
            return 1;
        }
        return 0;
    case STEP_BREAK:
        if (is_at_prompt()) {
            go_on();
        } else if (is_time_for_exit()) {
            bytes[0] = (uint8_t)next_exit();
            if (bytes[0] == '\0') {
                show_output();
                fuzz_session_fail("no prompt after Ctrl-C");
            }
            peer.since_us = hal_time_us();
            peer.polls = 0;
            return 1;
        }
        return 0;
    case STEP_DRAIN:
    case STEP_DRAIN_STOP:
        drain();
        return 0;
    case STEP_END:
        break;
    }
    return 0;
}

static bool at_end(void) {
    return peer.step == STEP_END;
}

static void receive(const uint8_t *bytes, size_t size) {
    size_t room = OUTPUT_SIZE - peer.output_length;
    size_t kept = size < room ? size : room;
    memcpy(peer.output + peer.output_length, bytes, kept);
    peer.output_length += kept;
    for (size_t i = size > 4 ? size - 4 : 0; i < size; i++) {
        memmove(peer.tail, peer.tail + 1, 3);
        peer.tail[3] = (char)bytes[i];
    }
    peer.quiet = 0;
}

// The firmware leaves by exit(); that it leaves by itself and with code 0 is part of the test.
static void on_exit_check(void) {
    FUZZ_SESSION_CHECK(peer.step == STEP_END, "the firmware left before the end of its input");
}

void fuzz_console_session(bool programs) {
    static const host_console_peer_t console_peer = {type, at_end, receive};
    static char name[] = "stepmite";
    static char option[] = "--virtual";
    static char *arguments[] = {name, option, NULL};
    peer.programs = programs;
    fuzz_machine_watch();
    fuzz_drivers_attach();
    atexit(on_exit_check);
    host_console_attach(&console_peer);
    start_waiting(STEP_WAIT); // for the banner and the first prompt
    optind = 1;               // the driver has used getopt() already
    fuzz_main_entry(2, arguments);
}

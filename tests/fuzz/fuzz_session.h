// A session is one life of the firmware, from power-on, in a process of its own: it starts the same
// every time and can be repeated alone by its seed and number. What it reports lies in memory
// shared with the driver, so that the last input is known even after a crash.
#ifndef FUZZ_SESSION_H
#define FUZZ_SESSION_H

#include <stdbool.h>
#include <stdint.h>

#include "fuzz_text.h"

// Faults that are planted to see that they are caught.
typedef enum {
    FUZZ_PLANT_NONE,
    FUZZ_PLANT_CRASH,         // a write through a null pointer
    FUZZ_PLANT_LOST_STEP,     // an edge does not arrive at the simulated axis
    FUZZ_PLANT_REFUSED_MOVES, // a refused line leaves something in the queue
    FUZZ_PLANT_LONG_ERROR,    // an error message has two lines
    FUZZ_PLANT_HANG,          // an input never ends
    FUZZ_PLANT_DRIVER_WRITE,  // a refused line writes a register of a motor driver
    FUZZ_PLANT_COUNT
} fuzz_plant_t;

// For --plant.
extern const char *const fuzz_session_plant_names[FUZZ_PLANT_COUNT];

typedef struct {
    fuzz_plant_t plant;
    bool show;         // print every input
    uint64_t inputs;   // sent
    uint64_t accepted; // of these, carried out
    uint64_t refused;  // of these, answered with an error
    uint64_t moves;    // of the accepted ones, checked against the model
    uint64_t steps;    // pulses of the simulated axes
    char failure[400]; // what is wrong; "" if nothing is
    fuzz_text_t input; // the last one
} fuzz_session_t;

// The session of this process.
extern fuzz_session_t *fuzz_session;

// Takes note of an input that is about to be sent.
void fuzz_session_input(const fuzz_text_t *input);

// Says, with --show, what else is done to the machine.
void fuzz_session_note(const char *what);

// True if `plant` is to be sown now: once in a session, somewhere in its course.
bool fuzz_session_plant_now(fuzz_plant_t plant);

// Reports what is wrong and ends this process.
_Noreturn void fuzz_session_fail(const char *format, ...) __attribute__((format(printf, 1, 2)));

// Fails unless `condition` holds.
#define FUZZ_SESSION_CHECK(condition, ...)                                                         \
    do {                                                                                           \
        if (!(condition)) {                                                                        \
            fuzz_session_fail(__VA_ARGS__);                                                        \
        }                                                                                          \
    } while (0)

// Prints a piece of input on one line, unprintable bytes as \xNN.
void fuzz_session_print(const char *label, const fuzz_text_t *text);

// The kinds of session; at the prompt, `programs` makes it one of whole programs.
void fuzz_gcode_session(void);
void fuzz_console_session(bool programs);

#endif

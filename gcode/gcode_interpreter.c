// An interpreter of G-code lines: reads, checks, carries out, remembers. A line changes the state
// only when its first entry was taken; what does not fit into the queue waits. Context: main loop.
#include "gcode/gcode_interpreter.h"

#include "gcode/gcode_lexer.h"
#include "gcode/gcode_offsets.h"

// Groups that change nothing but modes that need no summing up.
#define PLAIN_GROUPS                                                                               \
    (1u << GROUP_MOTION | 1u << GROUP_CYCLE_END | 1u << GROUP_PLANE | 1u << GROUP_DISTANCE |       \
     1u << GROUP_CENTRE | 1u << GROUP_FEED_MODE | 1u << GROUP_UNITS | 1u << GROUP_COMPENSATION |   \
     1u << GROUP_RETRACT | 1u << GROUP_PATH | 1u << GROUP_OVERRIDES)

void gcode_interpreter_start(gcode_interpreter_t *interpreter, const gcode_sink_t *sink) {
    *interpreter = (gcode_interpreter_t){.sink = sink};
}

// ---- What waits ---------------------------------------------------------------------------------

// With the error that was raised last, which is told later.
static void give_up(gcode_interpreter_t *in) {
    in->busy = false;
    in->waits = false;
    err_keep(&in->failure);
}

// After a drop the modal state and the spindle may differ, and what waits has lost its sense.
static void follow_drops(gcode_interpreter_t *in) {
    uint32_t drops = in->sink->drops();
    if (drops == in->drops || in->waits) {
        return;
    }
    in->drops = drops;
    gcode_outputs_t now = in->sink->outputs();
    in->state.modal.spindle = (uint8_t)now.spindle;
    in->state.modal.flood = now.flood;
    in->state.modal.mist = now.mist;
    in->busy = false;
}

// True when what the line waits for has ended well.
static bool await_end(gcode_interpreter_t *in) {
    err_t result;
    if (in->waits && in->sink->ended(&result)) {
        in->drops = in->sink->drops(); // it ends its moves by dropping what is left of them
        if (result != ERR_OK) {
            give_up(in);
        }
        in->waits = false;
    }
    return in->busy && !in->waits;
}

static bool has_to_wait(const gcode_entry_t *entry) {
    return entry->kind == ENTRY_HOME || entry->kind == ENTRY_PROBE;
}

// Queues the entries of `pending` one after the other.
static err_t push_pending(gcode_interpreter_t *in) {
    gcode_entry_t entry;
    double from[AXIS_COUNT];
    for (;;) {
        gcode_plan_t next = in->pending;
        bool more;
        in->sink->target(from);
        err_t err = gcode_plan_next(&next, &in->state, from, &entry, &more);
        if (err == ERR_OK && more) {
            err = in->sink->push(&entry);
        }
        if (err != ERR_OK) {
            return err;
        }
        in->pending = next;
        in->begun = true;
        in->busy = more;
        in->waits = more && has_to_wait(&entry);
        in->ended |= more && entry.kind == ENTRY_END;
        if (!more || in->waits) {
            return ERR_OK;
        }
    }
}

void gcode_interpreter_background(gcode_interpreter_t *in) {
    follow_drops(in);
    if (!in->busy || !await_end(in)) {
        return;
    }
    err_t err = push_pending(in);
    bool later = err == ERR_GCODE_BUFFER_FULL || err == ERR_STEPPER_STOPPING; // then it is dropped
    if (err != ERR_OK && !later) {
        give_up(in);
    }
}

err_t gcode_interpreter_failure(gcode_interpreter_t *in) {
    err_t failure = in->failure.code;
    if (failure != ERR_OK) {
        err_put_back(&in->failure);
        in->failure.code = ERR_OK;
    }
    return failure;
}

// ---- Lines --------------------------------------------------------------------------------------

// All entries of the line, in their order, each from where the one before it ends.
static __attribute__((noinline)) err_t check_plan(const gcode_interpreter_t *in,
                                                  const gcode_plan_t *plan,
                                                  const double start[AXIS_COUNT]) {
    gcode_plan_t trial = *plan;
    gcode_entry_t entry;
    double from[AXIS_COUNT] = {start[AXIS_X], start[AXIS_Y], start[AXIS_Z], start[AXIS_A]};
    bool more = true;
    err_t err = ERR_OK;
    while (err == ERR_OK && more) {
        err = gcode_plan_next(&trial, &in->state, from, &entry, &more);
        if (err == ERR_OK && more) {
            err = in->sink->check(&entry, from);
        }
    }
    return err;
}

static void commit(gcode_interpreter_t *in, const line_t *line, const double place[AXIS_COUNT]) {
    if ((line->groups & ~PLAIN_GROUPS) == 0) {
        in->state.modal = line->modal;
    } else {
        gcode_offsets_commit(&in->state, line, place);
    }
}

// A line of several entries, or of one that is no plain move.
static __attribute__((noinline)) err_t carry_out(gcode_interpreter_t *in, const line_t *line,
                                                 uint32_t steps) {
    double place[AXIS_COUNT];
    err_t err = ERR_OK;
    if (gcode_offsets_need_place(line)) {
        err = in->sink->place(place);
    } else {
        in->sink->target(place);
    }
    if (err != ERR_OK) {
        return err;
    }
    gcode_plan_t plan = {.steps = steps, .line = *line};
    err = gcode_plan_begin(&plan, &in->state, place);
    if (err == ERR_OK) {
        err = check_plan(in, &plan, place);
    }
    if (err != ERR_OK) {
        return err;
    }
    in->pending = plan;
    in->begun = false;
    err = push_pending(in);
    if (!in->begun) {
        return err;
    }
    if (err != ERR_OK && err != ERR_GCODE_BUFFER_FULL) {
        give_up(in);
    }
    commit(in, line, place);
    if ((steps & (1u << STEP_CYCLE)) != 0) {
        in->state.cycle = plan.cycle.words;
    }
    return ERR_OK;
}

// One line, arc or probing move.
static err_t carry_out_motion(gcode_interpreter_t *in, const line_t *line) {
    gcode_entry_t entry;
    double from[AXIS_COUNT];
    in->sink->target(from);
    err_t err = gcode_plan_motion(line, &in->state, from, &entry);
    if (err == ERR_OK) {
        err = in->sink->push(&entry);
    }
    if (err == ERR_OK) {
        commit(in, line, from);
    }
    return err;
}

err_t gcode_interpreter_words(gcode_interpreter_t *in, const gcode_word_t *words, size_t count) {
    line_t line;
    follow_drops(in);
    if (in->busy) {
        gcode_interpreter_background(in);
        if (in->busy) {
            return err_raise(ERR_GCODE_BUFFER_FULL, NULL);
        }
    }
    err_t err = gcode_words_read(&line, &in->state, words, count);
    if (err != ERR_OK) {
        return err;
    }
    uint32_t steps = gcode_plan_steps(&line, &in->state);
    if (steps == 1u << STEP_MOTION && !line_is_probe(&line)) {
        return carry_out_motion(in, &line);
    }
    return carry_out(in, &line, steps);
}

err_t gcode_interpreter_line(gcode_interpreter_t *in, const char *text, size_t length) {
    gcode_word_t words[GCODE_WORDS_MAX];
    gcode_lexed_t lexed = {.words = words};
    err_t err = gcode_lexer_split(text, length, &in->state.options, &lexed);
    if (err == ERR_OK) {
        err = gcode_interpreter_words(in, words, lexed.count);
    }
    if (err == ERR_OK && lexed.message_length > 0) {
        in->sink->tell(lexed.message, lexed.message_length);
    }
    return err;
}

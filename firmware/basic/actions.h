// What statements do at run time, called with their arguments on the stack. Context: main loop.
#ifndef BASIC_ACTIONS_H
#define BASIC_ACTIONS_H

#include "basic/basic.h"
#include "value.h"
#include "vm.h"

typedef enum {
#define ACTION(name, function) ACTIONS_##name,
#include "actions.def"
#undef ACTION
    ACTIONS_COUNT
} actions_t;

// `arguments` are the `count` values the compiler left on the stack; they may be changed.
typedef void (*actions_run_t)(value_t *arguments, unsigned count);

#define ACTION(name, function) void function(value_t *arguments, unsigned count);
#include "actions.def"
#undef ACTION

// Indexed by actions_t.
extern const actions_run_t actions_table[ACTIONS_COUNT];

// Takes what CPU RESTART asks first from the configuration (actions_machine.c).
void actions_start(const basic_config_t *config);

// Ends the program or line and says what the prompt is to do then (actions_system.c).
void actions_stop_with(vm_request_t request);

// DATA as READ sees it (actions_data.c).
void actions_data_reset(uint32_t first);

// What OPTION sets, for compiling and running; the numbers stand for themselves in
// actions_option().
enum {
    ACTIONS_OPTION_EXPLICIT,
    ACTIONS_OPTION_DEFAULT,
    ACTIONS_OPTION_BASE,
    ACTIONS_OPTION_ESCAPE,
    ACTIONS_OPTION_ANGLE,
};
enum { ACTIONS_ERROR_ABORT, ACTIONS_ERROR_IGNORE, ACTIONS_ERROR_SKIP, ACTIONS_ERROR_CLEAR };

#endif

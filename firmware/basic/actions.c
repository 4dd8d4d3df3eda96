// The table of actions, made of actions.def. Context: main loop.
#include "actions.h"

const actions_run_t actions_table[ACTIONS_COUNT] = {
#define ACTION(name, function) [ACTIONS_##name] = (function),
#include "actions.def"
#undef ACTION
};

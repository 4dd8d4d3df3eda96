// New entries of the block ring. Inside stepper/ only. Context: main loop.
#ifndef STEPPER_MOVES_H
#define STEPPER_MOVES_H

#include "stepper/planner.h"

// Says where the machine stands; the next move starts there. Ring empty.
void moves_set_position(const int32_t steps[AXIS_COUNT]);

// The end of the last queued move, unrounded, in units.
void moves_target(double target[AXIS_COUNT]);

// Slots that may be filled. One is kept for the blend with the next line, if the last line allows
// one.
uint32_t moves_free(void);

// Puts a move, whose target has been checked, behind all others. A move shorter than half a step of
// each axis is not queued (false): its way is part of the next one.
bool moves_push_line(const stepper_move_t *move, const int32_t target_steps[AXIS_COUNT]);
typedef struct arc arc_t; // stepper/arc.h
bool moves_push_arc(const arc_t *arc, const stepper_move_t *move,
                    const int32_t target_steps[AXIS_COUNT]);
// `lit`: a laser's beam goes on in it, as far as it does not dim.
void moves_push_dwell(uint32_t ticks, bool lit);
void moves_push_pins(const block_pins_t *pins);
void moves_push_pause(void);

#endif

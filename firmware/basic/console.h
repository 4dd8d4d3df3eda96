// The terminal: received bytes in a ring, output in blocks, waiting with the background at work.
// Context: main loop.
#ifndef BASIC_CONSOLE_H
#define BASIC_CONSOLE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

// Told of a control character; true: it has done what it is for and is no input.
typedef bool (*console_control_t)(char c);

// `background` is called whenever the console waits. `on_control` is called inside console_poll(),
// that is from any place that waits, prints or runs statements; NULL: none.
void console_start(void (*background)(void), console_control_t on_control);

// ---- Input --------------------------------------------------------------------------------------

// While a program or a command runs, the break key in the received bytes is not input but a request
// to stop, which also throws away what was typed before it. Other control characters are offered to
// `on_control` at all times, as soon as they come from a terminal and ahead of all input before
// them.
void console_set_running(bool running);

// Which byte (1 to 255) ends a program; 0: none does. Ctrl-C to begin with. At the prompt it is
// always Ctrl-C, whatever this says.
void console_set_break_key(int key);

// True if the byte asks for the end of what is being done: the break key, at the prompt Ctrl-C.
bool console_is_break(int byte);

// While on, every byte is input and none acts by itself: for protocols whose bytes mean something
// else.
void console_set_raw(bool raw);

// While on, every byte is a key for whoever owns the screen. In contrast to raw, notices may come.
void console_set_full_screen(bool on);

// Offers a control character whose turn as input has come; true: it was taken.
bool console_offer_control(int byte);

// Takes in what was received. Cheap if there is nothing.
void console_poll(void);

bool console_break_pending(void);
void console_clear_break(void);

// The next byte, or -1 if there is none.
int console_take(void);

// True if input that came earlier has not been taken yet; does not look for more.
bool console_input_waits(void);

// While something runs, this byte is not input: `pressed` is called as soon as it comes; -1: none.
void console_set_hot_key(int byte, void (*pressed)(void));

// Puts the byte taken last back; at most one.
void console_untake(int byte);

// True if a byte is there.
bool console_has_input(void);

// True, once, if input was thrown away because a program did not read it.
bool console_lost_input(void);

// ---- Output -------------------------------------------------------------------------------------

void console_write(const char *text, size_t length);
void console_print(const char *text);

// "\r\n", and the same only if the cursor is not at the start of a line.
void console_new_line(void);
void console_fresh_line(void);

// The size of the terminal's screen, 24 rows of 80 columns unless something else is said.
void console_set_size(unsigned rows, unsigned columns);
unsigned console_rows(void);
unsigned console_columns(void);

// Column of the next character, from 0.
unsigned console_column(void);

// A sequence just written has put the cursor there.
void console_set_column(unsigned column);

// Sends what can go at once.
void console_send(void);

// Sends what has been gathered. A host that does not read is waited for; Ctrl-C ends the wait and
// the output not sent yet is dropped.
void console_flush(void);

// True while bytes are being taken in or sent, or belong to a protocol: nothing may be printed that
// must not be lost, or that belongs between lines.
bool console_is_busy(void);

// ---- Waiting ------------------------------------------------------------------------------------

// Lets the background work.
void console_background(void);

// Sends pending output, lets the background work and sleeps until something happens or `until_us`.
void console_wait(uint64_t until_us);

// Something has happened that a console_wait() under way must not sleep over.
void console_wake(void);

// In the background: a console_wait() sleeps until this time at the latest. Forgotten at the next
// turn.
void console_wake_at(uint64_t time_us);

#endif

// The errors a user can meet: one list (err.def), one code type, one place for the message.
// A function that can fail returns err_t; whoever detects the fault calls err_raise() with what
// the text wants to know and passes the code up unchanged.
// Context: main loop only. The governor and the tick report through words, never through here.
#ifndef BASE_ERR_H
#define BASE_ERR_H

typedef enum {
    ERR_OK = 0,
#define ERR(name, text) ERR_##name,
#include "base/err.def"
#undef ERR
    ERR_COUNT
} err_t;

// Longest message including its terminating zero; longer ones are cut.
#define ERR_MESSAGE_SIZE 160

// Makes `code` the current error. If its text in err.def has a `%`, the formatted detail takes the
// place of that character; otherwise pass NULL. Returns `code`, so that `return err_raise(...)`
// works.
err_t err_raise(err_t code, const char *detail_format, ...) __attribute__((format(printf, 2, 3)));

// The code of the error raised last.
err_t err_code(void);

// The text of the error raised last, complete with its detail. Valid until the next err_raise().
const char *err_message(void);

// The current error as a whole. Work in the background that may raise errors of its own keeps what
// the statement in the foreground has raised, which may not have been told yet, and puts it back.
typedef struct {
    err_t code;
    char text[ERR_MESSAGE_SIZE];
} err_kept_t;

void err_keep(err_kept_t *kept);
void err_put_back(const err_kept_t *kept);

#endif

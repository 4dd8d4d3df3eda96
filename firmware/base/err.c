// Keeps the one current error message. Context: main loop.
#include "base/err.h"

#include <stdarg.h>
#include <string.h>

#include "base/format.h"

static const char *const err_texts[ERR_COUNT] = {
    [ERR_OK] = "",
#define ERR(name, text) [ERR_##name] = (text),
#include "base/err.def"
#undef ERR
};

static err_t err_now;
static char err_text_now[ERR_MESSAGE_SIZE];

err_t err_raise(err_t code, const char *detail_format, ...) {
    const char *text = err_texts[code];
    err_now = code;
    const char *slot = strchr(text, '%');
    if (slot == NULL) {
        format_text(err_text_now, sizeof err_text_now, "%s", text);
        return code;
    }

    // Formatted apart from the message: a detail may quote the message that stands there now.
    char detail[ERR_MESSAGE_SIZE] = "";
    if (detail_format != NULL) {
        va_list args;
        va_start(args, detail_format);
        format_list(detail, sizeof detail, detail_format, args);
        va_end(args);
    }
    size_t length = format_text(err_text_now, sizeof err_text_now, "%.*s%s%s", (int)(slot - text),
                                text, detail, slot + 1);
    if (length >= sizeof err_text_now) {
        memcpy(err_text_now + sizeof err_text_now - sizeof "...", "...", sizeof "...");
    }
    return code;
}

err_t err_code(void) {
    return err_now;
}

const char *err_message(void) {
    return err_text_now;
}

void err_keep(err_kept_t *kept) {
    kept->code = err_now;
    strcpy(kept->text, err_text_now); // most are short
}

void err_put_back(const err_kept_t *kept) {
    err_now = kept->code;
    strcpy(err_text_now, kept->text);
}

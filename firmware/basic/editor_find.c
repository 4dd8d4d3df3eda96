// Find and replace. Case does not matter; behind the end of the text it goes on at its start.
// Context: main loop.
#include "editor_find.h"

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#include "base/base.h"
#include "console.h"
#include "editor_ask.h"
#include "editor_cursor.h"
#include "editor_text.h"
#include "editor_view.h"
#include "keys.h"

#define FIND_SIZE 41

static struct {
    char wanted[FIND_SIZE];
    char replacement[FIND_SIZE];
} find;

static bool is_at(size_t place) {
    size_t i = 0;
    while (find.wanted[i] != '\0' &&
           letters_upper(editor_text_at(place + i)) == letters_upper(find.wanted[i])) {
        i++;
    }
    return find.wanted[i] == '\0';
}

// The first place from `place` up to `end` where the text begins; SIZE_MAX: nowhere.
static size_t search(size_t place, size_t end) {
    for (; place < end; place++) {
        if (is_at(place)) {
            return place;
        }
    }
    return SIZE_MAX;
}

void editor_find_next(void) {
    if (find.wanted[0] == '\0') {
        editor_find();
        return;
    }
    size_t length = editor_text_length();
    size_t place = search(editor_cursor.place + 1, length);
    if (place == SIZE_MAX) {
        place = search(0, editor_cursor.place + 1 < length ? editor_cursor.place + 1 : length);
        if (place != SIZE_MAX) {
            editor_view_message("From the start again");
        }
    }
    if (place == SIZE_MAX) {
        editor_view_message("Not found: %s", find.wanted);
        return;
    }
    editor_cursor_go(place);
}

void editor_find(void) {
    if (editor_ask_text("Find:", find.wanted, sizeof find.wanted, KEYS_F3)) {
        editor_find_next();
    }
}

// ---- Replace ------------------------------------------------------------------------------------

static bool replace_here(void) {
    if (editor_text_room() < strlen(find.replacement)) {
        editor_view_message("Not enough memory");
        return false;
    }
    editor_cursor_erase(editor_cursor.place, strlen(find.wanted));
    return editor_cursor_insert(find.replacement, strlen(find.replacement));
}

// Asks about the place the cursor is at, which is shown as marked.
static char ask_here(void) {
    editor_cursor.anchor = editor_cursor.place + strlen(find.wanted);
    editor_cursor.marking = true;
    editor_view_draw();
    char answer = editor_ask_key("Replace it? Y(es) N(o) A(ll that follow) ESC", "YNA");
    editor_cursor.marking = false;
    return answer;
}

// From the cursor to the end of the text. Returns how often it was replaced.
static unsigned replace_from_cursor(void) {
    unsigned count = 0;
    char answer = 'N';
    for (;;) {
        size_t place = search(editor_cursor.place, editor_text_length());
        if (place == SIZE_MAX) {
            return count;
        }
        editor_cursor_go(place);
        answer = answer == 'A' ? 'A' : ask_here();
        if (answer == '\0') {
            return count;
        }
        if (answer == 'N') {
            editor_cursor_go(place + 1);
        } else if (replace_here()) {
            count++;
        } else {
            return count;
        }
        console_background();
    }
}

void editor_find_replace(void) {
    if (editor_ask_text("Replace:", find.wanted, sizeof find.wanted, KEYS_F3) &&
        editor_ask_text("by:", find.replacement, sizeof find.replacement, KEYS_RETURN)) {
        editor_view_message("Replaced %u times", replace_from_cursor());
    }
}

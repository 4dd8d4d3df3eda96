// Reads the corpus. \xNN in a line stands for that byte.
#include "fuzz_corpus.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fuzz_random.h"

#define LINES_MAX 2000

static const char *const file_names[FUZZ_CORPUS_COUNT] = {"gcode.txt", "console.txt"};

static struct {
    char *lines[LINES_MAX];
    unsigned count;
} corpora[FUZZ_CORPUS_COUNT];

static bool load_file(const char *directory, fuzz_corpus_kind_t kind) {
    char path[512];
    snprintf(path, sizeof path, "%s/%s", directory, file_names[kind]);
    FILE *file = fopen(path, "r");
    if (file == NULL) {
        fprintf(stderr, "fuzz: %s: %s\n", path, strerror(errno));
        return false;
    }
    char *line = NULL;
    size_t size = 0;
    while (getline(&line, &size, file) >= 0 && corpora[kind].count < LINES_MAX) {
        line[strcspn(line, "\n")] = '\0';
        corpora[kind].lines[corpora[kind].count++] = line;
        line = NULL; // the next line gets its own memory
    }
    free(line);
    fclose(file);
    if (corpora[kind].count == 0) {
        fprintf(stderr, "fuzz: %s is empty\n", path);
    }
    return corpora[kind].count > 0;
}

bool fuzz_corpus_load(const char *directory) {
    return load_file(directory, FUZZ_CORPUS_GCODE) && load_file(directory, FUZZ_CORPUS_CONSOLE);
}

void fuzz_corpus_pick(fuzz_corpus_kind_t kind, fuzz_text_t *text) {
    for (const char *p = corpora[kind].lines[fuzz_random_below(corpora[kind].count)]; *p != '\0';
         p++) {
        unsigned byte;
        if (sscanf(p, "\\x%2x", &byte) == 1) {
            fuzz_text_byte(text, (char)byte);
            p += 3;
        } else {
            fuzz_text_byte(text, *p);
        }
    }
}

// Helpers of the host port's tests.
#include "fixture.h"

#include <stdio.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include "hal/hal.h"

#define FILES_MAX 32

fixture_core_t fixture_core;

void hal_on_tick(void) {
    if (fixture_core.on_tick != NULL) {
        fixture_core.on_tick();
    }
}

void hal_on_governor(void) {
    if (fixture_core.on_governor != NULL) {
        fixture_core.on_governor();
    }
}

bool hal_on_storage_begin(void) {
    return !hal_tick_running();
}

void hal_on_storage_end(void) {}

void fixture_reset(void) {
    hal_tick_stop();
    fixture_core = (fixture_core_t){NULL, NULL};
    hal_governor_unlock();
}

static _Noreturn void give_up(const char *what) {
    perror(what);
    exit(99);
}

static char directory[] = "/tmp/stepmite-test-XXXXXX";

static struct {
    char paths[FILES_MAX][64];
    unsigned count;
    pid_t owner; // a forked child must not clean up
} files;

static void remove_files(void) {
    if (getpid() == files.owner) {
        for (unsigned i = 0; i < files.count; i++) {
            unlink(files.paths[i]);
        }
        rmdir(directory);
    }
}

const char *fixture_file(const char *name, const void *bytes, size_t size) {
    if (files.count == 0) {
        files.owner = getpid();
        if (mkdtemp(directory) == NULL || atexit(remove_files) != 0) {
            give_up(directory);
        }
    }
    char *path = files.paths[files.count++];
    snprintf(path, sizeof files.paths[0], "%s/%s", directory, name);
    FILE *file = files.count < FILES_MAX ? fopen(path, "wb") : NULL;
    if (file == NULL || fwrite(bytes, 1, size, file) != size || fclose(file) != 0) {
        give_up(path);
    }
    return path;
}

size_t fixture_read(const char *path, char *buffer, size_t size) {
    FILE *file = fopen(path, "rb");
    if (file == NULL) {
        give_up(path);
    }
    size_t got = fread(buffer, 1, size - 1, file);
    buffer[got] = '\0';
    fclose(file);
    return got;
}

int fixture_exit_code(void (*action)(void *), void *argument, char *message, size_t size) {
    int ends[2];
    fflush(NULL);
    if (pipe(ends) != 0) {
        give_up("pipe");
    }
    pid_t child = fork();
    if (child == 0) {
        dup2(ends[1], STDERR_FILENO);
        close(ends[0]);
        close(ends[1]);
        action(argument);
        _exit(0);
    }
    close(ends[1]);
    size_t used = 0;
    ssize_t got;
    while (used < size - 1 && (got = read(ends[0], message + used, size - 1 - used)) > 0) {
        used += (size_t)got;
    }
    message[used] = '\0';
    close(ends[0]);
    int status = 0;
    waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

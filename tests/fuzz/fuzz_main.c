// The fuzz driver: runs session after session, each in a process of its own, until one fails. Same
// seed, same inputs, on every machine; time is virtual. See --help.
#include <errno.h>
#include <getopt.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "fuzz_corpus.h"
#include "fuzz_random.h"
#include "fuzz_session.h"

#define WATCHDOG_S 120 // wall time after which a session counts as hung

static const char help[] =
    "usage: stepmite_fuzz [--runs N | --seconds N] [--seed N] [--session N] [--target "
    "console|program|gcode|all]\n"
    "                     [--corpus DIR] [--plant FAULT] [--watchdog SECONDS] [--show]\n"
    "\n"
    "Feeds generated and spoiled input to the firmware and checks after each input what must "
    "hold.\n"
    "  --runs N         sessions to run (default 20)\n"
    "  --seconds N      run sessions for this long instead\n"
    "  --seed N         start of the random numbers (default 1)\n"
    "  --session N      run this session only, to repeat one that failed\n"
    "  --target WHAT    the prompt, whole programs, the G-code reader, or all in turn (default)\n"
    "  --corpus DIR     seed inputs, gcode.txt and console.txt\n"
    "  --plant FAULT    plant a fault that has to be found\n"
    "  --watchdog N     seconds after which a session counts as hung (default 120)\n"
    "  --show           print every input\n";

// In the order in which they take turns.
typedef enum { TARGET_GCODE, TARGET_CONSOLE, TARGET_PROGRAM, TARGET_COUNT } target_t;

static const char *const target_names[] = {"gcode", "console", "program", "all"};

static struct {
    unsigned runs;
    unsigned seconds; // 0: count runs
    uint64_t seed;
    int session; // -1: all
    target_t target;
    const char *corpus;
    unsigned watchdog_s;
} options = {.runs = 20,
             .seed = 1,
             .session = -1,
             .target = TARGET_COUNT,
             .corpus = FUZZ_CORPUS_DIRECTORY,
             .watchdog_s = WATCHDOG_S};

static _Noreturn void leave_with_usage(const char *fault) {
    fprintf(stderr, "fuzz: %s\n%s", fault, help);
    exit(2);
}

static uint64_t number(const char *text) {
    char *end;
    errno = 0;
    uint64_t value = strtoull(text, &end, 0);
    if (errno != 0 || *end != '\0' || end == text) {
        leave_with_usage("not a number");
    }
    return value;
}

static target_t target_of(const char *name) {
    for (target_t target = 0; target <= TARGET_COUNT; target++) {
        if (strcmp(name, target_names[target]) == 0) {
            return target;
        }
    }
    leave_with_usage("unknown target");
}

static fuzz_plant_t plant_of(const char *name) {
    for (fuzz_plant_t plant = 0; plant < FUZZ_PLANT_COUNT; plant++) {
        if (strcmp(name, fuzz_session_plant_names[plant]) == 0) {
            return plant;
        }
    }
    leave_with_usage("unknown fault");
}

static void set_option(int letter, const char *value) {
    switch (letter) {
    case 'r':
        options.runs = (unsigned)number(value);
        break;
    case 's':
        options.seconds = (unsigned)number(value);
        break;
    case 'S':
        options.seed = number(value);
        break;
    case 'n':
        options.session = (int)number(value);
        break;
    case 't':
        options.target = target_of(value);
        break;
    case 'c':
        options.corpus = value;
        break;
    case 'p':
        fuzz_session->plant = plant_of(value);
        break;
    case 'w':
        options.watchdog_s = (unsigned)number(value);
        break;
    case 'v':
        fuzz_session->show = true;
        break;
    case 'h':
        fputs(help, stdout);
        exit(0);
    default:
        leave_with_usage("unknown option");
    }
}

static void parse_options(int argc, char **argv) {
    static const struct option table[] = {
        {"runs", required_argument, NULL, 'r'},
        {"seconds", required_argument, NULL, 's'},
        {"seed", required_argument, NULL, 'S'},
        {"session", required_argument, NULL, 'n'},
        {"target", required_argument, NULL, 't'},
        {"corpus", required_argument, NULL, 'c'},
        {"plant", required_argument, NULL, 'p'},
        {"watchdog", required_argument, NULL, 'w'},
        {"show", no_argument, NULL, 'v'},
        {"help", no_argument, NULL, 'h'},
        {NULL, 0, NULL, 0},
    };
    int letter;
    while ((letter = getopt_long(argc, argv, "", table, NULL)) != -1) {
        set_option(letter, optarg);
    }
    if (optind < argc) {
        leave_with_usage("too many arguments");
    }
}

static target_t target_at(int session) {
    return options.target == TARGET_COUNT ? (target_t)(session % TARGET_COUNT) : options.target;
}

// In the child: one life of the firmware.
static _Noreturn void live(int session) {
    alarm(options.watchdog_s); // ends the process, which the parent sees
    fuzz_random_seed(options.seed * 1000003u + (uint64_t)session);
    target_t target = target_at(session);
    if (target == TARGET_GCODE) {
        fuzz_gcode_session();
    } else {
        fuzz_console_session(target == TARGET_PROGRAM);
    }
    fflush(stdout);
    _exit(0);
}

// Says how a session ended that did not end well.
static void report(int session, int status) {
    printf("FAILED: session %d, seed %llu: ", session, (unsigned long long)options.seed);
    if (fuzz_session->failure[0] != '\0') {
        printf("%s\n", fuzz_session->failure);
    } else if (WIFSIGNALED(status) && WTERMSIG(status) == SIGALRM) {
        printf("hung: no end after %u s\n", options.watchdog_s);
    } else if (WIFSIGNALED(status)) {
        printf("crashed: %s\n", strsignal(WTERMSIG(status)));
    } else {
        printf("ended with code %d\n", WEXITSTATUS(status));
    }
    fuzz_session_print("last input", &fuzz_session->input);
    printf("repeat with: stepmite_fuzz --target %s --seed %llu --session %d --show\n",
           target_names[target_at(session)], (unsigned long long)options.seed, session);
}

static bool run_session(int session) {
    fflush(stdout);
    fuzz_session->failure[0] = '\0';
    fuzz_session->input.length = 0;
    pid_t child = fork();
    if (child < 0) {
        perror("fuzz: fork");
        exit(2);
    }
    if (child == 0) {
        live(session);
    }
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    if (status != 0) {
        report(session, status);
    }
    return status == 0;
}

// Rubbish alone proves little: most of a run must have got through to the machine.
static bool is_substantial(void) {
    return fuzz_session->accepted > 0 && fuzz_session->refused > 0 && fuzz_session->moves > 0 &&
           fuzz_session->steps > 0;
}

int main(int argc, char **argv) {
    fuzz_session =
        mmap(NULL, sizeof *fuzz_session, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (fuzz_session == MAP_FAILED) {
        perror("fuzz: mmap");
        return 2;
    }
    parse_options(argc, argv);
    if (!fuzz_corpus_load(options.corpus)) {
        return 2;
    }
    time_t end = time(NULL) + (time_t)options.seconds;
    int session = options.session >= 0 ? options.session : 0;
    int done = 0;
    bool more = true;
    while (more) {
        if (!run_session(session)) {
            return 1;
        }
        done++;
        session++;
        more = options.session < 0 &&
               (options.seconds > 0 ? time(NULL) < end : done < (int)options.runs);
    }
    printf(
        "%d sessions, %llu inputs: %llu accepted, %llu refused; %llu moves checked, %llu steps\n",
        done, (unsigned long long)fuzz_session->inputs, (unsigned long long)fuzz_session->accepted,
        (unsigned long long)fuzz_session->refused, (unsigned long long)fuzz_session->moves,
        (unsigned long long)fuzz_session->steps);
    if (!is_substantial()) {
        printf("FAILED: nothing was accepted, or nothing refused, or nothing moved\n");
        return 1;
    }
    return 0;
}

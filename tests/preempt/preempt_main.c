// Runs many sessions and says what was wrong in the first that failed. See --help.
#include <getopt.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include "preempt.h"
#include "session.h"

#define WATCHDOG_S 20 // wall time after which a session counts as hung

static const char help[] =
    "usage: stepmite_preempt [--runs N] [--first N] [--unlocked FUNCTION]\n"
    "\n"
    "Short lives of the machine, with interrupts at random places of its code.\n"
    "  --runs N             how many (default 1000)\n"
    "  --first N            number of the first, to repeat one that failed (default 1)\n"
    "  --unlocked FUNCTION  plant a race: this function does not lock the governor\n";

static struct {
    uint64_t runs, first;
} options = {.runs = 1000, .first = 1};

static void parse_options(int argc, char **argv) {
    static const struct option table[] = {
        {"runs", required_argument, NULL, 'r'},
        {"first", required_argument, NULL, 'f'},
        {"unlocked", required_argument, NULL, 'u'},
        {"help", no_argument, NULL, 'h'},
        {NULL, 0, NULL, 0},
    };
    int letter;
    while ((letter = getopt_long(argc, argv, "", table, NULL)) != -1) {
        switch (letter) {
        case 'r':
            options.runs = strtoull(optarg, NULL, 10);
            break;
        case 'f':
            options.first = strtoull(optarg, NULL, 10);
            break;
        case 'u':
            preempt_plant_unlocked(optarg);
            break;
        case 'h':
            fputs(help, stdout);
            exit(0);
        default:
            fputs(help, stderr);
            exit(2);
        }
    }
}

static struct {
    session_counts_t session;
    preempt_counts_t preempt;
} *totals; // shared by all processes

static void live(uint64_t seed) {
    alarm(WATCHDOG_S);
    session_start();
    session_run(seed);
    const uint64_t *from = (const uint64_t *)&session_counts;
    uint64_t *to = (uint64_t *)&totals->session;
    for (size_t i = 0; i < sizeof session_counts / sizeof *from; i++) {
        to[i] += from[i];
    }
    totals->preempt.in_main += preempt_counts.in_main;
    totals->preempt.in_locked += preempt_counts.in_locked;
    totals->preempt.in_governor += preempt_counts.in_governor;
    fflush(stdout);
    _exit(0);
}

// Each session in a process of its own: it can be repeated alone, and a race may leave anything
// behind.
static bool run_session(uint64_t seed) {
    fflush(stdout);
    pid_t child = fork();
    if (child == 0) {
        live(seed);
    }
    int status = 0;
    if (child < 0 || waitpid(child, &status, 0) < 0) {
        perror("stepmite_preempt");
        exit(2);
    }
    if (WIFSIGNALED(status)) {
        printf("FAILED: run %llu: %s\n", (unsigned long long)seed,
               WTERMSIG(status) == SIGALRM ? "it does not end" : strsignal(WTERMSIG(status)));
    }
    return status == 0;
}

int main(int argc, char **argv) {
    parse_options(argc, argv);
    totals = mmap(NULL, sizeof *totals, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (totals == MAP_FAILED) {
        perror("stepmite_preempt");
        return 2;
    }
    for (uint64_t i = 0; i < options.runs; i++) {
        if (!run_session(options.first + i)) {
            return 1;
        }
    }
    printf("%llu runs, %llu lines, %llu refused, %llu moves, %llu steps, %llu stops, %llu holds,\n"
           "%llu positions; interrupts: %llu in main, %llu locked, %llu in the governor\n",
           (unsigned long long)options.runs, (unsigned long long)totals->session.lines,
           (unsigned long long)totals->session.operations.refused,
           (unsigned long long)totals->session.operations.moves,
           (unsigned long long)totals->session.steps,
           (unsigned long long)totals->session.operations.stops,
           (unsigned long long)totals->session.operations.holds,
           (unsigned long long)totals->session.positions,
           (unsigned long long)totals->preempt.in_main,
           (unsigned long long)totals->preempt.in_locked,
           (unsigned long long)totals->preempt.in_governor);
    return 0;
}

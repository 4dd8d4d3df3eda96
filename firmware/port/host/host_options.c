// Reads the command line and the BASIC program named there. Context: main.
#include "host_options.h"

#include <errno.h>
#include <fcntl.h>
#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "hal/hal.h"
#include "host_system.h"
#include "version.h"

#define PROGRAM_SIZE_MAX (16L * 1024 * 1024) // far beyond what the interpreter takes

static const char usage[] =
    "usage: stepmite [--trace EDGES.csv] [--inputs EVENTS.csv] [--machine MACHINE.txt]\n"
    "                [--machine-report REPORT.jsonl]\n"
    "                [--flash IMAGE] [--flash-cut N[,before|,torn|,after]]\n"
    "                [--virtual|--realtime] [--help] [--version] [FILE.bas]\n";

static const char help[] =
    "\n"
    "StepMite, the motion controller, as a program on this computer: the same firmware with\n"
    "simulated pins. With FILE.bas that BASIC program is run, and the exit code is 0, or 1 after\n"
    "an error in it; without, the prompt is on stdin and stdout. At the end of input or program "
    "it\n"
    "waits until motion has ended, then leaves.\n"
    "\n"
    "  --trace EDGES.csv    write every edge of every output pin: time_ns,gpio,level\n"
    "  --inputs EVENTS.csv  edges to apply to input pins, same columns, times from the start;\n"
    "                       a level may be a voltage (1.65V), and gpio TEMP with 25.5C\n"
    "  --machine FILE       simulate axes at the step and direction pins, the limit switches\n"
    "                       they press, TMC2209 drivers: docs/user-guide.md has the format\n"
    "  --machine-report FILE\n"
    "                       write what the drivers are told and answer, and in the last line\n"
    "                       how axes and drivers are at the end\n"
    "  --flash IMAGE        keep the flash storage in this file; it is made if it is missing\n"
    "  --flash-cut N        cut the power at the Nth flash write: before it, after it, or in the\n"
    "                       middle (torn, the default); leaves at once with code 3\n"
    "  --virtual            time jumps to the next event instead of passing\n"
    "  --realtime           time passes as on a board; the default if stdin and stdout are a "
    "terminal\n"
    "  --help, --version    print this, or the version, and leave\n"
    "\n"
    "Keys on a terminal: Ctrl-C goes to the firmware, Ctrl-D ends the input, Ctrl-\\ quits at "
    "once.\n"
    "Exit codes: 0, 1 BASIC error, 2 wrong usage or unusable file, 4 CPU RESTART, 5 WATCHDOG,\n"
    "128 + n ended by signal n.\n";

enum {
    OPTION_TRACE = 256,
    OPTION_INPUTS,
    OPTION_MACHINE,
    OPTION_MACHINE_REPORT,
    OPTION_FLASH,
    OPTION_FLASH_CUT,
    OPTION_VIRTUAL,
    OPTION_REALTIME,
    OPTION_HELP,
    OPTION_VERSION
};

static const struct option long_options[] = {
    {"trace", required_argument, NULL, OPTION_TRACE},
    {"inputs", required_argument, NULL, OPTION_INPUTS},
    {"machine", required_argument, NULL, OPTION_MACHINE},
    {"machine-report", required_argument, NULL, OPTION_MACHINE_REPORT},
    {"flash", required_argument, NULL, OPTION_FLASH},
    {"flash-cut", required_argument, NULL, OPTION_FLASH_CUT},
    {"virtual", no_argument, NULL, OPTION_VIRTUAL},
    {"realtime", no_argument, NULL, OPTION_REALTIME},
    {"help", no_argument, NULL, OPTION_HELP},
    {"version", no_argument, NULL, OPTION_VERSION},
    {NULL, 0, NULL, 0},
};

static host_options_t options;
static char *program;
static size_t program_length;

// getopt_long() has written what is wrong already.
static _Noreturn void leave_with_usage(void) {
    fputs(usage, stderr);
    exit(HOST_SYSTEM_EXIT_USAGE);
}

// \r\n and \r become \n.
static void unify_line_ends(void) {
    size_t used = 0;
    for (size_t i = 0; i < program_length; i++) {
        bool pair = program[i] == '\r' && i + 1 < program_length && program[i + 1] == '\n';
        if (!pair) {
            program[used++] = program[i] == '\r' ? '\n' : program[i];
        }
    }
    program_length = used;
}

static void read_program(const char *path) {
    int file = open(path, O_RDONLY | O_CLOEXEC);
    if (file < 0) {
        host_system_fail("%s: %s", path, strerror(errno));
    }
    struct stat status;
    if (fstat(file, &status) == 0 && S_ISREG(status.st_mode) && status.st_size > PROGRAM_SIZE_MAX) {
        host_system_fail("%s: too long for a program (%lld bytes)", path,
                         (long long)status.st_size);
    }
    size_t capacity = 0;
    ssize_t got = 1;
    while (got > 0) { // not by the file's size: a pipe has none
        if (program_length == capacity) {
            capacity = capacity * 2 + 4096;
            program = capacity <= 2 * PROGRAM_SIZE_MAX ? realloc(program, capacity) : NULL;
            if (program == NULL) {
                host_system_fail("%s: too long for a program", path);
            }
        }
        got = read(file, program + program_length, capacity - program_length);
        if (got < 0) {
            host_system_fail("%s: %s", path, strerror(errno));
        }
        program_length += (size_t)got;
    }
    close(file);
    unify_line_ends();
}

// N, or N and how.
static void read_flash_cut(const char *text) {
    static const char *const kinds[] = {"before", "torn", "after"};
    char *behind;
    unsigned long count = strtoul(text, &behind, 10);
    unsigned kind = HOST_STORAGE_CUT_TORN;
    if (*behind == ',') {
        for (kind = 0; kind < COUNT_OF_ARRAY(kinds) && strcmp(behind + 1, kinds[kind]) != 0;) {
            kind++;
        }
        behind = "";
    }
    if (count == 0 || count > UINT32_MAX || *behind != '\0' || kind == COUNT_OF_ARRAY(kinds)) {
        fprintf(stderr, "stepmite: --flash-cut: '%s' is no number of a write\n", text);
        leave_with_usage();
    }
    options.flash_cut = (unsigned)count;
    options.flash_cut_kind = (host_storage_cut_t)kind;
}

// Default: somebody sits there and watches, or a program does not want to wait.
static void choose_mode(bool want_virtual, bool want_realtime) {
    if (want_virtual && want_realtime) {
        fputs("stepmite: --virtual and --realtime exclude each other\n", stderr);
        leave_with_usage();
    }
    bool at_terminal = isatty(STDIN_FILENO) && isatty(STDOUT_FILENO);
    options.realtime = want_realtime || (!want_virtual && at_terminal);
}

const host_options_t *host_options_parse(int argc, char **argv) {
    bool want_virtual = false;
    bool want_realtime = false;
    int option;
    while ((option = getopt_long(argc, argv, "", long_options, NULL)) != -1) {
        switch (option) {
        case OPTION_TRACE:
            options.trace_path = optarg;
            break;
        case OPTION_INPUTS:
            options.inputs_path = optarg;
            break;
        case OPTION_MACHINE:
            options.machine_path = optarg;
            break;
        case OPTION_MACHINE_REPORT:
            options.report_path = optarg;
            break;
        case OPTION_FLASH:
            options.flash_path = optarg;
            break;
        case OPTION_FLASH_CUT:
            read_flash_cut(optarg);
            break;
        case OPTION_VIRTUAL:
            want_virtual = true;
            break;
        case OPTION_REALTIME:
            want_realtime = true;
            break;
        case OPTION_HELP:
            printf("%s%s", usage, help);
            exit(0);
        case OPTION_VERSION:
            printf("stepmite %s\n", STEPMITE_VERSION);
            exit(0);
        default:
            leave_with_usage();
        }
    }
    if (argc - optind > 1) {
        fprintf(stderr, "stepmite: one program only: %s is one too many\n", argv[optind + 1]);
        leave_with_usage();
    }
    choose_mode(want_virtual, want_realtime);
    if (optind < argc) {
        options.program_path = argv[optind];
        read_program(options.program_path);
    }
    return &options;
}

const char *hal_startup_program(size_t *length) {
    *length = program_length;
    return program;
}

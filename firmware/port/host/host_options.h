// The command line of the host program. Context: main.
#ifndef HOST_OPTIONS_H
#define HOST_OPTIONS_H

#include <stdbool.h>

#include "host_storage.h"

typedef struct {
    const char *trace_path;   // NULL: edges are not recorded
    const char *inputs_path;  // NULL: no input events
    const char *machine_path; // NULL: nothing hangs at the pins
    const char *report_path;  // NULL: nobody asks what became of the machine
    const char *flash_path;   // NULL: storage is forgotten at exit
    unsigned flash_cut;       // cut the power at this flash write; 0: never
    host_storage_cut_t flash_cut_kind;
    const char *program_path; // NULL: the prompt is on the console
    bool realtime;            // virtual time follows wall time
} host_options_t;

// Reads the options and the program file. Leaves the program with a message if they are wrong, and
// after --help and --version. The result stays valid.
const host_options_t *host_options_parse(int argc, char **argv);

#endif

// A simulated machine, read from a file: axes that the step and direction pins move, and the
// switches they press.
#ifndef HOST_MACHINE_H
#define HOST_MACHINE_H

// Reads the file and attaches what it describes (docs/user-guide.md has the format). Leaves the
// program with file, line and reason if a line is wrong. Context: main, before time moves.
void host_machine_load(const char *path);

#endif

// The firmware's main(), which this program has under another name (see CMakeLists.txt).
#ifndef FUZZ_MAIN_ENTRY_H
#define FUZZ_MAIN_ENTRY_H

int fuzz_main_entry(int argc, char **argv);

#endif

// The simulated flash storage: in memory, and in a file if one was given. Context: main.
#ifndef HOST_STORAGE_H
#define HOST_STORAGE_H

// Takes the contents from the file and keeps it up to date from now on. A file that is missing or
// empty is made, all erased; one of a firmware without files is lengthened. Leaves the program with
// a message if the file has another size, cannot be written or is in use by another stepmite.
void host_storage_open(const char *path);

// What the write in which the power goes leaves behind: nothing of it, a part of its bits, all of
// it.
typedef enum {
    HOST_STORAGE_CUT_BEFORE,
    HOST_STORAGE_CUT_TORN,
    HOST_STORAGE_CUT_AFTER
} host_storage_cut_t;

#define HOST_STORAGE_EXIT_CUT 3

// Cuts the power at the `writes`th write (an erase or a page) from now on: the program leaves at
// once with this code.
void host_storage_cut(unsigned writes, host_storage_cut_t cut);

#endif

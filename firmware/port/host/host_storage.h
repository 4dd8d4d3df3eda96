// The simulated flash storage: in memory, and in a file if one was given. Context: main.
#ifndef HOST_STORAGE_H
#define HOST_STORAGE_H

// Takes the contents from the file and keeps it up to date from now on. A file that is missing or
// empty is made, all erased. Leaves the program with a message if the file has another size, cannot
// be written or is in use by another stepmite.
void host_storage_open(const char *path);

#endif

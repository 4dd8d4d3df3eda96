// What happens to the simulated drivers, for whoever looks at it afterwards: a file of one JSON
// object a line. Each datagram that a driver takes and each change of its DIAG is one; the last
// line has the axes and the drivers with their registers, as they are at the end.
// docs/user-guide.md has the keys.
#ifndef HOST_REPORT_H
#define HOST_REPORT_H

// Leaves the program if the file cannot be made. Context: main, behind host_machine_load().
void host_report_open(const char *path);

// Writes the last line and closes the file. No effect if none is open.
void host_report_close(void);

#endif

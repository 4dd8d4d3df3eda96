// Probing in a session: the plate is touched at any access to memory. Context: main loop.
#ifndef PROBES_H
#define PROBES_H

// From rest, armed and not held: probes, and checks the place.
void probes_do_one(void);

#endif

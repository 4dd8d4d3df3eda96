// Probing and homing in a session: the input changes at any access to memory. Context: main loop.
#ifndef PROBES_H
#define PROBES_H

// From rest, armed and not held: probes, and checks the place.
void probes_do_one(void);

// From rest and not held: homes Y as against a stall, and checks that motion has ended at once.
// The machine is at home then, and so is the watcher.
void probes_home_one(void);

#endif

// Exchanges over a serial wire, as test_rp2_wire.py asks for them. Context: main.
#ifndef WIRE_CHECK_H
#define WIRE_CHECK_H

// Carries a line out, numbers with a space between them, and returns what came of it:
//   o TX RX BAUD                  opens a wire
//   c TX RX BAUD                  closes it
//   e TX RX BAUD REPLY BYTE...    an exchange with so many bytes of reply: "STATE POLLS BYTE..."
//   a US TX RX BAUD REPLY BYTE... one that is given up after so many microseconds
const char *wire_check(const char *line);

#endif

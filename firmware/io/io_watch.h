// Inputs whose edges are told. Inside firmware/io only. Context: main loop.
#ifndef IO_IO_WATCH_H
#define IO_IO_WATCH_H

void io_watch_stop(unsigned gpio);

#endif

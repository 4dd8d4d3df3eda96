// One alarm for all that is to happen at a time. Inside firmware/io only.
#ifndef IO_IO_ALARM_H
#define IO_IO_ALARM_H

// Sets the alarm for what is due next. Context: main with the alarm locked.
void io_alarm_update(void);

#endif

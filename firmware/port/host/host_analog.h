// The simulated voltages. Context: main.
#ifndef HOST_ANALOG_H
#define HOST_ANALOG_H

// The outside world puts a voltage on a pin; from 1.65 V on its level is high.
void host_analog_set_volts(unsigned gpio, double volts);

// The chip's temperature; 25 degrees at the start.
void host_analog_set_temperature(double celsius);

#endif

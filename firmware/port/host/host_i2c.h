// Devices at the simulated I2C buses; each bus has its own. Context: main.
#ifndef HOST_I2C_H
#define HOST_I2C_H

#include <stdbool.h>
#include <stdint.h>

// A transfer with a device, as it sees it: its address, then bytes, then a stop. `port` is
// that of the bus.
typedef struct {
    uint16_t address;
    bool ten_bits;
    bool never_ends;                                           // it holds the clock
    bool (*acknowledges)(unsigned port);                       // is it ready? NULL: always
    bool (*take)(unsigned port, unsigned index, uint8_t byte); // false: not acknowledged
    uint8_t (*give)(unsigned port);
    void (*stop)(unsigned port, uint64_t now_ns); // not if the master keeps the bus
} host_i2c_device_t;

// The device that answers to an address; NULL: none.
const host_i2c_device_t *host_i2c_device(uint16_t address, bool ten_bits);

#endif

// I2C buses with simulated devices: a transfer takes the time that its bits take on the wire.
// Context: main.
#include "host_i2c.h"

#include "hal/hal_i2c.h"
#include "host_clock.h"

#define BYTE_CLOCKS 9u // with the acknowledge
#define EDGE_CLOCKS 2u // start and stop

static struct {
    uint32_t clock_ns;
    uint64_t ends_ns; // of the transfer under way
    hal_i2c_state_t outcome;
} ports[HAL_I2C_PORTS];

void hal_i2c_open(unsigned port, unsigned sda_gpio, unsigned scl_gpio, uint32_t khz) {
    (void)sda_gpio;
    (void)scl_gpio;
    ports[port].clock_ns = 1000000u / khz;
}

void hal_i2c_close(unsigned port) {
    ports[port].clock_ns = 0;
}

// Exchanges the bytes at once. Returns how many were on the wire, that which was refused included.
static unsigned exchange(unsigned port, const host_i2c_device_t *device,
                         const hal_i2c_transfer_t *transfer) {
    for (unsigned i = 0; i < transfer->size; i++) {
        if (transfer->send == NULL) {
            transfer->receive[i] = device->give(port);
        } else if (!device->take(port, i, transfer->send[i])) {
            ports[port].outcome = HAL_I2C_NO_ACKNOWLEDGE;
            return i + 1;
        }
    }
    return (unsigned)transfer->size;
}

void hal_i2c_start(unsigned port, const hal_i2c_transfer_t *transfer) {
    const host_i2c_device_t *device = host_i2c_device(transfer->address, transfer->ten_bits);
    unsigned bytes = transfer->ten_bits ? 2 : 1;
    ports[port].outcome = HAL_I2C_DONE;
    if (device != NULL && device->never_ends) {
        ports[port].ends_ns = HOST_CLOCK_NEVER;
        return;
    }
    if (device == NULL || (device->acknowledges != NULL && !device->acknowledges(port))) {
        ports[port].outcome = HAL_I2C_NO_ACKNOWLEDGE;
    } else {
        bytes += exchange(port, device, transfer);
    }
    uint64_t clocks = bytes * BYTE_CLOCKS + EDGE_CLOCKS;
    ports[port].ends_ns = host_clock_now_ns() + clocks * ports[port].clock_ns;
    if (device != NULL && (!transfer->keep || ports[port].outcome != HAL_I2C_DONE)) {
        device->stop(port, ports[port].ends_ns);
    }
}

hal_i2c_state_t hal_i2c_poll(unsigned port) {
    return host_clock_now_ns() < ports[port].ends_ns ? HAL_I2C_BUSY : ports[port].outcome;
}

void hal_i2c_abort(unsigned port) {
    ports[port].ends_ns = 0;
}

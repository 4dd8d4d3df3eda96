// The two I2C controllers as masters, one transfer at a time. The rules of hal.h apply. Context:
// main loop.
#ifndef HAL_HAL_I2C_H
#define HAL_HAL_I2C_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define HAL_I2C_PORTS 2u
#define HAL_I2C_KHZ_MIN 10u
#define HAL_I2C_KHZ_MAX 1000u

typedef struct {
    uint16_t address;    // without the bit for reading
    bool ten_bits;       // of the address; else seven
    bool keep;           // no stop behind it: the next transfer starts with a repeated start
    const uint8_t *send; // NULL: it is read
    uint8_t *receive;
    size_t size; // bytes, at least 1
} hal_i2c_transfer_t;

typedef enum { HAL_I2C_BUSY, HAL_I2C_DONE, HAL_I2C_NO_ACKNOWLEDGE } hal_i2c_state_t;

// Opens a closed port on two pins, with pull-ups. If a device holds the data line, as one does that
// was left in the middle of a byte, it gets clocks until it lets go.
void hal_i2c_open(unsigned port, unsigned sda_gpio, unsigned scl_gpio, uint32_t khz);

// The pins are for hal_pin_release().
void hal_i2c_close(unsigned port);

// Starts a transfer, whose bytes have to stay until it is over. None may be under way on either
// port.
void hal_i2c_start(unsigned port, const hal_i2c_transfer_t *transfer);

// Moves the transfer on; to be called until it is not busy. If that comes late the clock pauses.
hal_i2c_state_t hal_i2c_poll(unsigned port);

// Gives a transfer up and frees the lines, as far as the devices let them go.
void hal_i2c_abort(unsigned port);

#endif

// Serial ports of a BASIC program, beside the console. The rules of hal.h apply. Context: main
// loop.
#ifndef HAL_HAL_SERIAL_H
#define HAL_HAL_SERIAL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define HAL_SERIAL_PORTS 2u
#define HAL_SERIAL_RECEIVE_SIZE 512u
#define HAL_SERIAL_SEND_SIZE 128u
#define HAL_SERIAL_BAUD_MIN 120u
#define HAL_SERIAL_BAUD_MAX 921600u

// The port a pin can belong to; every fourth pin sends and the next one receives. The others belong
// to none.
#define HAL_SERIAL_PORT(gpio) (((gpio) + 4u) / 8u % 2u)
#define HAL_SERIAL_SENDS(gpio) ((gpio) % 4u == 0)
#define HAL_SERIAL_RECEIVES(gpio) ((gpio) % 4u == 1)

typedef enum { HAL_PARITY_NONE, HAL_PARITY_EVEN, HAL_PARITY_ODD } hal_parity_t;

typedef struct {
    uint32_t baud;
    uint8_t data_bits; // 5 to 8
    uint8_t stop_bits; // 1 or 2
    hal_parity_t parity;
    uint16_t receive_size; // bytes kept until they are read, up to HAL_SERIAL_RECEIVE_SIZE
} hal_serial_t;

// Opens a closed port. Port 0 on a board is the console's second way: it ends until
// hal_serial_close().
void hal_serial_open(unsigned port, unsigned receive_gpio, unsigned send_gpio,
                     const hal_serial_t *settings);

// Forgets what was received and what has not been sent; the pins are for hal_pin_release().
void hal_serial_close(unsigned port);

// Bytes received and not read; those that come while the buffer is full are lost.
size_t hal_serial_waiting(unsigned port);
size_t hal_serial_read(unsigned port, uint8_t *bytes, size_t size); // takes what is there

// Bytes that can be sent at once, and whether all is on the wire.
size_t hal_serial_room(unsigned port);
bool hal_serial_is_sent(unsigned port);
size_t hal_serial_write(unsigned port, const uint8_t *bytes, size_t size); // takes what fits

#endif

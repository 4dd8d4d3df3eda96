// The two SPI controllers as masters. The rules of hal.h apply. Context: main loop.
#ifndef HAL_HAL_SPI_H
#define HAL_HAL_SPI_H

#include <stddef.h>
#include <stdint.h>

#define HAL_SPI_PORTS 2u
#define HAL_SPI_HZ_MIN 10000u
#define HAL_SPI_HZ_MAX 62500000u
#define HAL_SPI_BITS_MIN 4u
#define HAL_SPI_BITS_MAX 16u

// Words that may have been sent and not been received; more would be lost.
#define HAL_SPI_UNDER_WAY 8u

typedef struct {
    uint32_t hz;  // the controller takes the next one below that it can make
    uint8_t mode; // bit 1: the clock is high at rest; bit 0: data are valid at its second edge
    uint8_t bits; // of a word, the highest first
} hal_spi_t;

// Opens a closed port.
void hal_spi_open(unsigned port, unsigned receive_gpio, unsigned send_gpio, unsigned clock_gpio,
                  const hal_spi_t *settings);

// The pins are for hal_pin_release().
void hal_spi_close(unsigned port);

// Sends a word; another one arrives meanwhile. At most HAL_SPI_UNDER_WAY may be under way.
void hal_spi_send(unsigned port, uint16_t word);

// Words that have arrived, into `words`. Returns how many.
size_t hal_spi_receive(unsigned port, uint16_t *words, size_t size);

#endif

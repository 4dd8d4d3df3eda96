// SPI ports that wear a loopback plug: each word sent comes back when its bits have been on the
// wire. Context: main.
#include "hal/hal_spi.h"
#include "host_clock.h"

static struct {
    uint64_t word_ns;
    uint64_t last_ns; // when the last word has been sent
    uint64_t arrives_ns[HAL_SPI_UNDER_WAY];
    uint16_t words[HAL_SPI_UNDER_WAY];
    uint16_t mask; // of a word's bits
    size_t first, count;
} ports[HAL_SPI_PORTS];

void hal_spi_open(unsigned port, unsigned receive_gpio, unsigned send_gpio, unsigned clock_gpio,
                  const hal_spi_t *settings) {
    (void)receive_gpio;
    (void)send_gpio;
    (void)clock_gpio;
    ports[port].word_ns = settings->bits * UINT64_C(1000000000) / settings->hz;
    ports[port].mask = (uint16_t)((1u << settings->bits) - 1);
    ports[port].count = 0;
}

void hal_spi_close(unsigned port) {
    ports[port].count = 0;
}

void hal_spi_send(unsigned port, uint16_t word) {
    if (ports[port].count == HAL_SPI_UNDER_WAY) {
        return; // lost
    }
    size_t slot = (ports[port].first + ports[port].count++) % HAL_SPI_UNDER_WAY;
    uint64_t now_ns = host_clock_now_ns();
    uint64_t begin_ns = ports[port].last_ns > now_ns ? ports[port].last_ns : now_ns;
    ports[port].last_ns = begin_ns + ports[port].word_ns;
    ports[port].arrives_ns[slot] = ports[port].last_ns;
    ports[port].words[slot] = word & ports[port].mask;
}

size_t hal_spi_receive(unsigned port, uint16_t *words, size_t size) {
    size_t count = 0;
    while (count < size && ports[port].count > 0 &&
           ports[port].arrives_ns[ports[port].first] <= host_clock_now_ns()) {
        words[count++] = ports[port].words[ports[port].first];
        ports[port].first = (ports[port].first + 1) % HAL_SPI_UNDER_WAY;
        ports[port].count--;
    }
    return count;
}

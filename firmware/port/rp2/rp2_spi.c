// The SPI controllers as masters; their FIFOs hold what is under way. Context: main.
#include "hal/hal_spi.h"

#include "hardware/gpio.h"
#include "hardware/spi.h"

void hal_spi_open(unsigned port, unsigned receive_gpio, unsigned send_gpio, unsigned clock_gpio,
                  const hal_spi_t *settings) {
    spi_inst_t *spi = SPI_INSTANCE(port);
    spi_init(spi, settings->hz);
    spi_set_format(spi, settings->bits, settings->mode >> 1 & 1 ? SPI_CPOL_1 : SPI_CPOL_0,
                   settings->mode & 1 ? SPI_CPHA_1 : SPI_CPHA_0, SPI_MSB_FIRST);
    gpio_set_function(receive_gpio, GPIO_FUNC_SPI);
    gpio_set_function(clock_gpio, GPIO_FUNC_SPI);
    gpio_set_function(send_gpio, GPIO_FUNC_SPI);
}

void hal_spi_close(unsigned port) {
    spi_deinit(SPI_INSTANCE(port));
}

void hal_spi_send(unsigned port, uint16_t word) {
    spi_get_hw(SPI_INSTANCE(port))->dr = word;
}

size_t hal_spi_receive(unsigned port, uint16_t *words, size_t size) {
    spi_inst_t *spi = SPI_INSTANCE(port);
    size_t count = 0;
    while (count < size && spi_is_readable(spi)) {
        words[count++] = (uint16_t)spi_get_hw(spi)->dr;
    }
    return count;
}

// The inline part of the seam, host port: pins are words in memory, every change is recorded.
#ifndef HAL_PORT_H
#define HAL_PORT_H

#include <stdint.h>

#define HAL_RAM_FUNC(name) name

void hal_pins_set(uint32_t mask);
void hal_pins_clear(uint32_t mask);
uint32_t hal_pins_read(void);

typedef unsigned hal_pwm_place_t;
hal_pwm_place_t hal_pwm_place(unsigned slice);
void hal_pwm_level(hal_pwm_place_t place, uint16_t level);

#endif

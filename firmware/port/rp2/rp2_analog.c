// The analog-to-digital converter, switched on when it is first wanted. Context: main.
#include "hal/hal.h"
#include "hal/hal_io.h"

#include "hardware/adc.h"

static_assert(HAL_ANALOG_TEMPERATURE == ADC_TEMPERATURE_CHANNEL_NUM, "the sensor is elsewhere");
static_assert(HAL_ANALOG_FIRST_GPIO == ADC_BASE_PIN, "the analog inputs are elsewhere");

uint32_t hal_analog_read(unsigned channel) {
    static bool is_on;
    if (!is_on) {
        is_on = true;
        adc_init();
        adc_set_temp_sensor_enabled(true);
        hal_wait_us(100); // the sensor has to settle
    }
    adc_select_input(channel);
    return adc_read();
}

// Analog inputs: what the converter would make of the simulated voltages. Context: main.
#include "host_analog.h"

#include "hal/hal.h"
#include "hal/hal_io.h"
#include "host_pads.h"

#define FULL_SCALE_VOLTS 3.3
#define HIGH_VOLTS 1.65
#define CHANNELS (HAL_ANALOG_TEMPERATURE + 1u)

// The chip's sensor, as its data sheet describes it.
#define SENSOR_VOLTS(celsius) (0.706 - ((celsius) - 27.0) * 0.001721)

static double volts_of[CHANNELS] = {[HAL_ANALOG_TEMPERATURE] = SENSOR_VOLTS(25.0)};

void host_analog_set_volts(unsigned gpio, double volts) {
    if (gpio >= HAL_ANALOG_FIRST_GPIO && gpio <= HAL_ANALOG_LAST_GPIO) {
        volts_of[gpio - HAL_ANALOG_FIRST_GPIO] = volts;
    }
    host_pads_drive(gpio, volts >= HIGH_VOLTS);
}

void host_analog_set_temperature(double celsius) {
    volts_of[HAL_ANALOG_TEMPERATURE] = SENSOR_VOLTS(celsius);
}

uint32_t hal_analog_read(unsigned channel) {
    double reading = channel < CHANNELS ? volts_of[channel] / FULL_SCALE_VOLTS * HAL_ANALOG_MAX : 0;
    if (!(reading > 0)) {
        return 0;
    }
    return reading >= HAL_ANALOG_MAX ? HAL_ANALOG_MAX : (uint32_t)(reading + 0.5);
}

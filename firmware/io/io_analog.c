// Analog inputs and the chip's temperature. Context: main loop.
#include "io_analog.h"

#include "io.h"
#include "io_pins.h"

#define READINGS 10 // for one value, the lowest and the highest of which do not count

// RP2040 datasheet, section 4.9.5: 0.706 V at 27 degrees, 1.721 mV less for each degree. The sensor
// has its own supply for full scale: what is set for the pins does not matter, 3.3 V is what the
// boards have.
#define SENSOR_VOLTS 0.706
#define SENSOR_DEGREES 27.0
#define SENSOR_VOLTS_PER_DEGREE 0.001721

static double reference_volts = IO_REFERENCE_VOLTS;

static err_t set_analog(unsigned gpio, io_pins_use_t use) {
    err_t err = io_pins_check(gpio);
    if (err != ERR_OK) {
        return err;
    }
    if (gpio < HAL_ANALOG_FIRST_GPIO || gpio > HAL_ANALOG_LAST_GPIO) {
        return err_raise(ERR_PIN_NOT_ANALOG, "%s", pins_name(gpio));
    }
    io_pins_take(gpio, use);
    hal_pin_analog(gpio);
    return ERR_OK;
}

err_t io_set_voltage(unsigned gpio) {
    return set_analog(gpio, IO_PINS_VOLTAGE);
}

err_t io_set_raw(unsigned gpio) {
    return set_analog(gpio, IO_PINS_RAW);
}

void io_set_reference(double volts) {
    reference_volts = volts;
}

// Mean reading of a channel, 0..HAL_ANALOG_MAX.
static double mean_of(unsigned channel) {
    uint32_t sum = 0, lowest = UINT32_MAX, highest = 0;
    for (unsigned i = 0; i < READINGS; i++) {
        uint32_t reading = hal_analog_read(channel);
        sum += reading;
        lowest = reading < lowest ? reading : lowest;
        highest = reading > highest ? reading : highest;
    }
    return (double)(sum - lowest - highest) / (READINGS - 2);
}

double io_analog_volts(unsigned gpio) {
    return mean_of(gpio - HAL_ANALOG_FIRST_GPIO) * reference_volts / HAL_ANALOG_MAX;
}

int64_t io_analog_raw(unsigned gpio) {
    return hal_analog_read(gpio - HAL_ANALOG_FIRST_GPIO);
}

double io_temperature(void) {
    double volts = mean_of(HAL_ANALOG_TEMPERATURE) * IO_REFERENCE_VOLTS / HAL_ANALOG_MAX;
    return SENSOR_DEGREES - (volts - SENSOR_VOLTS) / SENSOR_VOLTS_PER_DEGREE;
}

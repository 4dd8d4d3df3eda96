// Pin names and ownership; the same for every board. Context: main loop.
#include "hal/pins.h"

#include "base/base.h"

#define NAME_BUFFERS 4
#define LED_GPIO 25u

static struct {
    const char *owner[PINS_COUNT];
    char names[NAME_BUFFERS][24];
    unsigned next_name;
} pins;

// Index is the GPIO; Raspberry Pi Pico datasheet, pinout.
static const uint8_t board_numbers[PINS_COUNT] = {
    1,  2,  4,  5,  6,  7,  9,  10, 11, 12, 14, 15, 16, 17, 19,
    20, 21, 22, 24, 25, 26, 27, 29, 0,  0,  0,  31, 32, 34, 0,
};

// Header pins that are no GPIO; the same source.
static const struct {
    uint8_t board_number;
    const char *use;
} other_pins[] = {
    {3, "ground"},  {8, "ground"},  {13, "ground"}, {18, "ground"},   {23, "ground"},
    {28, "ground"}, {30, "RUN"},    {33, "ground"}, {35, "ADC_VREF"}, {36, "3.3 V"},
    {37, "3V3_EN"}, {38, "ground"}, {39, "VSYS"},   {40, "VBUS"},
};

bool pins_is_user(unsigned gpio) {
    return gpio < PINS_COUNT && (board_numbers[gpio] != 0 || gpio == LED_GPIO);
}

unsigned pins_board_number(unsigned gpio) {
    return gpio < PINS_COUNT ? board_numbers[gpio] : 0;
}

unsigned pins_from_board_number(unsigned board_number) {
    for (unsigned gpio = 0; board_number != 0 && gpio < PINS_COUNT; gpio++) {
        if (board_numbers[gpio] == board_number) {
            return gpio;
        }
    }
    return PINS_NONE;
}

const char *pins_why_not(unsigned gpio) {
    return gpio < PINS_COUNT ? "used by the board itself" : "valid is GP0 to GP28";
}

const char *pins_why_not_board_number(unsigned board_number) {
    for (size_t i = 0; i < COUNT_OF_ARRAY(other_pins); i++) {
        if (other_pins[i].board_number == board_number) {
            return other_pins[i].use;
        }
    }
    return "valid is 1 to 40";
}

const char *pins_name(unsigned gpio) {
    if (gpio == PINS_NONE) {
        return "none";
    }
    char *name = pins.names[pins.next_name++ % NAME_BUFFERS];
    if (pins_board_number(gpio) != 0) {
        format_text(name, sizeof pins.names[0], "GP%u (pin %u)", gpio, pins_board_number(gpio));
    } else {
        format_text(name, sizeof pins.names[0], "GP%u", gpio);
    }
    return name;
}

err_t pins_claim(unsigned gpio, const char *owner) {
    if (!pins_is_user(gpio)) {
        return err_raise(ERR_PIN_INVALID, "GP%u", gpio);
    }
    if (pins.owner[gpio] != NULL) {
        return err_raise(ERR_PIN_IN_USE, "%s is in use by %s", pins_name(gpio), pins.owner[gpio]);
    }
    pins.owner[gpio] = owner;
    return ERR_OK;
}

const char *pins_owner(unsigned gpio) {
    return gpio < PINS_COUNT ? pins.owner[gpio] : NULL;
}

void pins_disclaim(unsigned gpio) {
    if (gpio < PINS_COUNT) {
        pins.owner[gpio] = NULL;
    }
}

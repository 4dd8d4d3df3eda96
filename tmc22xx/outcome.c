// What went wrong, where, and what to check. Context: main loop.
#include "tmc22xx/outcome.h"

#include "hal/pins.h"
#include "tmc22xx/tmc22xx_registers.h"
#include "tmc22xx/wires.h"

#define PLACE_SIZE 56

// "address 0 on GP16 (pin 21), axis X"
static size_t place(char *text, size_t size, unsigned address, unsigned tx_gpio, unsigned axis) {
    char axis_text[] = ", axis X";
    axis_text[sizeof ", axis " - 1] = "XYZA"[axis % 4];
    return format_text(text, size, "address %u on %s%s", address, pins_name(tx_gpio),
                       axis == TMC22XX_NO_AXIS ? "" : axis_text);
}

size_t outcome_name(char *text, size_t size, const driver_t *entry) {
    char where[PLACE_SIZE];
    place(where, sizeof where, entry->address, wires_get(entry->wire)->tx_gpio, entry->axis);
    return format_text(text, size, "TMC%u at %s", tmc22xx_chip_number(entry->chip), where);
}

static err_t raise_silent(const outcome_t *outcome, const char *where) {
    if (outcome->found != 0) {
        unsigned address = 0;
        while ((outcome->found & 1u << address) == 0) {
            address++;
        }
        return err_raise(ERR_TMC_SILENT,
                         "%s; a driver answers at address %u: check MS1 and MS2, or the address",
                         where, address);
    }
    if (outcome->others) {
        return err_raise(ERR_TMC_SILENT,
                         "%s; others on this wire answer: check its motor supply, MS1 and MS2",
                         where);
    }
    if (outcome->rx_gpio != outcome->tx_gpio && !outcome->partly) {
        return err_raise(ERR_TMC_SILENT,
                         "%s: check motor supply, wire to PDN_UART, wire back to %s", where,
                         pins_name(outcome->rx_gpio));
    }
    if (outcome->is_being_set && !outcome->partly) {
        return err_raise(ERR_TMC_SILENT,
                         "%s: check motor supply, wire to PDN_UART, 1 k resistor "
                         "(without a way back: TMC22xx VERIFY 0)",
                         where);
    }
    return err_raise(ERR_TMC_SILENT, "%s: check motor supply and wire%s", where,
                     outcome->partly ? "; its settings may be partly changed" : "");
}

static err_t raise_wrong_chip(const outcome_t *outcome, const char *where) {
    unsigned wanted = tmc22xx_chip_number(outcome->chip);
    if (outcome->found == TMC22XX_VERSION_2208 || outcome->found == TMC22XX_VERSION_2209) {
        return err_raise(ERR_TMC_WRONG_CHIP, "a TMC%u, not a TMC%u: %s",
                         outcome->found == TMC22XX_VERSION_2208 ? 2208u : 2209u, wanted, where);
    }
    return err_raise(ERR_TMC_WRONG_CHIP, "no TMC%u: %s (its version is 0x%02X)", wanted, where,
                     outcome->found);
}

err_t outcome_raise(const outcome_t *outcome) {
    char where[PLACE_SIZE];
    place(where, sizeof where, outcome->address, outcome->tx_gpio, outcome->axis);
    const char *partly = outcome->partly ? "; its settings may be partly changed" : "";
    switch (outcome->fault) {
    case ACCESS_OK:
        return ERR_OK;
    case ACCESS_SILENT:
        return raise_silent(outcome, where);
    case ACCESS_GARBLED:
        return err_raise(ERR_TMC_GARBLED,
                         "%s: check ground, 1 k resistor, two drivers with one address%s", where,
                         partly);
    case ACCESS_HELD_LOW:
        return err_raise(ERR_TMC_HELD_LOW, "%s is held low: is the driver powered?%s",
                         pins_name(outcome->rx_gpio), partly);
    case ACCESS_NOT_TAKEN:
        return err_raise(ERR_TMC_NOT_TAKEN, "%s%s", where, partly);
    case ACCESS_LOST:
        return err_raise(ERR_TMC_LOST, "%s", where);
    case OUTCOME_WRONG_CHIP:
        return raise_wrong_chip(outcome, where);
    case OUTCOME_CLOSED:
        return err_raise(ERR_TMC_CLOSED, "%s", pins_name(outcome->tx_gpio));
    default:
        return err_raise(ERR_TMC_GIVEN_UP, "%s", where);
    }
}

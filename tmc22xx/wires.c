// The table of wires. Context: main loop.
#include "tmc22xx/wires.h"

#include "hal/pins.h"
#include "tmc22xx/tmc22xx.h"

#define OWNER "TMC22xx wire"

_Static_assert(TMC22XX_BAUD_MIN >= HAL_WIRE_BAUD_MIN && TMC22XX_BAUD_MAX <= HAL_WIRE_BAUD_MAX,
               "the hardware can do it");

static hal_wire_t wires[WIRES]; // baud 0: free

const hal_wire_t *wires_get(unsigned wire) {
    return wire < WIRES && wires[wire].baud != 0 ? &wires[wire] : NULL;
}

unsigned wires_find(uint8_t tx_gpio) {
    for (unsigned i = 0; i < WIRES; i++) {
        if (wires[i].baud != 0 && wires[i].tx_gpio == tx_gpio) {
            return i;
        }
    }
    return WIRES_NONE;
}

static unsigned find_free(void) {
    unsigned wire = 0;
    while (wire < WIRES && wires[wire].baud != 0) {
        wire++;
    }
    return wire;
}

static err_t claim(uint8_t tx_gpio, uint8_t rx_gpio) {
    err_t err = pins_claim(tx_gpio, OWNER);
    if (err == ERR_OK && rx_gpio != tx_gpio) {
        err = pins_claim(rx_gpio, OWNER);
        if (err != ERR_OK) {
            pins_disclaim(tx_gpio);
        }
    }
    return err;
}

void wires_close(unsigned wire) {
    hal_wire_close(&wires[wire]);
    pins_disclaim(wires[wire].tx_gpio);
    pins_disclaim(wires[wire].rx_gpio);
    wires[wire].baud = 0;
}

static void open(unsigned wire, uint8_t tx_gpio, uint8_t rx_gpio, uint32_t baud) {
    wires[wire] = (hal_wire_t){.tx_gpio = tx_gpio, .rx_gpio = rx_gpio, .baud = baud};
    hal_wire_open(&wires[wire]);
}

// The sending pin stays claimed, so only the other one can be refused.
static err_t change(unsigned wire, uint8_t rx_gpio, uint32_t baud) {
    hal_wire_t before = wires[wire];
    if (before.rx_gpio == rx_gpio) { // the pins stay as they are
        wires[wire].baud = baud;
        return ERR_OK;
    }
    err_t err = rx_gpio != before.tx_gpio ? pins_claim(rx_gpio, OWNER) : ERR_OK;
    if (err != ERR_OK) {
        return err;
    }
    hal_wire_close(&before);
    if (before.rx_gpio != before.tx_gpio) {
        pins_disclaim(before.rx_gpio);
    }
    open(wire, before.tx_gpio, rx_gpio, baud);
    return ERR_OK;
}

err_t wires_set(uint8_t tx_gpio, uint8_t rx_gpio, uint32_t baud) {
    if (baud < TMC22XX_BAUD_MIN || baud > TMC22XX_BAUD_MAX) {
        return err_raise(ERR_ARGUMENT, "baud: %u is invalid (valid is %u to %u)", (unsigned)baud,
                         TMC22XX_BAUD_MIN, TMC22XX_BAUD_MAX);
    }
    unsigned wire = wires_find(tx_gpio);
    if (wire != WIRES_NONE) {
        return change(wire, rx_gpio, baud);
    }
    wire = find_free();
    if (wire == WIRES) {
        return err_raise(ERR_TMC_WIRES, NULL);
    }
    err_t err = claim(tx_gpio, rx_gpio);
    if (err == ERR_OK) {
        open(wire, tx_gpio, rx_gpio, baud);
    }
    return err;
}

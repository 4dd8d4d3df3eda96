// SPI0 and SPI1 with the time a word takes on the wire, each with a loopback plug from transmit to receive. What is sent
// is kept with the form it had (rp2040js sends at once, and has no words of its own for the modes).
// Source: RP2040 data sheet, 4.4 (ARM PL022).

import { onPeripheralReset } from './peripheral_resets.mjs';

const RESET_BIT = [16, 17];
const FUNCTION_SPI = 1, PINS_OF_PORT = 8;
const ROLES = [0, 2, 3]; // receive, clock, transmit: the pin's number modulo 4

export class Spi {
    // Completes the transfers of rp2040js's `mcu.spi[index]`.
    constructor({ mcu, clock, index }) {
        Object.assign(this, { mcu, index, sent: [], word: 0 });
        const stock = this.stock = mcu.spi[index];
        this.alarm = clock.createAlarm(() => this.arrived());
        stock.onTransmit = (word) => {
            this.word = word;
            this.sent.push({ word, ...this.form() });
            this.alarm.schedule(stock.dataBits * 1e9 / stock.clockFrequency);
        };
        onPeripheralReset(mcu, RESET_BIT[index], () => this.reset());
    }

    form() {
        const { control0, dataBits, clockFrequency } = this.stock;
        return { bits: dataBits, mode: (control0 >> 6 & 1) << 1 | control0 >> 7 & 1, hz: clockFrequency };
    }

    hasPins() {
        return ROLES.every((role) => this.mcu.gpio.some((pin, gpio) => pin.functionSelect === FUNCTION_SPI
            && gpio % 4 === role && (gpio / PINS_OF_PORT & 1) === this.index));
    }

    arrived() {
        this.stock.completeTransmit(this.hasPins() ? this.word : 0);
    }

    // Takes what was sent so far.
    take() {
        return this.sent.splice(0);
    }

    reset() {
        const { stock } = this;
        this.alarm.cancel();
        stock.txFIFO.reset();
        stock.rxFIFO.reset();
        Object.assign(stock, { busy: false, control0: 0, control1: 0, clockDivisor: 0 });
    }
}

// I2C0 and I2C1 with the time a byte takes on the wire, and what is connected to each of them, the same as on the host
// port (host_i2c_devices.c): a memory like a 24C32 at 0x50, a thermometer like an LM75 at 0x48 (and at 0x148 with ten
// bits), and at 0x4f a broken device that holds the clock. Bytes go out and come in as bytes: the pins show no waveform.
// Source: RP2040 data sheet, 4.3.

import { onPeripheralReset } from './peripheral_resets.mjs';

const BYTE_CLOCKS = 9, EDGE_CLOCKS = 1;
const RESET_BIT = [3, 4];
const FUNCTION_I2C = 3, PIN_PERIOD = 4; // of four pins that follow each other two belong to each port
const HELD = 'held';
const IDLE = 0, TEN_BITS = 1 << 4;

class Memory {
    constructor(clock) {
        Object.assign(this, { clock, bytes: new Uint8Array(4096), place: 0, index: 0, written: false, readyNanos: 0 });
    }

    connect() {
        this.index = 0;
        return this.clock.nanosCounter >= this.readyNanos;
    }

    take(byte) {
        if (this.index++ < 2) {
            this.place = (this.place << 8 | byte) & 0xfff;
            return true;
        }
        this.bytes[this.place] = byte;
        this.written = true;
        this.place = (this.place & ~31) | (this.place + 1 & 31);
        return true;
    }

    give() {
        const byte = this.bytes[this.place];
        this.place = this.place + 1 & 0xfff;
        return byte;
    }

    stop() {
        if (this.written) this.readyNanos = this.clock.nanosCounter + 5e6;
        this.written = false;
    }
}

class Thermometer {
    constructor() {
        Object.assign(this, { registers: [[0x19, 0x80], [0, 0], [0, 0], [0, 0]], selected: 0, index: 0 });
    }

    connect() {
        this.index = 0;
        return true;
    }

    take(byte) {
        const index = this.index++;
        if (index === 0) this.selected = byte & 3;
        else if (index <= 2 && this.selected !== 0) this.registers[this.selected][index - 1] = byte;
        return index <= 2;
    }

    give() { return this.registers[this.selected][this.index++ & 1]; }
    stop() {}
}

export class I2c {
    // Completes the transfers of rp2040js's `mcu.i2c[index]`.
    constructor({ mcu, clock, index }) {
        Object.assign(this, { mcu, clock, index });
        const thermometer = new Thermometer();
        this.devices = { 0x50: new Memory(clock), 0x48: thermometer, 0x1148: thermometer, 0x4f: HELD };
        this.device = null;
        this.then = null;
        this.alarm = clock.createAlarm(() => this.then());
        const stock = this.stock = mcu.i2c[index];
        stock.onStart = () => this.later(EDGE_CLOCKS, () => stock.completeStart());
        stock.onConnect = (address) => this.connect(address);
        stock.onWriteByte = (byte) => this.later(BYTE_CLOCKS, () => stock.completeWrite(this.device.take(byte)));
        stock.onReadByte = () => this.later(BYTE_CLOCKS, () => stock.completeRead(this.device.give()));
        stock.onStop = () => this.later(EDGE_CLOCKS, () => {
            this.device?.stop?.();
            stock.completeStop();
        });
        onPeripheralReset(mcu, RESET_BIT[index], () => this.reset());
    }

    clockNanos() {
        return (this.stock.sclLowPeriod + this.stock.sclHighPeriod) * 1e9 / this.mcu.clkPeri;
    }

    later(clocks, then) {
        this.then = then;
        this.alarm.schedule(clocks * this.clockNanos());
    }

    // A data and a clock pin are needed, or nobody hears anything.
    hasPins() {
        return [0, 1].every((role) => this.mcu.gpio.some((pin, gpio) => pin.functionSelect === FUNCTION_I2C
            && gpio % PIN_PERIOD === 2 * this.index + role));
    }

    connect(address) {
        const tenBits = (this.stock.control & TEN_BITS) !== 0;
        this.device = this.hasPins() ? this.devices[tenBits ? 0x1000 | address : address] ?? null : null;
        if (this.device === HELD) return;
        this.later(BYTE_CLOCKS * (tenBits ? 2 : 1), () => this.stock.completeConnect(this.device?.connect() ?? false));
    }

    reset() {
        const { stock } = this;
        this.alarm.cancel();
        stock.txFIFO.reset();
        stock.rxFIFO.reset();
        Object.assign(stock, { state: IDLE, busy: false, stop: false, pendingRestart: false, enable: 0, intRaw: 0 });
    }
}

// The TMC drivers on the bench, by name, and the wires they are at.

import { FULL_STEP, Motor } from './tmc_motor.mjs';
import { Tmc2209 } from './tmc2209.mjs';
import { Wire } from './tmc_wire.mjs';

const SEED = 0x2209;

export class TmcBench {
    constructor(board) {
        Object.assign(this, { board });
        this.wires = new Map();   // pin, sending or receiving -> Wire
        this.drivers = new Map(); // name -> Tmc2209
        this.log = [];            // see tmc_wire.mjs
    }

    // A driver at the wire of pin `tx`; `rx`: the pin that receives there, if it is another. `axis`: whose steps it
    // gets; `low`, `high`: the end stops, in steps of the axis. The rest: see Tmc2209.
    add(name, { tx, rx = null, axis: axisName = null, low = -Infinity, high = Infinity, load = 0, microsteps = 16, seed = SEED, ...options }) {
        const { board } = this, axis = axisName === null ? null : board.axes.get(axisName);
        if (axis === undefined) throw new Error(`there is no axis ${axisName}`);
        const place = (steps) => (steps ?? 0) * FULL_STEP / microsteps;
        const motor = new Motor({ at: place(axis?.at), low: place(low ?? -Infinity), high: place(high ?? Infinity), load });
        const wire = this.wireAt(tx, rx, seed);
        const driver = new Tmc2209({ board, wire, name, motor, axis, microsteps, seed: seed + this.drivers.size, ...options });
        wire.drivers.push(driver);
        this.drivers.set(name, driver);
        if (axis !== null) axis.driver = driver;
        wire.settle();
    }

    wireAt(tx, rx, seed) {
        const wire = this.wires.get(tx) ?? new Wire({ board: this.board, tx, rx, log: this.log, seed });
        if (wire.tx !== tx || (rx !== null && wire.rx !== rx)) throw new Error(`GP${tx} is wired otherwise`);
        this.wires.set(tx, wire);
        if (wire.rx !== null) this.wires.set(wire.rx, wire);
        return wire;
    }

    driver(name) {
        const found = name === null ? this.drivers.values().next().value : this.drivers.get(name);
        if (found === undefined) throw new Error(`there is no driver ${name}`);
        return found;
    }

    motor(name) {
        const { field, rotor, slips, lag } = this.driver(name).motor;
        return { field, rotor, slips, lag };
    }

    // At a time, or now (null), at a driver or the first one (null).
    inject(fault, name, atNanos, options) {
        const driver = this.driver(name);
        driver.checkFault(fault);
        if (atNanos === null) driver.inject(fault, options);
        else this.board.at(atNanos, () => driver.inject(fault, options));
    }

    heal(name) {
        if (name !== null) this.driver(name).heal();
        else this.drivers.forEach((driver) => driver.heal());
    }

    // The level of a pin has changed, or whether the board drives it.
    pad(gpio) {
        if (this.wires.size > 0) this.wires.get(gpio)?.settle();
    }

    settle() {
        new Set(this.wires.values()).forEach((wire) => wire.settle());
    }
}

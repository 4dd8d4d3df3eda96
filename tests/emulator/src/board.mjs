// A Pico on the bench: a chip that may restart, its flash, what is connected to its pins and its serial ports, and
// one line of virtual time (nanoseconds since power-up) through all restarts.

import fs from 'node:fs';
import { Chip, readBootrom } from './chip.mjs';
import { Symbols } from './elf.mjs';
import { FLASH_SIZE } from './flash.mjs';
import { Axis } from './machine.mjs';
import { RAM_SIZE } from './executor.mjs';
import { Profile } from './profile.mjs';
import { Recorder } from './recorder.mjs';
import { TmcBench } from './tmc_bench.mjs';
import { readUf2 } from './uf2.mjs';

const PINS = 30;
const FAULTS_KEPT = 100;
const SLICE_NANOS = 50e3; // how often a condition is looked at
export const STORAGE_SIZE = 1280 * 1024; // the firmware's storage: the last part of the flash

export class Board {
    // `uf2`: the program. `elf` (optional): its symbols. `bootrom`: file with the boot ROM.
    // `storage` (optional): file with the storage area, read if it is there, written by saveStorage().
    constructor({ uf2, elf = null, bootrom, storage = null }) {
        this.symbols = new Symbols(elf);
        this.recorder = new Recorder();
        this.profile = new Profile();
        this.faults = [];   // [{ time_ns, text }]
        this.events = [];   // [{ timeNanos, action }], sorted
        this.output = '';   // what came over USB and nobody has taken
        this.uartOutput = ['', ''];
        this.axes = new Map(); // name -> Axis
        this.onSerial = null; // (bytes) => void: takes USB output instead of `output`
        this.resets = 0;
        this.baseNanos = 0; // virtual time at the last restart
        this.tickRunsBefore = [];
        this.storageFile = storage;
        this.tmc = new TmcBench(this);
        this.shared = {
            flash: readUf2(uf2), ram: new Uint8Array(RAM_SIZE),
            external: new Array(PINS).fill(null), weak: new Array(PINS).fill(false),
            bootrom: readBootrom(bootrom), survivors: undefined, cyclesBefore: 0,
        };
        if (storage !== null && fs.existsSync(storage)) this.loadStorage(storage);
        this.start();
    }

    start() {
        this.chip = new Chip(this.shared, {
            onFault: (text, pc) => this.fault(text, pc),
            onEdge: (gpio, level) => this.edge(gpio, level),
            onPad: (gpio) => this.tmc.pad(gpio),
            onSerial: (bytes) => this.serial(bytes),
            onConnected: () => {},
            onUart: (index, byte) => { this.uartOutput[index] += String.fromCharCode(byte); },
        });
        this.profile.begin(() => this.chip.cycles(), this.chip.R);
        this.chip.nvic.profile = this.profile;
        this.watch();
        this.tmc.settle();
    }

    // Virtual time in nanoseconds. (While a chip is being built it has no clock yet: its time is 0.)
    get now() {
        return this.baseNanos + (this.chip?.clock.nanosCounter ?? 0);
    }

    get connected() {
        return this.chip.usb.connected;
    }

    fault(text, pc) {
        if (this.faults.length >= FAULTS_KEPT) return;
        const where = this.symbols.describe(pc >>> 0);
        this.faults.push({ time_ns: this.now, text: `${text}, at ${(pc >>> 0).toString(16)}${where && ` ${where}`}` });
    }

    edge(gpio, level) {
        this.recorder.add(this.now, gpio, level);
        if (this.chip !== null) this.axes.forEach((axis) => axis.edge(gpio, level, this));
    }

    serial(bytes) {
        if (this.onSerial !== null) this.onSerial(bytes);
        else this.output += Buffer.from(bytes).toString('latin1');
    }

    // ---- Running -------------------------------------------------------------------------------------

    // Runs to the virtual time `untilNanos`, or until `condition()` holds; returns whether it did.
    run(untilNanos, condition = null) {
        while (condition === null || !condition()) {
            const event = this.events[0];
            let stop = event !== undefined && event.timeNanos < untilNanos ? event.timeNanos : untilNanos;
            if (condition !== null) stop = Math.min(stop, this.now + SLICE_NANOS);
            if (this.chip.run(stop - this.baseNanos)) this.restart();
            while (this.events.length > 0 && this.events[0].timeNanos <= this.now) this.events.shift().action();
            if (this.now >= untilNanos) return condition === null || condition();
        }
        return true;
    }

    restart() {
        const { chip, shared } = this;
        this.tickRunsBefore = this.tickRuns();
        shared.survivors = chip.survivors();
        shared.cyclesBefore = chip.cycles();
        this.baseNanos = this.now;
        this.resets += 1;
        this.chip = null;
        this.start();
    }

    // At the virtual time `timeNanos` (at once if that is over) does `action()`.
    at(timeNanos, action) {
        let place = this.events.length;
        while (place > 0 && this.events[place - 1].timeNanos > timeNanos) place -= 1;
        this.events.splice(place, 0, { timeNanos, action });
        this.chip?.limit(timeNanos - this.baseNanos);
    }

    // ---- Serial ports --------------------------------------------------------------------------------

    send(bytes) {
        this.chip.usb.send(bytes);
    }

    sendUart(index, bytes) {
        this.chip.uarts[index].feed(bytes);
    }

    // Runs until the USB output ends with `suffix`; takes all of it and returns what stood before.
    until(suffix, timeoutNanos) {
        if (!this.run(this.now + timeoutNanos, () => this.output.endsWith(suffix))) this.timedOut(JSON.stringify(suffix), timeoutNanos);
        const text = this.output.slice(0, -suffix.length);
        this.output = '';
        return text;
    }

    timedOut(what, nanos) {
        throw new Error(`waited ${nanos / 1e6} ms for ${what}, got ${JSON.stringify(this.output.slice(-400))}`);
    }

    // Runs until the USB output matches; removes it up to the end of the match, which it returns (an array).
    expect(pattern, timeoutNanos) {
        let looked = -1; // length of the output at the last look
        const found = () => {
            if (this.output.length === looked) return false;
            looked = this.output.length;
            return pattern.test(this.output);
        };
        if (!this.run(this.now + timeoutNanos, found)) this.timedOut(pattern, timeoutNanos);
        const match = pattern.exec(this.output);
        this.output = this.output.slice(match.index + match[0].length);
        return [...match];
    }

    // ---- Pins ----------------------------------------------------------------------------------------

    setPin(gpio, level) {
        this.chip.pads.connect(gpio, level);
    }

    setPinAt(timeNanos, gpio, level) {
        this.at(timeNanos, () => this.setPin(gpio, level));
    }

    addAxis(name, options) {
        this.axes.set(name, new Axis(options));
    }

    addSwitch(name, options) {
        this.axes.get(name).addSwitch(options, this);
    }

    level(gpio) {
        return this.chip.mcu.gpio[gpio].rawInputValue ? 1 : 0;
    }

    // Stretches of SysTick running: [{ firstNanos, periodNanos, count }].
    tickRuns() {
        const runs = this.chip.systick.runs.filter((run) => run.count > 0);
        return this.tickRunsBefore.concat(runs.map((run) => ({ ...run, firstNanos: run.firstNanos + this.baseNanos })));
    }

    // ---- Memory and measuring ------------------------------------------------------------------------

    peek(address) {
        return this.chip.mcu.readUint32(address) >>> 0;
    }

    measure(name) {
        this.profile.measure(name, this.symbols.address(name));
        this.watch();
    }

    watch() {
        const { profile, chip } = this;
        chip.watchBranches(profile.functions.size > 0 ? (target, cycles) => profile.branch(target, cycles) : null);
    }

    report() {
        return this.profile.report((address) => this.symbols.describe(address).replace(/\+0x0$/, ''));
    }

    // ---- Storage -------------------------------------------------------------------------------------

    storage() {
        return this.shared.flash.subarray(FLASH_SIZE - STORAGE_SIZE);
    }

    loadStorage(file) {
        const data = fs.readFileSync(file);
        if (data.length !== STORAGE_SIZE) throw new Error(`${file} has ${data.length} bytes; a flash image has ${STORAGE_SIZE}`);
        this.storage().set(data);
    }

    saveStorage(file = this.storageFile) {
        if (file !== null) fs.writeFileSync(file, this.storage());
    }
}

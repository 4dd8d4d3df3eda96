// A TMC2209 (or TMC2208) at a wire, with a motor at its outputs: registers as a bus master sees them, what the motor and the
// temperature make of them, its DIAG pin, and faults by name. It lives on when the board restarts.

import { FULL_STEP } from './tmc_motor.mjs';
import { Receiver, replyTo, edgesOf, wordOf, WRITE } from './tmc_bits.mjs';
import { registersOf } from './tmc_registers.mjs';
import { generator } from './tmc_wire.mjs';

const CLOCK_HZ = 12e6, NEVER_STEPPED = 0xfffff;
const STANDSTILL_CLOCKS = 2 ** 20, POWER_DOWN_CLOCKS = 2 ** 18;
const RANDOM = ['SG_RESULT', 'MSCNT', 'MSCURACT', 'PWM_SCALE', 'PWM_AUTO', 'TSTEP']; // with `measured: 'random'`
const SG_FREE = 400, SG_HALF_SPEED = 60; // SG_RESULT of a free motor, and the full steps/s at which it has half of it
const PIN_MICROSTEPS = { 2209: [8, 32, 64, 16], 2208: [8, 2, 4, 16] }; // by MS1 + 2 * MS2, without mstep_reg_select
const GSTAT_DRIVER_ERROR = 2;
const DRIVER_ERRORS = 0x3e; // of DRV_STATUS: over-temperature shutdown and shorts
const MS = 1e6;

export class Tmc2209 {
    // `address`: by MS1 and MS2. `clock`: of what it should be (1.02: 2 % fast). `skew`: its answers' bits are longer by
    // this share than those of the request. `diag`: pin it drives. `axis` (machine.mjs): whose steps it gets, of which a
    // full step has `microsteps`. `measured`: 'motor', or 'random' for numbers that differ each time they are read.
    constructor({
        board, wire, name, motor, chip = 2209, address = 0, clock = 1, skew = 0, diag = null, axis = null, microsteps = 16,
        measured = 'motor', seed = 1,
    }) {
        Object.assign(this, { board, wire, name, motor, chip, address, skew, diag, axis, measured });
        this.clockHz = CLOCK_HZ * clock;
        this.stepWay = FULL_STEP / microsteps; // of one of the axis's own steps
        this.random = generator(seed);
        this.registers = registersOf(chip);
        this.faults = [];
        this.powered = true;
        this.celsius = 0;       // the highest threshold that has been reached: 0, 120, 143, 150, 157
        this.shorts = 0;        // bits of DRV_STATUS
        this.diagLevel = null;
        this.watching = false;  // an end of a stall is being waited for
        this.receiver = new Receiver({
            at: (nanos, action) => board.at(nanos, action), clockHz: this.clockHz,
            onDatagram: (bytes, end, bit) => this.take(bytes, end, bit),
        });
        this.reset();
    }

    // As after power-up.
    reset() {
        this.values = new Map([...this.registers.values()].map(({ name, reset }) => [name, reset]));
        Object.assign(this, { lastStepNanos: -Infinity, intervalNanos: Infinity, sg: 0 });
        this.updateDiag();
    }

    get(name) { return this.values.get(name) ?? 0; }

    // ---- Datagrams -----------------------------------------------------------------------------------

    take(bytes, endNanos, bitNanos) {
        if (bytes[1] !== this.address || !this.powered) return;
        const { entry } = this.wire, register = bytes[2] & ~WRITE;
        if (this.fault('deaf', entry)) return;
        this.wire.compare(bytes);
        if (bytes[2] & WRITE) {
            this.write(register, wordOf(bytes));
            this.note(entry, { ifcnt: this.get('IFCNT') });
        } else {
            const value = this.read(register);
            this.note(entry, { value });
            this.reply(replyTo(register, value), endNanos, bitNanos, entry);
        }
    }

    note(entry, more) {
        if (entry !== null) Object.assign(entry, { driver: this.name }, more);
    }

    reply(bytes, endNanos, bitNanos, entry) {
        if (this.fault('silent', entry)) return;
        if (this.fault('bad-crc', entry)) bytes[7] ^= 1 + Math.floor(255 * this.random());
        const late = this.fault('late', entry), delayBits = 8 * (this.get('SLAVECONF') >> 8 | 1);
        const lateNanos = late ? (late.delay_ms ?? 2 + 8 * this.random()) * MS : 0;
        const start = endNanos + delayBits * bitNanos + lateNanos;
        this.wire.replyBegins(start, bitNanos);
        const sent = edgesOf(bytes, start, bitNanos * (1 + this.skew)), { board, wire } = this;
        this.note(entry, { reply_ns: start });
        sent.edges.forEach(({ nanos, level }, index) => board.at(nanos, () => {
            if (index === 0) this.receiver.mute();
            if (this.powered) wire.answer(this, level);
            if (!this.powered || !wire.plugged) this.note(entry, { fault: 'cut' });
        }));
        board.at(sent.endNanos, () => {
            wire.answer(this, null);
            this.receiver.listen(wire.level);
        });
    }

    // ---- Registers -----------------------------------------------------------------------------------

    write(address, value) {
        this.values.set('IFCNT', this.get('IFCNT') + 1 & 0xff);
        const register = this.registers.get(address);
        if (register === undefined) return;
        const { name, access, mask } = register;
        if (access.includes('w')) this.values.set(name, (value & mask) >>> 0);
        if (access.includes('c')) this.values.set(name, this.get(name) & ~value);
        this.updateDiag();
    }

    // What an answer carries.
    read(address) {
        const register = this.registers.get(address);
        if (register === undefined || !register.access.includes('r')) return 0;
        const { name, mask } = register;
        if (this.measured === 'random' && RANDOM.includes(name)) {
            this.values.set(name, (Math.floor(2 ** 32 * this.random()) & mask) >>> 0);
            return this.get(name);
        }
        return this.present(name);
    }

    // What a register holds now.
    present(name) {
        switch (name) {
            case 'IOIN': return this.pins();
            case 'TSTEP': return this.tstep();
            case 'SG_RESULT': return this.sg;
            case 'MSCNT': return this.phase();
            case 'MSCURACT': return this.coilCurrents();
            case 'DRV_STATUS': return this.status();
            default: return this.get(name);
        }
    }

    // Every register by name, for tests; also those that a bus master cannot read.
    dump() {
        return Object.fromEntries([...this.registers.values()].map(({ name }) => [name, this.present(name)]));
    }

    pins() {
        const { axis, board } = this, level = (gpio) => (gpio === undefined || gpio === null ? 0 : board.level(gpio));
        const version = this.chip === 2209 ? 0x21 : 0x20;
        return (version << 24 | (this.address & 1) << 2 | (this.address >> 1) << 3 | (this.diagLevel ?? 0) << 4
            | this.wire.level << 6 | level(axis?.step) << 7 | level(axis?.dir) << 9) >>> 0;
    }

    status() {
        const reached = [120, 143, 150, 157].filter((celsius) => this.celsius >= celsius).length;
        const hot = (reached >= 1 ? 1 : 0) | (reached >= 2 ? 2 : 0) | (2 ** reached - 1) << 8;
        return (hot | this.shorts | this.scale() << 16 | (this.stealth ? 1 << 30 : 0) | (this.stands ? 1 << 31 : 0)) >>> 0;
    }

    // The current scale: of the run, and some time after the last step down to that of the hold, one by one.
    scale() {
        const currents = this.get('IHOLD_IRUN'), held = currents & 31, run = currents >> 8 & 31, slow = currents >> 16 & 15;
        const clocks = this.sinceStep * this.clockHz / 1e9 - this.get('TPOWERDOWN') * POWER_DOWN_CLOCKS;
        if (clocks < 0) return run;
        const steps = slow === 0 ? Infinity : Math.floor(clocks / (slow * POWER_DOWN_CLOCKS));
        return run > held ? Math.max(held, run - steps) : held;
    }

    // ---- Motor ---------------------------------------------------------------------------------------

    get stealth() { return (this.get('GCONF') & 4) === 0 && this.tstep() >= this.get('TPWMTHRS'); }
    get sinceStep() { return this.board.now - this.lastStepNanos; }
    get stands() { return this.sinceStep * this.clockHz / 1e9 > STANDSTILL_CLOCKS; }

    microsteps() {
        if ((this.get('GCONF') & 0x80) === 0) return PIN_MICROSTEPS[this.chip][this.address & 3];
        return FULL_STEP >> Math.min(8, this.get('CHOPCONF') >>> 24 & 15);
    }

    // Clocks for a 1/256 microstep, by the last two steps or, if that is longer, the time since the last one.
    tstep() {
        const clocks = Math.max(this.intervalNanos, this.sinceStep) * this.clockHz / 1e9 * this.microsteps() / FULL_STEP;
        return this.stands ? NEVER_STEPPED : Math.min(NEVER_STEPPED, Math.floor(clocks));
    }

    phase() { return this.motor.field & 0x3ff; }

    coilCurrents() {
        const angle = 2 * Math.PI * (this.phase() + 0.5) / 1024, current = (value) => Math.round(248 * value) & 0x1ff;
        return (current(Math.cos(angle)) << 16 | current(Math.sin(angle))) >>> 0;
    }

    // A step pulse, +1 or -1; returns where the axis stands, in its own steps.
    step(direction) {
        const { motor, board } = this, before = Math.floor(motor.field / FULL_STEP);
        const way = (this.get('GCONF') & 8 ? -direction : direction) * FULL_STEP / this.microsteps();
        this.intervalNanos = this.sinceStep;
        this.lastStepNanos = board.now;
        if (this.powered && this.turns) motor.turn(way);
        if (Math.floor(motor.field / FULL_STEP) !== before && this.stealth) this.sg = this.measureLoad();
        this.updateDiag();
        return Math.round(motor.rotor / this.stepWay);
    }

    // Shut down, a motor makes no steps.
    get turns() { return (this.status() & DRIVER_ERRORS) === 0 && (this.get('CHOPCONF') & 15) !== 0; }

    // SG_RESULT: grows with speed, falls with load.
    measureLoad() {
        const fullSteps = this.clockHz / FULL_STEP / Math.max(1, this.tstep());
        return Math.round(SG_FREE * fullSteps / (fullSteps + SG_HALF_SPEED) * this.motor.reserve) & 0x1fe;
    }

    get stalled() {
        if (this.chip !== 2209) return false;
        const tstep = this.tstep(), cool = this.get('TCOOLTHRS');
        return tstep <= cool && tstep > this.get('TPWMTHRS') && this.stealth && this.sg <= 2 * this.get('SGTHRS');
    }

    updateDiag() {
        const level = this.powered && ((this.status() & DRIVER_ERRORS) !== 0 || this.stalled) ? 1 : 0;
        if (level === 1 && !this.watching) this.watchStandstill();
        if (level === this.diagLevel) return;
        this.diagLevel = level;
        if (this.diag !== null) this.board.setPin(this.diag, level);
    }

    // A stall ends with the steps: when they have become too slow.
    watchStandstill() {
        const slowNanos = (this.get('TCOOLTHRS') + 1) * FULL_STEP / this.microsteps() * 1e9 / this.clockHz;
        const due = this.lastStepNanos + slowNanos + 1;
        if (due <= this.board.now || !Number.isFinite(due)) return;
        this.watching = true;
        this.board.at(due, () => {
            this.watching = false;
            this.updateDiag();
        });
    }

    // ---- Faults --------------------------------------------------------------------------------------

    // One that is counted in exchanges: takes one off; null if there is none now.
    fault(name, entry) {
        const now = this.board.now;
        this.faults = this.faults.filter((fault) => fault.times > 0 && now < fault.until);
        const found = this.faults.find((fault) => fault.name === name);
        if (found === undefined) return null;
        found.times -= 1;
        this.note(entry, { fault: name });
        return found;
    }

    checkFault(name) {
        if (Object.hasOwn(FAULTS, name)) return FAULTS[name];
        throw new Error(`no fault is called ${name}; there are ${Object.keys(FAULTS).join(', ')}`);
    }

    // From now on; for `times` exchanges (those that are counted) or for `for_ms`.
    inject(name, { times = Infinity, for_ms: forMs = Infinity, ...options }) {
        const kind = this.checkFault(name);
        const until = this.board.now + forMs * MS;
        this.wire.log.push({
            time_ns: this.board.now, until_ns: Math.min(until, Number.MAX_SAFE_INTEGER), tx: this.wire.tx, kind: 'fault',
            driver: this.name, fault: name,
        });
        if (kind === COUNTED) {
            this.faults.push({ name, times, until, ...options });
            return;
        }
        kind.begin(this, { times, ...options });
        if (Number.isFinite(until) && kind.end) this.board.at(until, () => kind.end(this));
    }

    heal() {
        this.faults = [];
        Object.values(FAULTS).forEach((kind) => kind.end?.(this));
    }

    setPower(on) {
        if (on && !this.powered) this.reset();
        this.powered = on;
        this.updateDiag();
        this.wire.settle();
    }

    setHeat(celsius) {
        this.celsius = celsius;
        if ((this.status() & DRIVER_ERRORS) !== 0) this.values.set('GSTAT', this.get('GSTAT') | GSTAT_DRIVER_ERROR);
        this.updateDiag();
    }

    setShort(bits) {
        this.shorts = bits;
        this.setHeat(this.celsius);
    }
}

const COUNTED = {};
const SHORT = 0x3c, OPEN = 0xc0; // bits of DRV_STATUS

// Each by its name: counted in exchanges, or with a beginning and, for those that last, an end.
const FAULTS = {
    silent: COUNTED,   // takes requests, gives no answer
    'bad-crc': COUNTED, // answers with a wrong check sum
    late: COUNTED,     // answers `delay_ms` (else 2 to 10 ms) after it should
    deaf: COUNTED,     // takes nothing
    garbled: {         // noise in a request or in an answer
        begin: (driver, { times }) => { driver.wire.garbled = times; },
        end: (driver) => { driver.wire.garbled = 0; },
    },
    'brown-out': { begin: (driver) => driver.reset() }, // all settings are lost
    unplugged: { begin: (driver) => driver.wire.setPlugged(false), end: (driver) => driver.wire.setPlugged(true) },
    unpowered: { begin: (driver) => driver.setPower(false), end: (driver) => driver.setPower(true) },
    'over-temperature': { begin: (driver, { celsius = 120 }) => driver.setHeat(celsius), end: (driver) => driver.setHeat(0) },
    short: { begin: (driver, { bits = 4 }) => driver.setShort(bits & SHORT), end: (driver) => driver.setShort(0) },
    'open-load': { begin: (driver, { bits = 0x40 }) => driver.setShort(bits & OPEN), end: (driver) => driver.setShort(0) },
    stall: {           // something holds the axis at step `at`
        begin: (driver, { at }) => driver.motor.block(at * driver.stepWay),
        end: (driver) => driver.motor.block(null),
    },
};

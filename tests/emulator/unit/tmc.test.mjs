// The TMC22xx model against a sender and a reader of bits of our own: bit time, check sum, turn-round, IFCNT, faults by name.
// The board is replaced by a line of time and two pins.

import assert from 'node:assert/strict';
import test from 'node:test';
import { crc8, edgesOf, readRequest, replyTo, writeRequest } from '../src/tmc_bits.mjs';
import { TmcBench } from '../src/tmc_bench.mjs';
import { Axis } from '../src/machine.mjs';

const TX = 5, RX = 6, DIAG = 10, STEP = 2, DIR = 3, BAUD = 115200;
const hex = (text) => text.split(' ').map((byte) => parseInt(byte, 16));

// What the model needs of a board: virtual time, pads with a pull-up, faults.
class Bench {
    constructor(options = {}) {
        this.now = 0;
        this.events = [];
        this.faults = [];
        this.axes = new Map();
        this.outside = new Map();
        this.ours = new Map([[STEP, 0], [DIR, 1]]); // pin -> level we drive; not there: an input with pull-up
        this.trace = [];    // changes of the receiving pin that we do not make: [nanos, level]
        const driven = new Proxy({}, { get: (_, gpio) => this.ours.has(Number(gpio)) });
        this.chip = { S: { pc: 0 }, pads: { driven, connect: (gpio, level, weak) => this.connect(gpio, level, weak) } };
        this.tmc = new TmcBench(this);
        this.listen = options.rx ?? TX;
        this.axes.set('X', new Axis({ step: STEP, dir: DIR }));
        this.drive(TX, 1);
        if (options.driver !== false) this.tmc.add('X', { tx: TX, ...options });
    }

    at(nanos, action) {
        this.events.push({ nanos, action, order: this.events.length });
        this.events.sort((a, b) => a.nanos - b.nanos);
    }

    run(until) {
        while (this.events.length > 0 && this.events[0].nanos <= until) {
            const event = this.events.shift();
            this.now = Math.max(this.now, event.nanos);
            event.action();
        }
        this.now = until;
    }

    level(gpio) { return this.ours.get(gpio) ?? this.outside.get(gpio) ?? 1; }
    fault(text) { this.faults.push(text); }
    setPin(gpio, level) { this.connect(gpio, level); }

    connect(gpio, level) {
        const before = this.level(gpio);
        if (level === null) this.outside.delete(gpio);
        else this.outside.set(gpio, level);
        const now = this.level(gpio);
        if (now === before) return;
        if (gpio === this.listen) this.trace.push([this.now, now]);
        this.tmc.pad(gpio);
    }

    drive(gpio, level) {
        if (level === null) this.ours.delete(gpio);
        else this.ours.set(gpio, level);
        this.tmc.pad(gpio);
    }

    // Sends bytes and lets go of the pin (if `release`); returns when the last stop bit ended.
    send(bytes, { baud = BAUD, release = true } = {}) {
        const start = this.now + 200e3, { edges, endNanos } = edgesOf(bytes, start, 1e9 / baud);
        this.drive(TX, 1);
        edges.forEach(({ nanos, level }) => this.at(nanos, () => this.drive(TX, level)));
        this.run(endNanos);
        if (release) this.drive(TX, null);
        this.trace = [];
        return endNanos;
    }

    // Bytes of an answer, read in the middle of bits whose length is `bitNanos`; and when its first start bit came.
    answer({ baud = BAUD, waitMs = 3 } = {}) {
        const bitNanos = 1e9 / baud, begin = this.now;
        this.run(this.now + waitMs * 1e6 + 200 * bitNanos);
        const at = (nanos) => this.trace.filter(([time]) => time <= nanos).at(-1)?.[1] ?? 1;
        const bytes = [];
        let start = this.trace.find(([, level]) => level === 0)?.[0];
        const first = start;
        while (start !== undefined && bytes.length < 20) {
            let byte = 0;
            for (let bit = 0; bit < 8; bit++) byte |= at(start + (1.5 + bit) * bitNanos) << bit;
            bytes.push(at(start + 9.5 * bitNanos) === 1 ? byte : -1);
            const behind = start + 9.5 * bitNanos;
            start = this.trace.find(([time, level]) => level === 0 && time > behind)?.[0];
        }
        return { bytes, turnBits: first === undefined ? null : (first - begin) / bitNanos };
    }

    read(register, options = {}) {
        this.send(readRequest(options.address ?? 0, register), options);
        return this.answer(options);
    }

    value(register, options = {}) {
        const { bytes } = this.read(register, options);
        if (bytes.length !== 8) return null;
        assert.deepEqual(bytes, replyTo(register, (bytes[3] << 24 | bytes[4] << 16 | bytes[5] << 8 | bytes[6]) >>> 0));
        return (bytes[3] << 24 | bytes[4] << 16 | bytes[5] << 8 | bytes[6]) >>> 0;
    }

    write(register, value, options = {}) {
        this.send(writeRequest(options.address ?? 0, register, value), options);
        this.run(this.now + 1e6);
    }

    steps(count, hz, level = 1) {
        this.drive(DIR, level);
        for (let n = 0; n < count; n++) {
            this.run(this.now + 1e9 / hz);
            this.axes.get('X').edge(STEP, 1, this);
        }
    }
}

test('check sums of known datagrams', () => {
    for (const frame of ['05 00 80 00 00 01 C0 F6', '05 00 90 00 08 19 07 15', '05 01 EC 14 01 01 53 03', '05 00 C0 00 00 00 78 D7']) {
        const bytes = hex(frame);
        assert.equal(crc8(bytes.slice(0, -1)), bytes[7]);
        assert.deepEqual(writeRequest(bytes[1], bytes[2], (bytes[3] << 24 | bytes[4] << 16 | bytes[5] << 8 | bytes[6]) >>> 0), bytes);
    }
});

test('reset values, access and IFCNT', () => {
    const bench = new Bench();
    assert.equal(bench.value(0x00), 0x101);
    assert.equal(bench.value(0x6c), 0x10000053);
    assert.equal(bench.value(0x70), 0xc10d0024);
    assert.equal(bench.value(0x06) >>> 24, 0x21);
    assert.equal(bench.value(0x12), 0xfffff);
    assert.equal(bench.value(0x01), 1);
    bench.write(0x01, 1);
    assert.equal(bench.value(0x01), 0);
    bench.write(0x10, 0x81907);
    assert.equal(bench.value(0x10), 0, 'write only');
    bench.write(0x02, 77);
    bench.write(0x55, 1);
    assert.equal(bench.value(0x02), 4, 'each valid write counts');
    assert.equal(bench.tmc.driver('X').dump().IHOLD_IRUN, 0x81907);
    for (let n = 0; n < 254; n++) bench.write(0x11, n & 0xff);
    assert.equal(bench.value(0x02), 2, 'wraps round');
    assert.deepEqual(bench.faults, []);
});

for (const baud of [9600, 57600, 115200, 250000, 500000]) {
    test(`finds ${baud} baud and answers at it`, () => {
        const bench = new Bench(), { bytes, turnBits } = bench.read(0x6c, { baud });
        assert.deepEqual(bytes, replyTo(0x6c, 0x10000053));
        assert.ok(Math.abs(turnBits - 8) < 0.6, `${turnBits} bit times`);
    });
}

test('each bit of an answer has its place', () => {
    const bench = new Bench({ skew: 0.02 });
    bench.send(readRequest(0, 0x6c));
    bench.answer();
    const bitNanos = 1.02e9 / BAUD, [start] = bench.trace[0];
    bench.trace.forEach(([time]) => {
        const bits = (time - start) / bitNanos;
        assert.ok(Math.abs(bits - Math.round(bits)) < 0.002 * Math.max(1, bits), `${bits}`);
    });
    assert.equal(bench.trace.at(-1)[1], 1);
});

for (const delay of [0, 1, 2, 5, 14, 15]) {
    test(`SENDDELAY ${delay}`, () => {
        const bench = new Bench();
        bench.write(0x03, delay << 8);
        const { turnBits } = bench.read(0x02);
        assert.ok(Math.abs(turnBits - 8 * (delay | 1)) < 0.6, `${turnBits} bit times`);
    });
}

test('clocks that are off by 2 % change nothing on the wire', () => {
    for (const clock of [0.98, 1.02]) {
        const bench = new Bench({ clock });
        assert.equal(bench.value(0x6c, { baud: 500000 }), 0x10000053);
        assert.equal(bench.value(0x6c, { baud: 9600 }), 0x10000053);
    }
});

test('only the addressed driver answers; a 2208 is another chip', () => {
    const bench = new Bench();
    bench.tmc.add('Y', { tx: TX, address: 1 });
    bench.tmc.add('Z', { tx: TX, address: 3, chip: 2208 });
    bench.write(0x6c, 0x11111111, { address: 1 });
    assert.equal(bench.value(0x6c, { address: 1 }), 0x11111111);
    assert.equal(bench.value(0x6c), 0x10000053);
    assert.equal(bench.value(0x02, { address: 0 }), 0);
    assert.equal(bench.value(0x02, { address: 2 }), null);
    assert.equal(bench.value(0x06, { address: 3 }) >>> 24, 0x20);
    assert.equal(bench.value(0x06, { address: 1 }) >>> 2 & 3, 1);
    assert.deepEqual(bench.faults, []);
});

test('an early answer upsets the other drivers until the line has been idle', () => {
    for (const [delay, pause, answers] of [[0, 5, false], [0, 13, true], [2, 5, true]]) {
        const bench = new Bench(), bitNanos = 1e9 / BAUD;
        bench.tmc.add('Y', { tx: TX, address: 1 });
        bench.write(0x03, delay << 8);
        const end = bench.send(readRequest(0, 0x02)) + (8 * (delay | 1) + 80 + pause) * bitNanos;
        bench.run(end);
        const { edges, endNanos } = edgesOf(readRequest(1, 0x02), end, bitNanos);
        bench.drive(TX, 1);
        edges.forEach(({ nanos, level }) => bench.at(nanos, () => bench.drive(TX, level)));
        bench.run(endNanos);
        bench.drive(TX, null);
        bench.trace = [];
        assert.equal(bench.answer().bytes.length === 8, answers, `SENDDELAY ${delay}, ${pause} bit times`);
    }
});

test('what is no datagram is taken for none, and the next one is understood', () => {
    const bench = new Bench();
    const wrong = writeRequest(0, 0x6c, 1);
    wrong[7] ^= 0x10;
    bench.send(wrong);
    bench.run(bench.now + 1e6);
    bench.send([0x0a, ...wrong.slice(1)]);
    bench.run(bench.now + 1e6);
    bench.send(writeRequest(0, 0x6c, 1).slice(0, 6)); // the rest never comes
    bench.run(bench.now + 64e9 / BAUD);
    assert.equal(bench.value(0x02), 0);
    assert.equal(bench.value(0x6c), 0x10000053);
});

test('behind an error the line must be idle for 12 bit times', () => {
    for (const [pause, answers] of [[5, false], [14, true]]) {
        const bench = new Bench(), bitNanos = 1e9 / BAUD, wrong = readRequest(0, 0x6c);
        wrong[3] ^= 1;
        bench.send(wrong, { release: false });
        const { edges, endNanos } = edgesOf(readRequest(0, 0x6c), bench.now + pause * bitNanos, bitNanos);
        edges.forEach(({ nanos, level }) => bench.at(nanos, () => bench.drive(TX, level)));
        bench.run(endNanos);
        bench.drive(TX, null);
        bench.trace = [];
        assert.equal(bench.answer().bytes.length === 8, answers, `${pause} bit times`);
    }
});

test('a short pulse on the idle line costs nothing when the line has been idle behind it', () => {
    const bench = new Bench();
    bench.drive(TX, 0);
    bench.run(bench.now + 1000);
    bench.drive(TX, 1);
    assert.equal(bench.value(0x6c), 0x10000053); // 200 us later
});

test('a receiving pin of its own sees both sides; the sending pin may stay high', () => {
    const bench = new Bench({ rx: RX });
    bench.send(readRequest(0, 0x6c), { release: false });
    assert.equal(bench.level(RX), 1);
    assert.deepEqual(bench.answer().bytes, replyTo(0x6c, 0x10000053));
    bench.drive(TX, 0);
    assert.equal(bench.level(RX), 0);
    assert.deepEqual(bench.faults, []);
});

test('driving while a driver answers is a fault', () => {
    const one = new Bench();
    one.send(readRequest(0, 0x6c), { release: false });
    one.answer();
    assert.equal(one.faults.length > 0, true);
    const two = new Bench({ rx: RX });
    const end = two.send(readRequest(0, 0x6c), { release: false });
    two.at(end + 9e9 / BAUD, () => two.drive(TX, 0));
    two.answer();
    assert.equal(two.faults.length > 0, true);
});

test('faults that are counted end after so many exchanges', () => {
    const bench = new Bench();
    bench.tmc.inject('silent', null, null, { times: 2 });
    assert.deepEqual([0, 1, 2].map(() => bench.value(0x6c)), [null, null, 0x10000053]);
    bench.tmc.inject('deaf', 'X', null, { times: 1 });
    bench.write(0x6c, 5);
    assert.equal(bench.value(0x6c), 0x10000053);
    bench.tmc.inject('bad-crc', 'X', null, { times: 1 });
    const { bytes } = bench.read(0x6c);
    assert.notEqual(bytes[7], replyTo(0x6c, 0x10000053)[7]);
    assert.deepEqual(bytes.slice(0, 7), replyTo(0x6c, 0x10000053).slice(0, 7));
    bench.tmc.inject('late', 'X', null, { times: 1, delay_ms: 4 });
    const { bytes: late, turnBits } = bench.read(0x6c, { waitMs: 6 });
    assert.equal(late.length, 8);
    assert.ok(Math.abs(turnBits - 8 - 4e-3 * BAUD) < 1);
    assert.throws(() => bench.tmc.inject('toString', null, null, {}), /no fault is called/);
});

test('noise spoils exchanges, and no more than asked for', () => {
    const bench = new Bench({ seed: 4 });
    bench.tmc.inject('garbled', 'X', null, { times: 40 });
    let spoilt = 0;
    for (let n = 0; n < 40; n++) {
        const { bytes } = bench.read(0x6c);
        if (JSON.stringify(bytes) !== JSON.stringify(replyTo(0x6c, 0x10000053))) spoilt += 1;
        bench.run(bench.now + 1e6);
    }
    assert.ok(spoilt >= 30, `${spoilt} of 40`);
    assert.equal(bench.value(0x6c), 0x10000053);
    assert.deepEqual(bench.faults, []);
});

test('brown-out, unplugged, without power, hot', () => {
    const bench = new Bench({ diag: DIAG });
    bench.write(0x01, 1);
    bench.write(0x10, 0x1f1f);
    bench.tmc.inject('brown-out', 'X', null, {});
    assert.deepEqual([bench.value(0x01), bench.value(0x02)], [1, 0]);
    assert.equal(bench.tmc.driver('X').dump().IHOLD_IRUN, 0x11f10);
    bench.tmc.inject('unplugged', 'X', null, { for_ms: 20 });
    assert.equal(bench.value(0x01), null);
    bench.run(bench.now + 20e6);
    assert.equal(bench.value(0x01), 1);
    bench.tmc.inject('unpowered', 'X', null, { for_ms: 20 });
    bench.drive(TX, null);
    assert.equal(bench.level(TX), 0);
    bench.drive(TX, 1);
    assert.equal(bench.level(TX), 1);
    bench.run(bench.now + 20e6);
    assert.equal(bench.value(0x02), 0);
    bench.tmc.inject('over-temperature', 'X', null, {});
    assert.equal(bench.value(0x6f) & 0xfff, 0x101);
    assert.equal(bench.level(DIAG), 0);
    bench.tmc.inject('over-temperature', 'X', null, { celsius: 150 });
    assert.equal(bench.value(0x6f) & 0xfff, 0x703);
    assert.equal(bench.level(DIAG), 1);
    bench.tmc.heal(null);
    assert.equal(bench.value(0x01) & 2, 2, 'driver error is kept');
    assert.equal(bench.level(DIAG), 0);
    assert.deepEqual(bench.faults, []);
});

// A motor at 16 microsteps whose StallGuard is armed.
function armed(options) {
    const bench = new Bench({ diag: DIAG, axis: 'X', ...options });
    bench.write(0x00, 0x1c0);
    bench.write(0x6c, 0x14010153);
    bench.write(0x14, 200);
    bench.write(0x40, 60);
    return bench;
}

test('what the motor does is in the registers', () => {
    const bench = armed({});
    bench.steps(1600, 8000); // 500 full steps/s
    const { axes, tmc } = bench;
    assert.equal(axes.get('X').at, 1600);
    const shown = tmc.driver('X').dump();
    assert.equal(shown.TSTEP, Math.floor(12e6 / 8000 / 16));
    assert.equal(shown.MSCNT, 1600 * 16 % 1024);
    assert.ok(shown.SG_RESULT > 120 && shown.SG_RESULT % 2 === 0);
    assert.equal(shown.DRV_STATUS >>> 30, 1, 'stealth, not at rest');
    assert.equal(bench.level(DIAG), 0);
    bench.run(bench.now + 100e6);
    assert.equal(tmc.driver('X').dump().TSTEP, 0xfffff);
    assert.equal(tmc.driver('X').dump().DRV_STATUS >>> 30, 3);
});

test('a stop holds the rotor, DIAG rises within two full steps, and it slips by four', () => {
    const bench = armed({ low: -800 });
    bench.steps(799, 8000, 0);
    assert.equal(bench.level(DIAG), 0);
    bench.steps(33, 8000, 0); // two full steps behind the stop
    assert.deepEqual([bench.level(DIAG), bench.axes.get('X').at], [1, -800]);
    bench.run(bench.now + 10e6);
    assert.equal(bench.level(DIAG), 0, 'too slow');
    bench.steps(40, 8000, 0);
    assert.equal(bench.tmc.motor('X').slips, 1);
    bench.steps(800, 8000, 1);
    assert.equal(bench.axes.get('X').at, 800 - 832 - 40 + 64);
});

test('a fault by name holds the motor on its way', () => {
    const bench = armed({});
    bench.tmc.inject('stall', 'X', null, { at: 500 });
    bench.steps(560, 8000);
    assert.deepEqual([bench.level(DIAG), bench.axes.get('X').at <= 500], [1, true]);
    bench.write(0x14, 0);
    assert.equal(bench.level(DIAG), 0, 'disarmed');
});

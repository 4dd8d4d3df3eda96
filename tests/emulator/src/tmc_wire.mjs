// The wire between the board and its TMC22xx drivers: the board's sending pin behind 1 kilohm, the drivers' PDN_UART pins,
// and, where it is a pin of its own, the receiving pin beside them. A driver that answers wins against the resistor.
//
// With one pin the board must have let go of it by then: different levels from both sides are a fault of the board. With
// a receiving pin of its own the sending pin may stay high, but not low.
//
// Every datagram that the board begins gets an entry in the log, by a listener at the board's side of the resistor;
// the drivers add what became of it.

import { Receiver, WRITE, wordOf } from './tmc_bits.mjs';

const LISTENER_HZ = 48e6;

// Small, fast and the same in every run.
export function generator(seed) {
    let x = seed | 0 || 1;
    return () => {
        x ^= x << 13;
        x ^= x >>> 17;
        x ^= x << 5;
        return (x >>> 0) / 2 ** 32;
    };
}

function describe(bytes) {
    const written = (bytes[2] & WRITE) !== 0;
    return {
        kind: written ? 'write' : 'read', address: bytes[1], register: bytes[2] & ~WRITE, bytes,
        ...(written ? { sent: wordOf(bytes) } : {}),
    };
}

export class Wire {
    // `tx`, `rx`: the board's pins (`rx` null: the same); `log`: takes the entries.
    constructor({ board, tx, rx = null, log, seed = 1 }) {
        Object.assign(this, { board, tx, rx, log });
        this.random = generator(seed);
        this.drivers = [];
        this.answers = new Map(); // driver -> the level it drives
        this.noise = null;        // a level from elsewhere, stronger than all
        this.plugged = true;
        this.garbled = 0;         // so many more exchanges get noise
        this.garbledReply = false;
        this.compareWith = null;  // the bytes of the datagram that the board sent last
        this.understood = null;   // and those that a driver took for it
        this.entry = null;        // of the datagram that the board began last
        this.fighting = false;
        this.listener = new Receiver({
            at: (nanos, action) => board.at(nanos, action), clockHz: LISTENER_HZ,
            onSync: (start, bitNanos) => this.begun(start, bitNanos),
            onDatagram: (bytes) => this.sent(bytes),
            onError: (why) => { if (this.entry !== null && this.entry.kind === undefined) this.entry.error = why; },
        });
    }

    get pads() { return this.board.chip.pads; }

    // ---- Levels --------------------------------------------------------------------------------------

    // What drives the line beyond the resistor; null: nothing.
    get outside() {
        if (!this.plugged) return null;
        if (this.noise !== null) return this.noise;
        if (this.answers.size > 0) return Math.min(...this.answers.values());
        return null;
    }

    // Without its supply a driver pulls the line low, weaker than the board's pin.
    get heldLow() {
        return this.plugged && this.drivers.some((driver) => !driver.powered);
    }

    get level() {
        return this.plugged ? this.outside ?? this.board.level(this.tx) : 1;
    }

    // The board's sending pin, or what drives from outside, has changed.
    settle() {
        const { board, tx, rx, outside } = this;
        if (board.chip === null) return;
        const weak = this.heldLow ? 0 : null, driven = this.pads.driven[tx];
        this.pads.connect(tx, outside ?? weak, true);
        if (rx !== null) {
            const through = !this.plugged ? null : driven ? board.level(tx) : weak;
            this.pads.connect(rx, outside ?? through, outside === null);
        }
        this.checkFight();
        if (driven) this.listener.edge(board.now, board.level(tx));
        this.drivers.forEach((driver) => driver.receiver.edge(board.now, this.level));
    }

    checkFight() {
        const { board, tx, rx, answers } = this, ours = board.level(tx);
        const against = this.plugged && this.pads.driven[tx] && [...answers.values()].some((level) => level !== ours);
        const fights = against && (rx === null || ours === 0);
        if (fights && !this.fighting) board.fault(`GPIO${tx} is driven while a TMC driver answers`, board.chip.S.pc);
        this.fighting = fights;
    }

    // A driver drives the line, or lets go of it (null).
    answer(driver, level) {
        if (level === null) this.answers.delete(driver);
        else this.answers.set(driver, level);
        this.settle();
    }

    setPlugged(plugged) {
        this.plugged = plugged;
        this.settle();
    }

    // ---- Noise ---------------------------------------------------------------------------------------

    // From `start` on the drivers' side of the line has the wrong level for `nanos`.
    disturb(start, nanos) {
        this.board.at(start, () => {
            this.noise = 1 - this.level;
            this.settle();
        });
        this.board.at(start + nanos, () => {
            this.noise = null;
            this.settle();
        });
    }

    noiseWithin(start, bits, bitNanos) {
        this.disturb(start + this.random() * bits * bitNanos, (0.7 + 5 * this.random()) * bitNanos);
        if (this.entry !== null) this.entry.fault = 'garbled';
    }

    // The board has begun a datagram.
    begun(start, bitNanos) {
        this.entry = { time_ns: start, tx: this.tx, bit_ns: bitNanos };
        this.log.push(this.entry);
        this.garbledReply = false;
        this.compareWith = this.understood = null;
        if (this.garbled === 0) return;
        this.garbled -= 1;
        if (this.random() < 0.5) this.noiseWithin(start + 5 * bitNanos, 33, bitNanos);
        else this.garbledReply = true;
    }

    // The board has sent a datagram; noise may have made another one of it for the drivers, which decode it at the same time.
    sent(bytes) {
        Object.assign(this.entry, describe(bytes));
        this.compareWith = bytes;
        this.markMistaken();
    }

    compare(bytes) {
        this.understood = bytes;
        this.markMistaken();
    }

    markMistaken() {
        const { compareWith, understood } = this;
        if (compareWith === null || understood === null) return;
        if (compareWith.some((byte, index) => byte !== understood[index])) this.entry.mistook = understood;
    }

    // A driver is about to answer: noise in its bits, or a false start bit before them.
    replyBegins(start, bitNanos) {
        if (!this.garbledReply) return;
        this.garbledReply = false;
        if (this.random() < 0.25) {
            this.disturb(start - 1.5 * bitNanos, (0.1 + this.random()) * bitNanos);
            this.entry.fault = 'garbled';
        } else {
            this.noiseWithin(start, 79, bitNanos);
        }
    }
}

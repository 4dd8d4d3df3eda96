// The bits of a TMC22xx's wire: check sum, a receiver that finds the bit time in the sync nibble of each datagram, and the
// edges of an answer. Times are nanoseconds on the board's line of time.
// Source: TMC2209 data sheet, section 4 (UART single wire interface).

const SYNC = 0x05, MASTER = 0xff;
export const WRITE = 0x80;
const SHORT = 4, LONG = 8;           // bytes of a request to read, of everything else
const GLITCH_CLOCKS = 16;            // a shorter pulse on an idle line is an error
const SLOWEST_BAUD = 9000, BAUD_BEFORE = 115200; // before it has measured any
const SYNC_TOLERANCE = 0.09;         // of a bit: how far an edge of the sync nibble may be from its place
const RECOVERY_BITS = 12;            // of idle line behind an error
const PAUSE_BITS = 63;               // between the start bits of two bytes, at most
const SYNC_EDGES = 5;                // start bit and 1, 0, 1, 0

const IDLE = 'idle', MEASURE = 'measure', BYTE = 'byte', BETWEEN = 'between', RECOVER = 'recover', MUTED = 'muted';

// CRC-8 with the polynomial x^8 + x^2 + x + 1 over the bytes, each from its lowest bit on.
export function crc8(bytes) {
    let crc = 0;
    for (const byte of bytes) {
        for (let bit = 0; bit < 8; bit++) {
            const carry = (crc >> 7 ^ byte >> bit) & 1;
            crc = (crc << 1 & 0xff) ^ (carry ? 0x07 : 0);
        }
    }
    return crc;
}

const withCrc = (bytes) => [...bytes, crc8(bytes)];

const wordBytes = (value) => [value >>> 24, value >>> 16 & 0xff, value >>> 8 & 0xff, value & 0xff];

export const readRequest = (address, register) => withCrc([SYNC, address, register]);
export const writeRequest = (address, register, value) => withCrc([SYNC, address, register | WRITE, ...wordBytes(value)]);
export const replyTo = (register, value) => withCrc([SYNC, MASTER, register, ...wordBytes(value)]);

export const wordOf = (bytes) => (bytes[3] << 24 | bytes[4] << 16 | bytes[5] << 8 | bytes[6]) >>> 0;

// The changes of level [{ nanos, level }] of bytes whose first start bit begins at `start`, the line being high before
// and behind them; and when the last stop bit ends.
export function edgesOf(bytes, start, bitNanos) {
    const edges = [];
    let level = 1;
    bytes.forEach((byte, index) => {
        const frame = byte << 1 | 1 << 9; // start bit, data, stop bit
        for (let bit = 0; bit < 10; bit++) {
            const wanted = frame >> bit & 1;
            if (wanted !== level) edges.push({ nanos: start + (10 * index + bit) * bitNanos, level: wanted });
            level = wanted;
        }
    });
    return { edges, endNanos: start + 10 * bytes.length * bitNanos };
}

export class Receiver {
    // `at(nanos, action)` schedules. `clockHz`: the receiver measures time in these clocks.
    // `onDatagram(bytes, endNanos, bitNanos)`: one that is whole; `onError(why)`: what was on the line was none;
    // `onSync(startNanos, bitNanos)`: a datagram begins.
    constructor({ at, clockHz, onDatagram, onError = () => {}, onSync = () => {} }) {
        Object.assign(this, { at, clockHz, onDatagram, onError, onSync });
        this.level = 1;
        this.state = IDLE;
        this.edges = [];         // of the byte under way: its start, then each change
        this.bytes = [];
        this.bitNanos = 1e9 / BAUD_BEFORE;
        this.riseNanos = -Infinity; // since when the line has been high
        this.beginNanos = 0;     // of the datagram under way
        this.endNanos = -Infinity; // of the last one
        this.turn = 0;           // outdates what has been scheduled
    }

    // The line has changed.
    edge(nanos, level) {
        if (level === this.level) return;
        this.level = level;
        if (this.state === IDLE && level === 0) this.begin(nanos);
        else if (this.state === MEASURE) this.measure(nanos, level);
        else if (this.state === BYTE) this.edges.push(nanos);
        else if (this.state === BETWEEN && level === 0) this.next(nanos);
        else if (this.state === RECOVER && level === 0) this.beginAfterIdle(nanos);
        if (level === 1) this.riseNanos = nanos;
    }

    begin(nanos) {
        this.state = MEASURE;
        this.beginNanos = nanos;
        this.edges = [nanos];
        this.bytes = [];
    }

    beginAfterIdle(nanos) {
        if (nanos - this.riseNanos >= RECOVERY_BITS * this.bitNanos) this.begin(nanos);
    }

    fail(why) {
        this.state = RECOVER;
        this.turn += 1;
        this.onError(why);
    }

    // An edge of the first byte, before its bit time is known.
    measure(nanos, level) {
        const { edges } = this, [start, rise] = edges;
        if (edges.length === 1) {
            const low = nanos - start;
            if (low * this.clockHz < GLITCH_CLOCKS * 1e9) return this.fail('glitch');
            if (low > 1e9 / SLOWEST_BAUD) return this.fail('low for too long');
        } else if (level === 0 && nanos - this.riseNanos >= RECOVERY_BITS * (rise - start)) {
            this.onError('no sync');
            return this.begin(nanos);
        }
        edges.push(nanos);
        if (edges.length === SYNC_EDGES) this.takeBitTime(edges);
    }

    takeBitTime(edges) {
        const [start] = edges, bits = SYNC_EDGES - 1;
        const clocks = Math.floor((edges[bits] - start) * this.clockHz / 1e9);
        const bitNanos = clocks * 1e9 / this.clockHz / bits;
        const wrong = edges.some((nanos, bit) => Math.abs(nanos - start - bit * bitNanos) > SYNC_TOLERANCE * bitNanos);
        if (wrong || bitNanos > 1e9 / SLOWEST_BAUD) return this.fail('no sync');
        this.bitNanos = bitNanos;
        this.onSync(start, bitNanos);
        this.receive();
    }

    // The byte whose start bit is known is complete in the middle of its stop bit.
    receive() {
        this.state = BYTE;
        const turn = ++this.turn;
        this.at(this.edges[0] + 9.5 * this.bitNanos, () => { if (turn === this.turn) this.complete(); });
    }

    sample(nanos) {
        return this.edges.filter((edge) => edge <= nanos).length % 2 === 0 ? 1 : 0;
    }

    complete() {
        const { edges, bitNanos } = this;
        let frame = 0;
        for (let bit = 0; bit < 10; bit++) frame |= this.sample(edges[0] + (bit + 0.5) * bitNanos) << bit;
        if ((frame & 1) !== 0) return this.fail('no start bit');
        if ((frame >> 9 & 1) === 0) return this.fail('no stop bit');
        this.bytes.push(frame >> 1 & 0xff);
        this.state = BETWEEN;
        const { bytes } = this;
        if (bytes.length < 3) return;
        if (bytes.length === (bytes[2] & WRITE || bytes[1] === MASTER ? LONG : SHORT)) this.finish();
    }

    finish() {
        const { bytes, bitNanos } = this;
        if (crc8(bytes.slice(0, -1)) !== bytes.at(-1)) return this.fail('check sum');
        const early = this.beginNanos - this.endNanos < RECOVERY_BITS * bitNanos;
        this.endNanos = this.edges[0] + 10 * bitNanos;
        // The answer of another driver with a SENDDELAY below 2.
        if (bytes[1] === MASTER && early) return this.fail('answer too early');
        this.state = IDLE;
        this.onDatagram(bytes, this.endNanos, bitNanos);
    }

    // The start bit of a byte behind the first.
    next(nanos) {
        if (nanos - this.edges[0] > PAUSE_BITS * this.bitNanos) {
            this.onError('pause');
            return this.begin(nanos);
        }
        this.edges = [nanos];
        this.receive();
    }

    // While the chip speaks itself it does not listen.
    mute() {
        this.turn += 1;
        this.state = MUTED;
    }

    listen(level) {
        this.state = IDLE;
        this.level = level;
    }
}

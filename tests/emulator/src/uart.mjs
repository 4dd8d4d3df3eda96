// UART0 and UART1 with the time a byte takes on the wire, real FIFO depths and the interrupts that go with them
// (rp2040js sends at once and has no transmit FIFO). Bytes go out and come in as bytes: the pins show no waveform.
// Source: RP2040 data sheet, 4.2 (ARM PL011).

const FIFO_DEPTH = 32, TRIGGER = [4, 8, 16, 24, 28];
const INT = { RX: 1 << 4, TX: 1 << 5, TIMEOUT: 1 << 6, OVERRUN: 1 << 10 };
const FR = { BUSY: 1 << 3, RXFE: 1 << 4, TXFF: 1 << 5, RXFF: 1 << 6, TXFE: 1 << 7 };
const CR = { ENABLE: 1, TXE: 1 << 8, RXE: 1 << 9 };
const FIFO_ENABLE = 1 << 4, PARITY_ENABLE = 1 << 1, TWO_STOP_BITS = 1 << 3;
const IDENTITY = { 0xfe0: 0x11, 0xfe4: 0x10, 0xfe8: 0x34, 0xfec: 0, 0xff0: 0x0d, 0xff4: 0xf0, 0xff8: 0x05, 0xffc: 0xb1 };
const FUNCTION_UART = 2;
const TX_PINS = [[0, 12, 16, 28], [4, 8, 20, 24]];

export class Uart {
    // Takes the place of rp2040js's `mcu.uart[index]`. `onByte(byte)`: a byte has left completely.
    constructor({ mcu, clock, index, onByte }) {
        Object.assign(this, { mcu, clock, index, onByte });
        this.stock = mcu.uart[index];
        this.registers = { ibrd: 0, fbrd: 0, lcr: 0, cr: CR.TXE | CR.RXE, ifls: 0x12, imsc: 0, dmacr: 0 };
        this.raw = 0;        // raw interrupt status
        this.sending = [];   // transmit FIFO
        this.shifting = null; // byte on the wire
        this.received = [];  // receive FIFO
        this.incoming = [];  // bytes the other side still has to send
        this.lost = 0;       // received bytes that found the FIFO full
        this.sendAlarm = clock.createAlarm(() => this.sent());
        this.receiveAlarm = clock.createAlarm(() => this.arrived());
        this.timeoutAlarm = clock.createAlarm(() => this.raise(INT.TIMEOUT));
        this.stock.readUint32 = (offset) => this.read(offset);
        this.stock.writeUint32 = (offset, value) => this.write(offset, value);
    }

    bitNanos() {
        const { ibrd, fbrd } = this.registers;
        return (ibrd + fbrd / 64) * 16 * 1e9 / this.mcu.clkPeri;
    }

    frameNanos() {
        const { lcr } = this.registers;
        const bits = 1 + 5 + (lcr >> 5 & 3) + (lcr & PARITY_ENABLE ? 1 : 0) + (lcr & TWO_STOP_BITS ? 2 : 1);
        return bits * this.bitNanos();
    }

    depth() {
        return this.registers.lcr & FIFO_ENABLE ? FIFO_DEPTH : 1;
    }

    sendTrigger() { return this.depth() > 1 ? TRIGGER[this.registers.ifls & 7] : 0; }
    receiveTrigger() { return this.depth() > 1 ? TRIGGER[this.registers.ifls >> 3 & 7] : 1; }

    raise(bits) {
        this.raw |= bits;
        this.update();
    }

    update() {
        this.mcu.setInterrupt(this.stock.irq, (this.raw & this.registers.imsc) !== 0);
        const { dma } = this.mcu, { dreq } = this.stock;
        if (this.registers.cr & CR.ENABLE && this.sending.length < this.depth()) dma.setDREQ(dreq.tx);
        else dma.clearDREQ(dreq.tx);
        if (this.received.length > 0) dma.setDREQ(dreq.rx);
        else dma.clearDREQ(dreq.rx);
    }

    // ---- Sending -------------------------------------------------------------------------------------

    send(byte) {
        if (this.sending.length < this.depth()) this.sending.push(byte);
        if (this.sending.length > this.sendTrigger()) this.raw &= ~INT.TX;
        this.startSending();
        this.update();
    }

    startSending() {
        const on = CR.ENABLE | CR.TXE;
        if (this.shifting !== null || this.sending.length === 0 || (this.registers.cr & on) !== on) return;
        this.shifting = this.sending.shift();
        if (this.sending.length === this.sendTrigger()) this.raw |= INT.TX;
        this.sendAlarm.schedule(this.frameNanos());
    }

    sent() {
        const byte = this.shifting;
        this.shifting = null;
        if (TX_PINS[this.index].some((gpio) => this.mcu.gpio[gpio].functionSelect === FUNCTION_UART)) this.onByte(byte);
        this.startSending();
        this.update();
    }

    // ---- Receiving -----------------------------------------------------------------------------------

    // The other side sends these bytes, one frame after the other.
    feed(bytes) {
        const idle = this.incoming.length === 0;
        this.incoming.push(...bytes);
        if (idle && bytes.length > 0) this.receiveAlarm.schedule(this.frameNanos());
    }

    arrived() {
        const byte = this.incoming.shift(), on = CR.ENABLE | CR.RXE;
        const listens = (this.registers.cr & on) === on
            && TX_PINS[this.index].some((gpio) => this.mcu.gpio[gpio + 1].functionSelect === FUNCTION_UART);
        if (listens) this.receive(byte);
        if (this.incoming.length > 0) this.receiveAlarm.schedule(this.frameNanos());
    }

    receive(byte) {
        if (this.received.length >= this.depth()) {
            this.lost += 1;
            this.raw |= INT.OVERRUN;
        } else {
            this.received.push(byte);
        }
        if (this.received.length >= this.receiveTrigger()) this.raw |= INT.RX;
        this.timeoutAlarm.schedule(32 * this.bitNanos());
        this.update();
    }

    take() {
        const byte = this.received.shift() ?? 0;
        if (this.received.length < this.receiveTrigger()) this.raw &= ~INT.RX;
        if (this.received.length === 0) {
            this.raw &= ~INT.TIMEOUT;
            this.timeoutAlarm.cancel();
        }
        this.update();
        return byte;
    }

    // ---- Registers -----------------------------------------------------------------------------------

    flags() {
        const sendEmpty = this.sending.length === 0;
        return (sendEmpty ? FR.TXFE : 0) | (this.sending.length >= this.depth() ? FR.TXFF : 0)
            | (this.shifting !== null || !sendEmpty ? FR.BUSY : 0)
            | (this.received.length === 0 ? FR.RXFE : 0) | (this.received.length >= this.depth() ? FR.RXFF : 0);
    }

    read(offset) {
        const r = this.registers;
        switch (offset) {
            case 0x00: return this.take();
            case 0x04: return 0;
            case 0x18: return this.flags();
            case 0x24: return r.ibrd;
            case 0x28: return r.fbrd;
            case 0x2c: return r.lcr;
            case 0x30: return r.cr;
            case 0x34: return r.ifls;
            case 0x38: return r.imsc;
            case 0x3c: return this.raw;
            case 0x40: return this.raw & r.imsc;
            case 0x48: return r.dmacr;
            default: return IDENTITY[offset] ?? 0;
        }
    }

    write(offset, value) {
        const r = this.registers;
        switch (offset) {
            case 0x00: return this.send(value & 255);
            case 0x24: r.ibrd = value & 0xffff; break;
            case 0x28: r.fbrd = value & 0x3f; break;
            case 0x2c: r.lcr = value & 0xff; break;
            case 0x30: r.cr = value & 0xffff; this.startSending(); break;
            case 0x34: r.ifls = value & 0x3f; break;
            case 0x38: r.imsc = value & 0x7ff; break;
            case 0x44: this.raw &= ~this.stock.rawWriteValue; break;
            case 0x48: r.dmacr = value & 7; break;
            default:
        }
        this.update();
    }
}

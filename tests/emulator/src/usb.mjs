// The USB host on the other end of the cable: enumerates the board, opens its first CDC serial port and moves bytes
// both ways with the flow control of the bus: a buffer the host does not collect or fill stays armed, so nothing is
// lost and an idle line costs the firmware nothing. One packet takes PACKET_NANOS, a frame starts every millisecond.
// An unplugged cable looks to the chip, which has power from elsewhere, like a bus that is idle: suspended. No errors on the wire.
// Source: RP2040 data sheet 4.1 (buffer control), USB 2.0 chapter 9, CDC PSTN 1.2.

const ATTACH_NANOS = 10e6, SETTLE_NANOS = 1e6, PACKET_NANOS = 50e3, FRAME_NANOS = 1e6;
const PACKET_SIZE = 64;
const BUFFER = { AVAILABLE: 1 << 10, STALL: 1 << 11, FULL: 1 << 15, LENGTH: 0x3ff };
const EP_DOUBLE_BUFFERED = 1 << 30, SIE_PULLUP = 1 << 16;
const SOF_RD = 0x48, INTR_SOF = 1 << 17;
const SIE_STATUS = 0x50, SIE_SUSPENDED = 1 << 4, SUSPEND_NANOS = 3e6;
const FIRST_BUFFER_CONTROL = 0x80, LAST_BUFFER_CONTROL = 0xfc;
const DESCRIPTOR = { DEVICE: 1, CONFIGURATION: 2, INTERFACE: 4, ENDPOINT: 5 };
const CLASS_CDC = 2, CLASS_DATA = 10, BULK = 2;
const DTR = 1, RTS = 2;

function setup(type, request, value, index, length) {
    return Uint8Array.of(type, request, value & 255, value >> 8, index & 255, index >> 8, length & 255, length >> 8);
}

// Interface and endpoint numbers of the first serial port in a configuration descriptor; null: there is none.
export function findSerialPort(descriptor) {
    let control = null, dataInterface = false;
    const port = { control: 0, in: 0, out: 0 };
    for (let i = 0; i + 1 < descriptor.length && descriptor[i] >= 2; i += descriptor[i]) {
        const type = descriptor[i + 1];
        if (type === DESCRIPTOR.INTERFACE) {
            if (descriptor[i + 5] === CLASS_CDC && control === null) control = descriptor[i + 2];
            dataInterface = descriptor[i + 5] === CLASS_DATA && control !== null;
        } else if (type === DESCRIPTOR.ENDPOINT && dataInterface && (descriptor[i + 3] & 3) === BULK) {
            const address = descriptor[i + 2], side = address & 0x80 ? 'in' : 'out';
            port[side] ||= address & 15;
        }
        if (port.in && port.out) return { ...port, control };
    }
    return null;
}

export class UsbHost {
    // `onData(bytes)`: the board sent something. `onConnected()`: the port is open, DTR set.
    constructor({ mcu, clock, onData, onConnected }) {
        Object.assign(this, { mcu, clock, usb: mcu.usbCtrl, onData, onConnected });
        this.port = null;
        this.connected = false;
        this.attached = false;
        this.plugged = true;
        this.reading = true;
        this.queue = [];      // bytes for the board
        this.armed = new Map(); // buffer control offset -> alarm of the packet under way or waiting
        this.requests = [];   // control transfers to do, first one under way
        this.settle = clock.createAlarm(() => this.enumerate());
        this.frame = clock.createAlarm(() => this.startFrame());
        this.idle = clock.createAlarm(() => this.suspend());
        this.install();
    }

    install() {
        const { usb } = this, control = usb.handleSieCtrlWrite.bind(usb);
        usb.handleSieCtrlWrite = (value) => {
            control(value);
            const pulledUp = (value & SIE_PULLUP) !== 0;
            if (pulledUp && !this.attached) usb.resetAlarm.schedule(ATTACH_NANOS);
            this.attached = pulledUp;
            if (!pulledUp) this.connected = false;
        };
        usb.onResetReceived = () => {
            this.settle.schedule(SETTLE_NANOS);
            this.frame.schedule(FRAME_NANOS);
        };
        const read = usb.readUint32.bind(usb);
        usb.readUint32 = (offset) => {
            if (offset === SOF_RD) this.setFrameInterrupt(false); // reading it acknowledges
            return read(offset);
        };
        const write = usb.writeUint32.bind(usb);
        usb.writeUint32 = (offset, value) => {
            if (offset === SIE_STATUS) usb.sieStatus &= ~(usb.rawWriteValue & SIE_SUSPENDED); // acknowledges the interrupt
            write(offset, value);
        };
        usb.DPRAMUpdated = (offset, value) => {
            if (offset >= FIRST_BUFFER_CONTROL && offset <= LAST_BUFFER_CONTROL) this.bufferWritten(offset, value);
        };
    }

    startFrame() {
        this.usb.sofFrameNumber = (this.usb.sofFrameNumber + 1) & 0x7ff;
        this.setFrameInterrupt(true);
        if (this.attached && this.plugged) this.frame.schedule(FRAME_NANOS);
    }

    setFrameInterrupt(on) {
        this.usb.intRaw = on ? this.usb.intRaw | INTR_SOF : this.usb.intRaw & ~INTR_SOF;
        this.usb.checkInterrupts();
    }

    // ---- Control transfers ---------------------------------------------------------------------------

    enumerate() {
        this.armed.forEach((alarm) => alarm.cancel());
        this.armed.clear();
        this.requests = [];
        this.port = null;
        this.request(setup(0x80, 6, DESCRIPTOR.DEVICE << 8, 0, 18));
        this.request(setup(0x00, 5, 1, 0, 0)); // address
        this.request(setup(0x80, 6, DESCRIPTOR.CONFIGURATION << 8, 0, 9), null, (head) => {
            this.request(setup(0x80, 6, DESCRIPTOR.CONFIGURATION << 8, 0, head[2] | head[3] << 8), null, (all) => {
                this.port = findSerialPort(all);
                this.request(setup(0x00, 9, 1, 0, 0)); // configuration
                if (this.port === null) return;
                this.setLineCoding(115200);
                this.setLineState(true, true, () => {
                    this.connected = true;
                    this.onConnected();
                    this.pump();
                });
            });
        });
    }

    setLineState(dtr, rts, then) {
        this.request(setup(0x21, 0x22, (dtr ? DTR : 0) | (rts ? RTS : 0), this.port.control, 0), null, then);
    }

    setLineCoding(baud) {
        const data = Uint8Array.of(baud & 255, baud >> 8 & 255, baud >> 16 & 255, baud >>> 24, 0, 0, 8);
        this.request(setup(0x21, 0x20, 0, this.port.control, data.length), data);
    }

    request(packet, data = null, then = null) {
        this.requests.push({ packet, data, then, received: [], length: packet[6] | packet[7] << 8, input: (packet[0] & 0x80) !== 0 });
        if (this.requests.length === 1) this.usb.sendSetupPacket(packet);
    }

    finishRequest(stalled) {
        const [{ then, received }] = this.requests;
        if (!stalled) then?.(received);
        this.requests.shift();
        if (this.requests.length > 0) this.usb.sendSetupPacket(this.requests[0].packet);
    }

    // ---- Buffers -------------------------------------------------------------------------------------

    control(offset) { return this.mcu.usbDPRAMView.getUint32(offset, true); }
    setControl(offset, value) { this.mcu.usbDPRAMView.setUint32(offset, value, true); }

    // The firmware wrote a buffer control word.
    bufferWritten(offset, value) {
        const endpoint = (offset - FIRST_BUFFER_CONTROL) >> 3, output = (offset & 4) !== 0;
        if (endpoint === 0 && value & BUFFER.STALL && this.requests.length > 0) this.finishRequest(true);
        else if (value & BUFFER.AVAILABLE && !this.armed.has(offset)) {
            this.armed.set(offset, this.clock.createAlarm(() => this.packet(offset, endpoint, output)));
            this.go(offset, endpoint, output);
        }
    }

    // Starts the packet of an armed buffer if the host has a use for it.
    go(offset, endpoint, output) {
        const alarm = this.armed.get(offset);
        if (alarm === undefined || alarm.scheduled || !this.plugged) return;
        const serial = this.port !== null && endpoint === (output ? this.port.out : this.port.in);
        if (serial && (output ? this.queue.length === 0 : !this.reading)) return;
        alarm.schedule(PACKET_NANOS);
    }

    packet(offset, endpoint, output) {
        const word = this.control(offset);
        this.armed.delete(offset);
        if (!(word & BUFFER.AVAILABLE)) return; // the firmware took it back
        if (output) {
            this.setControl(offset, (word & ~BUFFER.AVAILABLE) >>> 0);
            this.give(endpoint);
        } else {
            this.collect(offset, endpoint);
        }
    }

    // Host to board.
    give(endpoint) {
        if (endpoint !== 0) {
            const size = Math.min(PACKET_SIZE, this.control(FIRST_BUFFER_CONTROL + 8 * endpoint + 4) & BUFFER.LENGTH);
            this.usb.finishRead(endpoint, Uint8Array.from(this.queue.splice(0, size)));
            return;
        }
        const [request] = this.requests;
        this.usb.finishRead(0, request?.data ?? new Uint8Array(0));
        if (request?.input) this.finishRequest(false); // that was the status stage
    }

    // Board to host: both halves of a double buffer, first half first.
    collect(offset, endpoint) {
        const word = this.control(offset), start = this.usb.getEndpointBufferOffset(endpoint, false);
        const double = endpoint !== 0 && (this.usb.readEndpointControlReg(endpoint, false) & EP_DOUBLE_BUFFERED) !== 0;
        const halves = double && word >>> 16 & BUFFER.AVAILABLE ? 2 : 1;
        let bytes = [], after = word;
        for (let half = 0; half < halves; half++) {
            const length = word >>> 16 * half & BUFFER.LENGTH, from = start + PACKET_SIZE * half;
            bytes = bytes.concat(Array.from(this.mcu.usbDPRAM.subarray(from, from + length)));
            after &= ~((BUFFER.AVAILABLE | BUFFER.FULL) << 16 * half);
        }
        this.setControl(offset, after >>> 0);
        this.usb.indicateBufferReady(endpoint, false);
        if (endpoint === 0) this.collected(bytes);
        else if (endpoint === this.port?.in && bytes.length > 0) this.onData(bytes);
    }

    // A packet of a control transfer.
    collected(bytes) {
        const [request] = this.requests;
        if (request === undefined) return;
        request.received.push(...bytes);
        if (!request.input) this.finishRequest(false); // status stage
    }

    // ---- The serial port -----------------------------------------------------------------------------

    send(bytes) {
        for (const byte of bytes) this.queue.push(byte);
        this.pump();
    }

    // Takes the cable out: what the board has not sent stays in its buffers. The host forgets what it had for the board.
    unplug() {
        this.plugged = this.connected = false;
        this.port = null;
        this.queue = [];
        this.requests = [];
        this.armed.forEach((alarm) => alarm.cancel());
        this.idle.schedule(SUSPEND_NANOS);
    }

    suspend() {
        if (this.plugged) return;
        this.usb.sieStatus |= SIE_SUSPENDED;
        this.usb.sieStatusUpdated();
    }

    // Puts it in again: the host resets the bus and enumerates the board anew.
    plug() {
        this.plugged = true;
        this.usb.resetAlarm.schedule(ATTACH_NANOS);
    }

    setReading(on) {
        this.reading = on;
        this.pump();
    }

    pump() {
        if (this.port === null) return;
        this.go(FIRST_BUFFER_CONTROL + 8 * this.port.out + 4, this.port.out, true);
        this.go(FIRST_BUFFER_CONTROL + 8 * this.port.in, this.port.in, false);
    }
}

// The flash chip: a W25Q16JV behind the chip's SSI, driven by the boot ROM's own functions. NOR rules, typical busy
// times of its data sheet; a command or an access while it is busy is a fault. Chip select is an override bit of the
// QSPI pins, which is how the boot ROM drives it.

import { BasePeripheral } from 'rp2040js';

export const FLASH_SIZE = 2 << 20;
const PROGRAM_NANOS = 0.4e6;
const ERASE = { 0x20: [4096, 45e6], 0x52: [32768, 120e6], 0xd8: [65536, 150e6] }; // bytes, time
const JEDEC_ID = [0xef, 0x40, 0x15], UNIQUE_ID = 0xe0;
const CS_LOW = 2, CS_HIGH = 3;

export class Flash extends BasePeripheral {
    // `bytes`: the contents, kept across resets of the chip.
    constructor({ mcu, S, clock, bytes, onFault }) {
        super(mcu, 'SSI');
        Object.assign(this, { S, clock, bytes, onFault });
        this.received = [];
        this.sent = []; // bytes of the command under way
        this.enabled = 0;
        this.chipSelect = 0;
        this.writeEnabled = false;
        this.busyUntil = 0;
        this.complained = false;
        this.wake = clock.createAlarm(() => this.ready());
        S.xip = FLASH_SIZE;
        this.install(mcu);
    }

    install(mcu) {
        const pins = mcu.peripherals[0x40018], cache = new BasePeripheral(mcu, 'XIP_CTRL');
        let select = 0;
        pins.readUint32 = (offset) => (offset === 0x0c ? select : 0);
        pins.writeUint32 = (offset, value) => {
            if (offset === 0x0c) {
                select = value;
                this.selectOverride(value >> 8 & 3);
            }
        };
        cache.readUint32 = () => 0;
        cache.writeUint32 = () => {};
        mcu.peripherals[0x14000] = cache;
        mcu.peripherals[0x18000] = this;
    }

    busy() {
        return this.clock.nanosCounter < this.busyUntil;
    }

    // Asked by the bus for an address in the flash when the executor could not read it directly.
    readable(address) {
        if ((address & 0xffffff) >= FLASH_SIZE) return true; // the bus complains
        if (!this.busy()) return true;
        if (!this.complained) this.onFault(`flash read at ${address.toString(16)} while it is busy`, this.S.pc);
        this.complained = true;
        return false;
    }

    // ---- Registers of the SSI ------------------------------------------------------------------------

    readUint32(offset) {
        switch (offset) {
            case 0x08: return this.enabled;
            case 0x24: return this.received.length;
            case 0x28: return 6 | (this.received.length ? 8 : 0); // room to send, nothing waiting, received
            case 0x58: return 0x51535049;
            case 0x5c: return 0x3430312a;
            case 0x60: return this.take();
            default: return 0;
        }
    }

    writeUint32(offset, value) {
        if (offset === 0x08) {
            this.enabled = value & 1;
            if (!this.enabled) {
                this.received = [];
                this.finish();
            }
        } else if (offset === 0x60) {
            this.sent.push(value & 255);
            this.received.push(this.reply());
        }
    }

    take() {
        const byte = this.received.shift() ?? 0;
        if (this.received.length === 0 && this.chipSelect < CS_LOW) this.finish(); // select follows the transfer
        return byte;
    }

    selectOverride(override) {
        if (override === CS_HIGH && this.chipSelect !== CS_HIGH) this.finish();
        if (override === CS_LOW && this.chipSelect !== CS_LOW) this.sent = [];
        this.chipSelect = override;
    }

    // ---- Commands ------------------------------------------------------------------------------------

    // What the flash answers to the byte sent last.
    reply() {
        const [command, a, b, c] = this.sent, i = this.sent.length - 1;
        if (i === 0) return 0xff;
        switch (command) {
            case 0x03: return i > 3 ? this.bytes[((a << 16 | b << 8 | c) + i - 4) % FLASH_SIZE] : 0;
            case 0x05: return (this.busy() ? 1 : 0) | (this.writeEnabled ? 2 : 0);
            case 0x35: return 2; // quad enabled
            case 0x4b: return i > 4 ? UNIQUE_ID + i - 5 : 0;
            case 0x9f: return JEDEC_ID[i - 1] ?? 0;
            default: return 0;
        }
    }

    // Chip select went up: carry the command out.
    finish() {
        const bytes = this.sent, [command] = bytes;
        this.sent = [];
        if (command === undefined) return;
        if (this.busy() && command !== 0x05) {
            this.onFault(`flash command ${command.toString(16)} while it is busy`, this.S.pc);
        } else if (command === 0x06) {
            this.writeEnabled = true;
        } else if (command === 0x04) {
            this.writeEnabled = false;
        } else if (this.writeEnabled && bytes.length >= 4) {
            this.change(bytes);
        }
    }

    change([command, a, b, c, ...data]) {
        const address = (a << 16 | b << 8 | c) % FLASH_SIZE;
        if (command === 0x02) {
            data.forEach((byte, i) => { this.bytes[(address & ~255) | ((address + i) & 255)] &= byte; });
            this.startBusy(PROGRAM_NANOS);
        } else if (ERASE[command]) {
            const [size, nanos] = ERASE[command], start = address & -size;
            this.bytes.fill(0xff, start, start + size);
            this.startBusy(nanos);
        }
    }

    startBusy(nanos) {
        this.writeEnabled = false;
        this.complained = false;
        this.busyUntil = this.clock.nanosCounter + nanos;
        this.wake.schedule(nanos);
        this.S.xip = 0; // from now on the executor asks the bus
        this.S.leave = 1;
    }

    ready() {
        this.S.xip = FLASH_SIZE;
    }
}

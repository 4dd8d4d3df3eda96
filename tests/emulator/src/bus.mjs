// The bus: every access that is not plain RAM or readable flash. Brings the clock up to the instruction, checks the
// address as the chip does, passes the access to rp2040js's peripherals and looks whether it changed who runs next.

const FLASH_SIZE = 2 << 20; // W25Q16JV of the Pico

// Cycles of an access, by the top four bits of its address: RAM, APB and AHB peripherals, SIO, core.
const READ_COST = [2, 2, 2, 2, 4, 2, 2, 2, 2, 2, 2, 2, 2, 1, 2, 2];
const WRITE_COST = [2, 2, 2, 2, 5, 2, 2, 2, 2, 2, 2, 2, 2, 1, 2, 2];
const FOREVER = 1 << 30;

export class Bus {
    // `mcu`: rp2040js's chip. `onFault(text)` hears of every fault.
    constructor({ S, mcu, clock, onFault }) {
        Object.assign(this, { S, mcu, clock, onFault, nvic: null, flash: null });
    }

    // Moves the clock to `cycles` of the present run.
    sync(cycles) {
        this.clock.nanosCounter = this.S.startNanos + cycles * this.S.nanosPerCycle;
    }

    // Cycles of this run until the next alarm or the end; negative if the loop around the executor has to act.
    refreshStop() {
        const { S, nvic } = this;
        if (S.leave) {
            S.leave = 0;
            S.stop = -1;
            return;
        }
        if (nvic.ready !== 0 || S.sleeping || S.reset || S.locked || S.excReturn) {
            S.stop = -1;
            return;
        }
        const alarm = this.clock.nextAlarm;
        const end = alarm !== null && alarm.nanos < S.limitNanos ? alarm.nanos : S.limitNanos;
        // At least one: slow clocks have cycles that are no whole nanoseconds, and time has to go on.
        S.stop = Math.max(1, Math.min(FOREVER, Math.ceil((end - S.startNanos) / S.nanosPerCycle - 1e-6)));
    }

    // A hard fault of the running instruction.
    fault(text, address) {
        const { S } = this;
        this.onFault(`${text} (${(address >>> 0).toString(16)})`, S.pc);
        S.faultPc = S.pc;
        this.nvic.hardFault();
        S.stop = -1;
        return 0;
    }

    fetch(address, cycles) {
        const top = address >>> 24;
        if (address < 0x4000 || top === 0x10 || top === 0x20) return this.access(address & ~1, cycles, 2, false, 0) & 0xffff;
        return this.fault('execution outside memory', address);
    }

    // The SIO has the tick's pins: a shorter way for it.
    read32(address, cycles) {
        if (address >>> 28 !== 0xd || address & 3) return this.access(address, cycles, 4, false, 0) | 0;
        this.sync(cycles);
        this.S.cost = 1;
        return this.mcu.sio.readUint32(address & 0xffffffc) | 0;
    }

    read16(address, cycles) { return this.access(address, cycles, 2, false, 0) & 0xffff; }
    read8(address, cycles) { return this.access(address, cycles, 1, false, 0) & 0xff; }
    write32(address, value, cycles) {
        if (address >>> 28 !== 0xd || address & 3) {
            this.access(address, cycles, 4, true, value >>> 0);
            return;
        }
        this.sync(cycles);
        this.S.cost = 1;
        this.mcu.sio.writeUint32(address & 0xffffffc, value >>> 0);
        this.refreshStop(); // an edge may raise an interrupt or wake the PIO
    }

    write16(address, value, cycles) { this.access(address, cycles, 2, true, value & 0xffff); }
    write8(address, value, cycles) { this.access(address, cycles, 1, true, value & 0xff); }

    access(address, cycles, size, write, value) {
        const { S } = this;
        this.sync(cycles);
        S.cost = (write ? WRITE_COST : READ_COST)[address >>> 28];
        if (address & (size - 1)) return this.fault(`unaligned ${write ? 'write' : 'read'}`, address);
        const result = write ? this.write(address, size, value) : this.read(address, size);
        this.refreshStop();
        return result;
    }

    read(address, size) {
        if (address >>> 28 === 0xd) return this.narrow(this.mcu.sio.readUint32(address & 0xffffffc), address, size);
        if (address >>> 26 === 4 && !this.flash.readable(address)) return 0xffffffff;
        if (!this.exists(address)) return this.fault('read of nothing', address);
        if (size === 4) return this.mcu.readUint32(address);
        return size === 2 ? this.mcu.readUint16(address) : this.mcu.readUint8(address);
    }

    narrow(word, address, size) {
        return size === 4 ? word : word >>> 8 * (address & 3);
    }

    guarded(address) {
        return (address - 0x20000000 - this.S.guardStart) >>> 0 < this.S.guardSize;
    }

    write(address, size, value) {
        if (this.guarded(address)) {
            this.fault('write into the stack guard', address);
            return;
        }
        if (address >>> 28 === 0xd) {
            // The chip copies a narrow value over all lanes of a peripheral register.
            this.mcu.sio.writeUint32(address & 0xffffffc, size === 4 ? value : Math.imul(value, size === 2 ? 0x10001 : 0x1010101) >>> 0);
        } else if (address < 0x4000) {
            // The chip ignores writes to its ROM. TinyUSB does it for endpoint 0, through a null pointer, at every
            // packet; anywhere else it is a bug worth knowing.
            if (address !== 0) this.onFault(`write to ROM (${address.toString(16)})`, this.S.pc);
        } else if (address < 0x14000000) {
            this.fault('write to flash', address);
        } else if (!this.exists(address)) {
            this.fault('write to nothing', address);
        } else if (size === 4) {
            this.mcu.writeUint32(address, value);
        } else if (size === 2) {
            this.mcu.writeUint16(address, value);
        } else {
            this.mcu.writeUint8(address, value);
        }
    }

    // A word of RAM or flash outside of any instruction: exception frames and vectors.
    plain(address, write, value) {
        const offset = address - 0x20000000;
        if (write && this.guarded(address)) return this.fault('exception frame in the stack guard', address);
        if (offset >= 0 && offset + 4 <= this.mcu.sram.length) {
            if (write) this.mcu.sramView.setUint32(offset, value, true);
            return write ? 0 : this.mcu.sramView.getUint32(offset, true) | 0;
        }
        if (!write && address < 0x4000) return this.mcu.readUint32(address) | 0;
        if (!write && address >>> 24 === 0x10) return this.flash.readable(address) ? this.mcu.readUint32(address) | 0 : 0;
        return this.fault(write ? 'exception frame outside RAM' : 'vector outside memory', address);
    }

    exists(address) {
        const top = address >>> 24;
        if (top < 0x10) return address < 0x4000;
        if (top < 0x14) return (address & 0xffffff) < FLASH_SIZE;
        if (top === 0x20) return address < 0x20042000;
        if (top === 0x50 && address >>> 12 === 0x50100) return true; // USB buffers
        if (address >>> 12 === 0xe000e) return true;
        return this.mcu.peripherals[address >>> 14 << 2] !== undefined;
    }
}

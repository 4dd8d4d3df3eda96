// As much of the memory protection unit as a stack guard needs: regions in RAM that nobody may access. The executor
// checks writes only (a stack grows by writing); one stretch of memory at a time.
// Source: ARMv6-M Architecture Reference Manual, B3.5.

const TYPE = 0xd90, CTRL = 0xd94, RNR = 0xd98, RBAR = 0xd9c, RASR = 0xda0;
const REGIONS = 8, RBAR_VALID = 1 << 4, NO_ACCESS = 0;

export class Mpu {
    constructor({ S, onFault }) {
        Object.assign(this, { S, onFault });
        this.control = 0;
        this.number = 0;
        this.regions = Array.from({ length: REGIONS }, () => ({ base: 0, attributes: 0 }));
    }

    has(offset) {
        return offset >= TYPE && offset <= RASR;
    }

    read(offset) {
        const region = this.regions[this.number];
        switch (offset) {
            case TYPE: return REGIONS << 8;
            case CTRL: return this.control;
            case RNR: return this.number;
            case RBAR: return region.base | this.number;
            default: return region.attributes;
        }
    }

    write(offset, value) {
        if (offset === CTRL) this.control = value & 7;
        if (offset === RNR) this.number = value & 7;
        if (offset === RBAR) {
            if (value & RBAR_VALID) this.number = value & 7;
            this.regions[this.number].base = value & ~255;
        }
        if (offset === RASR) this.regions[this.number].attributes = value;
        this.update();
    }

    update() {
        const { S } = this, guards = this.control & 1 ? this.regions.map(guardOf).filter((guard) => guard !== null) : [];
        if (guards.length > 1) this.onFault('more than one guarded region: the emulator knows one', S.pc);
        [S.guardStart, S.guardSize] = guards[0] ?? [0, 0];
        S.leave = 1;
    }
}

// Start (offset into RAM) and size of a region without access; null: it is off, allows access, or is not in RAM.
function guardOf({ base, attributes }) {
    if (!(attributes & 1) || (attributes >>> 24 & 7) !== NO_ACCESS || base >>> 24 !== 0x20) return null;
    const size = 2 ** ((attributes >>> 1 & 31) + 1), disabled = attributes >>> 8 & 255;
    const parts = [0, 1, 2, 3, 4, 5, 6, 7].filter((part) => !(disabled >>> part & 1));
    if (parts.length === 0) return null;
    return [base - 0x20000000 + parts[0] * size / 8, parts.length * size / 8];
}

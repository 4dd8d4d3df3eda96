// The registers of a TMC2209 and a TMC2208: addresses, access, reset values.
// Source: TMC2209 data sheet, rev. 1.09, section 5; TMC2202/2208/2224 data sheet, rev. 1.13, section 5.

const BOTH = [2208, 2209], NEWER = [2209];

// name: [address, access (r, w, c: a 1 that is written clears), reset value, bits that are kept, chips]
const ROWS = {
    GCONF: [0x00, 'rw', 0x101, 0x3ff, BOTH],
    GSTAT: [0x01, 'rc', 0x1, 0x7, BOTH],
    IFCNT: [0x02, 'r', 0, 0xff, BOTH],
    SLAVECONF: [0x03, 'w', 0, 0xf00, BOTH],
    OTP_PROG: [0x04, 'w', 0, 0, BOTH],
    OTP_READ: [0x05, 'r', 0, 0xffffff, BOTH],
    IOIN: [0x06, 'r', 0, 0xff0003ff, BOTH],
    FACTORY_CONF: [0x07, 'rw', 0xe, 0x31f, BOTH],
    IHOLD_IRUN: [0x10, 'w', 0x11f10, 0xf1f1f, BOTH],
    TPOWERDOWN: [0x11, 'w', 20, 0xff, BOTH],
    TSTEP: [0x12, 'r', 0xfffff, 0xfffff, BOTH],
    TPWMTHRS: [0x13, 'w', 0, 0xfffff, BOTH],
    TCOOLTHRS: [0x14, 'w', 0, 0xfffff, NEWER],
    VACTUAL: [0x22, 'w', 0, 0xffffff, BOTH],
    SGTHRS: [0x40, 'w', 0, 0xff, NEWER],
    SG_RESULT: [0x41, 'r', 0, 0x1fe, NEWER],
    COOLCONF: [0x42, 'w', 0, 0xffff, NEWER],
    MSCNT: [0x6a, 'r', 0, 0x3ff, BOTH],
    MSCURACT: [0x6b, 'r', 0, 0x1ff01ff, BOTH],
    CHOPCONF: [0x6c, 'rw', 0x10000053, 0xffffffff, BOTH],
    DRV_STATUS: [0x6f, 'r', 0, 0xc01f0fff, BOTH],
    PWMCONF: [0x70, 'rw', 0xc10d0024, 0xffffffff, BOTH],
    PWM_SCALE: [0x71, 'r', 0x20, 0x1ff00ff, BOTH],
    PWM_AUTO: [0x72, 'r', 0xe0024, 0xff00ff, BOTH],
};

// Address -> { name, address, access, reset, mask } of a chip.
export function registersOf(chip) {
    const found = new Map();
    for (const [name, [address, access, reset, mask, chips]] of Object.entries(ROWS)) {
        if (chips.includes(chip)) found.set(address, { name, address, access, reset, mask });
    }
    return found;
}

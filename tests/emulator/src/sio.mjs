// The hot and the faulty parts of rp2040js's SIO done anew: GPIO registers that look only at the pins that change,
// and the divider (8 cycles in the background, results by the data sheet also for division by zero).

const GPIO_MASK = 0x3fffffff;
const UDIVIDEND = 0x60, SDIVIDEND = 0x68, UDIVISOR = 0x64, SDIVISOR = 0x6c, QUOTIENT = 0x70, REMAINDER = 0x74, DIV_CSR = 0x78;

export function installSio({ mcu, pads }) {
    const { sio } = mcu, stock = { read: sio.readUint32.bind(sio), write: sio.writeUint32.bind(sio) };
    const divider = { dividend: 0, divisor: 0, quotient: 0, remainder: 0, dirty: 0 };

    function changed(bits) {
        for (let left = bits & GPIO_MASK; left !== 0; left &= left - 1) {
            mcu.gpio[31 - Math.clz32(left & -left)].checkForUpdates();
        }
    }

    function setLevels(value) {
        const before = sio.gpioValue;
        sio.gpioValue = value & GPIO_MASK;
        changed(sio.gpioValue ^ before);
    }

    function setDirections(value) {
        const before = sio.gpioOutputEnable;
        sio.gpioOutputEnable = value & GPIO_MASK;
        changed(sio.gpioOutputEnable ^ before);
    }

    function divide(signed) {
        const a = signed ? divider.dividend | 0 : divider.dividend >>> 0;
        const b = signed ? divider.divisor | 0 : divider.divisor >>> 0;
        divider.quotient = b !== 0 ? Math.trunc(a / b) : signed && a < 0 ? 1 : -1;
        divider.remainder = b !== 0 ? a % b : a;
        divider.dirty = 2;
    }

    sio.readUint32 = (offset) => {
        switch (offset) {
            case 0x04: return pads.inputs;
            case UDIVIDEND: case SDIVIDEND: return divider.dividend;
            case UDIVISOR: case SDIVISOR: return divider.divisor;
            case QUOTIENT: divider.dirty = 0; return divider.quotient;
            case REMAINDER: return divider.remainder;
            case DIV_CSR: return divider.dirty | 1; // ready
            default: return stock.read(offset);
        }
    };

    sio.writeUint32 = (offset, value) => {
        switch (offset) {
            case 0x10: return setLevels(value);
            case 0x14: return setLevels(sio.gpioValue | value);
            case 0x18: return setLevels(sio.gpioValue & ~value);
            case 0x1c: return setLevels(sio.gpioValue ^ value);
            case 0x20: return setDirections(value);
            case 0x24: return setDirections(sio.gpioOutputEnable | value);
            case 0x28: return setDirections(sio.gpioOutputEnable & ~value);
            case 0x2c: return setDirections(sio.gpioOutputEnable ^ value);
            case UDIVIDEND: divider.dividend = value; return divide(false);
            case SDIVIDEND: divider.dividend = value; return divide(true);
            case UDIVISOR: divider.divisor = value; return divide(false);
            case SDIVISOR: divider.divisor = value; return divide(true);
            case QUOTIENT: divider.quotient = value; divider.dirty = 2; return;
            case REMAINDER: divider.remainder = value; divider.dirty = 2; return;
            default: return stock.write(offset, value);
        }
    };
}

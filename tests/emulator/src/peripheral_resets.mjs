// rp2040js has no reset of its peripherals: this calls back whenever one is held in reset.
// Source: RP2040 data sheet, 2.14.

const RESETS = 0x4000c;

// `bit`: the peripheral's in the register RESET.
export function onPeripheralReset(mcu, bit, act) {
    const resets = mcu.peripherals[RESETS], write = resets.writeUint32.bind(resets);
    resets.writeUint32 = (offset, value) => {
        write(offset, value);
        if ((resets.reset >> bit & 1) !== 0) act();
    };
}

// The core's own registers at 0xe000e000: SysTick, NVIC, system control, memory protection. Takes the place of rp2040js's PPB.

import { EXCEPTION } from './nvic.mjs';

const CPUID = 0x410cc601, RESET_KEY = 0x05fa;

export function installCoreRegisters({ mcu, S, nvic, systick, mpu, onReset }) {
    const priorityWord = (index) => [0, 1, 2, 3].reduce((word, i) => word | nvic.priorities[4 * index + i] << (8 * i + 6), 0);

    function setPriorityWord(index, word) {
        for (let i = 0; i < 4; i++) nvic.priorities[4 * index + i] = word >>> (8 * i + 6) & 3;
        nvic.refresh();
    }

    function interruptControl() {
        const p = nvic.pending;
        return (p[EXCEPTION.PENDSV] << 28 | p[EXCEPTION.SYSTICK] << 26 | (nvic.latched !== 0 ? 1 << 22 : 0)
            | nvic.candidate(0) << 12 | S.ipsr) >>> 0;
    }

    function writeInterruptControl(value) {
        if (value & 1 << 28) nvic.pendSystem(EXCEPTION.PENDSV, true);
        if (value & 1 << 27) nvic.pendSystem(EXCEPTION.PENDSV, false);
        if (value & 1 << 26) nvic.pendSystem(EXCEPTION.SYSTICK, true);
        if (value & 1 << 25) nvic.pendSystem(EXCEPTION.SYSTICK, false);
    }

    function setSystemPriority(number, bits) {
        nvic.systemPriority[number] = bits & 3;
        nvic.refresh();
    }

    function read(offset) {
        if (offset >= 0x400 && offset < 0x420) return priorityWord((offset - 0x400) >> 2);
        if (mpu.has(offset)) return mpu.read(offset);
        switch (offset) {
            case 0x010: return systick.readControl();
            case 0x014: return systick.reload;
            case 0x018: return systick.current();
            case 0x01c: return 0xc0000000; // no calibration value
            case 0x100: case 0x180: return nvic.enabled;
            case 0x200: case 0x280: return nvic.latched;
            case 0xd00: return CPUID;
            case 0xd04: return interruptControl();
            case 0xd08: return nvic.vtor;
            case 0xd0c: return 0xfa050000;
            case 0xd10: return nvic.scr;
            case 0xd14: return 0x208; // unaligned accesses fault, 8-byte aligned stack
            case 0xd1c: return nvic.systemPriority[EXCEPTION.SVCALL] << 30;
            case 0xd20: return nvic.systemPriority[EXCEPTION.PENDSV] << 22 | nvic.systemPriority[EXCEPTION.SYSTICK] << 30;
            default: return 0;
        }
    }

    function write(offset, value) {
        if (offset >= 0x400 && offset < 0x420) return setPriorityWord((offset - 0x400) >> 2, value);
        if (mpu.has(offset)) return mpu.write(offset, value);
        switch (offset) {
            case 0x010: return systick.writeControl(value);
            case 0x014: systick.reload = value & 0xffffff; return;
            case 0x018: return systick.clear();
            case 0x100: nvic.enabled |= value; return nvic.refresh();
            case 0x180: nvic.enabled &= ~value; return nvic.refresh();
            case 0x200: return nvic.pend(value | 0);
            case 0x280: return nvic.unpend(value | 0);
            case 0xd04: return writeInterruptControl(value);
            case 0xd08: nvic.vtor = value & 0xffffff00; return;
            case 0xd0c: if (value >>> 16 === RESET_KEY && value & 4) onReset(); return;
            case 0xd10: nvic.scr = value & 0x16; return;
            case 0xd1c: return setSystemPriority(EXCEPTION.SVCALL, value >>> 30);
            case 0xd20:
                setSystemPriority(EXCEPTION.PENDSV, value >>> 22);
                return setSystemPriority(EXCEPTION.SYSTICK, value >>> 30);
            default:
        }
    }

    mcu.ppb.readUint32 = (offset) => read(offset) >>> 0;
    mcu.ppb.writeUint32 = write;
}

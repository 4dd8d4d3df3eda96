// Exceptions of the Cortex-M0+: pending, enabled, priorities, taking and leaving with their cycles, the fault that
// ends in lock-up, and the registers of the core (SCS) that belong to them.
// Source: ARMv6-M Architecture Reference Manual, B1.5 and B3.

import { SLEEP } from './state.mjs';
import { apsr, setApsr, selectStack } from './system.mjs';

// Cycles. Entry is from the Cortex-M0+ technical reference manual; exit and tail-chaining are estimates.
export const ENTRY_CYCLES = 15, EXIT_CYCLES = 13, TAIL_CYCLES = 6;

export const EXCEPTION = { HARD_FAULT: 3, SVCALL: 11, PENDSV: 14, SYSTICK: 15, IRQ0: 16 };
const THREAD_PRIORITY = 4;

export class Nvic {
    // `advance(cycles)` lets time pass outside of instructions; `ram32`: the RAM as words.
    constructor({ S, R, bus, ram32, advance }) {
        Object.assign(this, { S, R, bus, ram32, advance, profile: null });
        this.enabled = 0;
        this.latched = 0; // pending, bit for each interrupt
        this.lines = 0;   // levels of the interrupt lines
        this.priorities = new Uint8Array(32);
        this.pending = new Uint8Array(16); // of exceptions 3 to 15
        this.systemPriority = { [EXCEPTION.HARD_FAULT]: -1, [EXCEPTION.SVCALL]: 0, [EXCEPTION.PENDSV]: 0, [EXCEPTION.SYSTICK]: 0 };
        this.vtor = 0;
        this.scr = 0;
        this.active = []; // numbers of the exceptions being handled, innermost last
        this.ready = 0;   // the exception to take next; 0: none
        this.returned = false; // an exception has just ended: the next one is chained to it
    }

    // ---- What is pending -----------------------------------------------------------------------------

    // Called by the peripherals: the level of an interrupt line.
    setInterrupt(irq, level) {
        const bit = 1 << irq;
        if (level && !(this.lines & bit)) {
            this.lines |= bit;
            this.pend(bit);
        } else if (!level) {
            this.lines &= ~bit;
        }
    }

    pend(bits) {
        if ((bits & ~this.latched) !== 0) this.pendEvent();
        this.latched |= bits;
        this.refresh();
    }

    unpend(bits) {
        this.latched &= ~bits;
        this.latched |= this.lines & bits & ~this.activeLines(); // a line that is still up pends again
        this.refresh();
    }

    pendSystem(number, on) {
        if (on && !this.pending[number]) this.pendEvent();
        this.pending[number] = on ? 1 : 0;
        this.refresh();
    }

    // SEVONPEND: anything newly pending is an event for WFE, enabled or not.
    pendEvent() {
        if (this.scr & 16) this.S.event = 1;
    }

    activeLines() {
        let bits = 0;
        for (const number of this.active) if (number >= EXCEPTION.IRQ0) bits |= 1 << (number - EXCEPTION.IRQ0);
        return bits;
    }

    // ---- Which one is next ---------------------------------------------------------------------------

    priorityOf(number) {
        return number >= EXCEPTION.IRQ0 ? this.priorities[number - EXCEPTION.IRQ0] : this.systemPriority[number];
    }

    // The pending exception that would interrupt what runs now; 0: none. `mask`: PRIMASK to go by.
    candidate(mask = this.S.primask) {
        const running = this.active.length > 0 ? this.runningPriority() : THREAD_PRIORITY;
        let best = mask && running > 0 ? 0 : running, found = 0;
        const consider = (number, priority) => {
            if (priority < best) {
                best = priority;
                found = number;
            }
        };
        for (const number of [EXCEPTION.HARD_FAULT, EXCEPTION.SVCALL, EXCEPTION.PENDSV, EXCEPTION.SYSTICK]) {
            if (this.pending[number]) consider(number, this.systemPriority[number]);
        }
        for (let bits = this.latched & this.enabled; bits !== 0; bits &= bits - 1) {
            const irq = 31 - Math.clz32(bits & -bits);
            consider(EXCEPTION.IRQ0 + irq, this.priorities[irq]);
        }
        return found;
    }

    runningPriority() {
        let priority = THREAD_PRIORITY;
        for (const number of this.active) priority = Math.min(priority, this.priorityOf(number));
        return priority;
    }

    refresh() {
        const idle = (this.latched & this.enabled) === 0 && !this.pending[EXCEPTION.SYSTICK]
            && !this.pending[EXCEPTION.PENDSV] && !this.pending[EXCEPTION.SVCALL] && !this.pending[EXCEPTION.HARD_FAULT];
        this.ready = idle ? 0 : this.candidate();
        if (this.ready !== 0) this.S.stop = -1;
    }

    // Whether a sleeping core wakes up now. WFI looks through PRIMASK, WFE does not but hears events.
    wakes() {
        if (this.S.sleeping === SLEEP.WFI) return this.candidate(0) !== 0;
        if (this.ready !== 0) return true;
        if (!this.S.event) return false;
        this.S.event = 0;
        return true;
    }

    callSupervisor() {
        this.pending[EXCEPTION.SVCALL] = 1;
        if (this.candidate() !== EXCEPTION.SVCALL) {
            this.pending[EXCEPTION.SVCALL] = 0;
            this.bus.fault('supervisor call at this priority', this.S.pc);
        }
    }

    hardFault() {
        if (this.active.includes(EXCEPTION.HARD_FAULT)) {
            this.S.locked = 1;
            this.bus.onFault('lock-up: fault inside the fault handler', this.S.pc);
        } else {
            this.pending[EXCEPTION.HARD_FAULT] = 1;
            this.refresh();
        }
    }

    // ---- Taking and leaving --------------------------------------------------------------------------

    take() {
        const { S, R, bus } = this, number = this.ready;
        this.clearTaken(number);
        const returnAddress = number === EXCEPTION.HARD_FAULT ? S.faultPc : S.pc;
        const onProcess = S.onProcessStack, align = R[13] & 4 ? 1 : 0;
        R[13] = (R[13] - 32) & ~4;
        this.pushFrame(R[13], returnAddress & ~1, apsr(S) | 1 << 24 | align << 9 | S.ipsr);
        R[14] = S.ipsr !== 0 ? 0xfffffff1 : onProcess ? 0xfffffffd : 0xfffffff9;
        selectStack(S, R, 0);
        S.processStack = 0;
        S.ipsr = number;
        S.event = 1;
        S.sleeping = SLEEP.NONE;
        this.active.push(number);
        this.advance(this.returned ? TAIL_CYCLES : ENTRY_CYCLES);
        this.returned = false;
        const vector = this.loadWord(this.vtor + 4 * number);
        S.pc = vector & ~1;
        this.refresh();
        this.profile?.entered(number, S.pc);
    }

    clearTaken(number) {
        if (number >= EXCEPTION.IRQ0) this.latched &= ~(1 << (number - EXCEPTION.IRQ0));
        else this.pending[number] = 0;
    }

    leave() {
        const { S, R } = this, kind = S.excReturn & 15, ended = this.active.pop();
        S.excReturn = 0;
        this.profile?.left();
        if (ended >= EXCEPTION.IRQ0) this.latched |= this.lines & (1 << (ended - EXCEPTION.IRQ0));
        S.ipsr = 0;
        S.processStack = kind === 13 ? 1 : 0;
        selectStack(S, R, S.processStack);
        const psr = this.popFrame(R[13]);
        R[13] = (R[13] + 32) | (psr & 1 << 9 ? 4 : 0);
        setApsr(S, psr);
        S.ipsr = kind === 1 ? psr & 63 : 0;
        S.event = 1;
        if (S.ipsr === 0 && this.scr & 2) S.sleeping = SLEEP.WFI; // SLEEPONEXIT
        this.returned = true;
        this.refresh();
    }

    // Called when no further exception follows the one that ended.
    unchain() {
        this.returned = false;
        this.advance(EXIT_CYCLES);
    }

    // R0 to R3, R12, LR, return address, flags. Straight into RAM, where a frame nearly always lies; a stack pointer
    // gone wild is caught by the bus.
    pushFrame(address, returnAddress, psr) {
        const { R, ram32 } = this, at = this.frameInRam(address, true);
        if (at < 0) {
            const words = [R[0], R[1], R[2], R[3], R[12], R[14], returnAddress, psr];
            words.forEach((word, i) => this.bus.plain((address + 4 * i) >>> 0, true, word));
            return;
        }
        for (let i = 0; i < 4; i++) ram32[at + i] = R[i];
        ram32[at + 4] = R[12];
        ram32[at + 5] = R[14];
        ram32[at + 6] = returnAddress;
        ram32[at + 7] = psr;
    }

    // Restores them, the address to S.pc; returns the flags.
    popFrame(address) {
        const { S, R, ram32 } = this, at = this.frameInRam(address, false);
        const word = at < 0 ? (i) => this.loadWord(address + 4 * i) : (i) => ram32[at + i];
        for (let i = 0; i < 4; i++) R[i] = word(i);
        R[12] = word(4);
        R[14] = word(5);
        S.pc = word(6) & ~1;
        return word(7);
    }

    // Index of a frame's first word in RAM; -1: not there, or guarded.
    frameInRam(address, write) {
        const offset = (address - 0x20000000) >>> 0, { guardStart, guardSize } = this.S;
        if (offset > 4 * this.ram32.length - 32) return -1;
        if (write && guardSize > 0 && offset + 32 > guardStart && offset < guardStart + guardSize) return -1;
        return offset >>> 2;
    }

    loadWord(address) {
        return this.bus.plain(address >>> 0, false, 0);
    }
}

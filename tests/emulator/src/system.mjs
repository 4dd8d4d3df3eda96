// Instructions that touch the state of the core: barriers, special registers, interrupt mask, sleep, events,
// calls of the supervisor, breakpoints, and what is no instruction at all.

import { SLEEP } from './state.mjs';

const MSP = 8, PSP = 9, PRIMASK = 16, CONTROL = 20;

export function apsr(S) {
    return ((S.nz < 0 ? 0x80000000 : 0) | (S.nz === 0 ? 0x40000000 : 0) | (S.c ? 0x20000000 : 0) | (S.v ? 0x10000000 : 0)) | 0;
}

export function setApsr(S, value) {
    S.nz = value & 0x40000000 ? 0 : value | 1;
    S.c = value >>> 29 & 1;
    S.v = value >>> 28 & 1;
}

// Makes the one in use the main (0) or the process (1) stack pointer.
export function selectStack(S, R, process) {
    if (S.onProcessStack === process) return;
    const other = S.otherStack;
    S.otherStack = R[13];
    R[13] = other;
    S.onProcessStack = process;
}

function readSpecial(S, R, number) {
    switch (number) {
        case MSP: return S.onProcessStack ? S.otherStack : R[13];
        case PSP: return S.onProcessStack ? R[13] : S.otherStack;
        case PRIMASK: return S.primask;
        case CONTROL: return S.processStack << 1;
        default: return number > 7 ? 0 : (number & 4 ? 0 : apsr(S)) | (number & 1 ? S.ipsr : 0);
    }
}

function writeSpecial(S, R, number, value) {
    const process = number === PSP ? 1 : 0;
    switch (number) {
        case MSP:
        case PSP:
            if (S.onProcessStack === process) R[13] = value & ~3;
            else S.otherStack = value & ~3;
            return;
        case PRIMASK:
            S.primask = value & 1;
            return;
        case CONTROL: // ignored in a handler, which always has the main stack
            if (S.ipsr === 0) {
                S.processStack = value >> 1 & 1;
                selectStack(S, R, S.processStack);
            }
            return;
        default:
            if ((number & 4) === 0) setApsr(S, value);
    }
}

// Returns system(op): reads S.pc, leaves S.pc behind the instruction, S.cost cycles and a fresh S.stop.
export function createSystem({ S, R, bus, nvic }) {
    function wait(kind) {
        if (kind === SLEEP.WFE && S.event) S.event = 0;
        else S.sleeping = kind;
        S.cost = 2;
    }

    function wide(op, op2) {
        S.pc = (S.pc + 4) | 0;
        S.cost = 3;
        if (op === 0xf3bf && op2 >> 8 === 0x8f) return; // DSB, DMB, ISB
        if (op === 0xf3ef && op2 >> 12 === 8) R[op2 >> 8 & 15] = readSpecial(S, R, op2 & 255);
        else if (op >> 4 === 0xf38 && op2 >> 8 === 0x88) writeSpecial(S, R, op2 & 255, R[op & 15]);
        else undefinedInstruction(op, 4);
    }

    function undefinedInstruction(op, length) {
        S.pc = (S.pc - length) | 0;
        bus.fault(`undefined instruction ${op.toString(16)}`, S.pc);
    }

    function narrow(op) {
        S.pc = (S.pc + 2) | 0;
        S.cost = 1;
        if (op === 0xb662 || op === 0xb672) S.primask = op >> 4 & 1;
        else if (op === 0xbf20) wait(SLEEP.WFE);
        else if (op === 0xbf30) wait(SLEEP.WFI);
        else if (op === 0xbf40) S.event = 1;
        else if (op >> 8 === 0xdf) nvic.callSupervisor();
        else if (op >> 8 === 0xbe) {
            S.pc = (S.pc - 2) | 0;
            bus.fault(`breakpoint ${op & 255}`, S.pc);
        } else undefinedInstruction(op, 2);
    }

    return function system(op) {
        bus.sync(S.now);
        if (op >> 11 === 0x1e) wide(op, bus.fetch((S.pc + 2) >>> 0, S.now));
        else narrow(op);
        nvic.refresh();
        bus.refreshStop();
    };
}

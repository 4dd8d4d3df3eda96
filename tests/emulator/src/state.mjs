// The state of the processor core that its parts share. One plain object, because the executor touches it on
// every run and V8 is fast only with a fixed shape.

export const SLEEP = { NONE: 0, WFI: 1, WFE: 2 };

export function createState() {
    return {
        // Program state while no code runs; the executor keeps it in locals.
        pc: 0, nz: 1, c: 0, v: 0,
        // Executor: how far to go, how much of the flash can be read, who wants to know of branches.
        stop: 0,           // cycles of this run(); negative: leave at once
        xip: 0,            // bytes of flash that can be read; 0 while it erases or programs
        guardStart: 0,     // memory that faults when written (the stack guard), as an offset into RAM
        guardSize: 0,      // 0: none
        watch: null,       // (target, cycles) => void, called at every taken branch
        // Time: clock = startNanos + cycles of this run() * nanosPerCycle.
        startNanos: 0,
        nanosPerCycle: 8,
        limitNanos: 0,     // where the present run ends at the latest
        cyclesBefore: 0,   // cycles since power-up until the start of this run()
        now: 0,            // cycles of this run() at the start of a system instruction
        cost: 1,           // out: cycles of the last bus access or system instruction
        // Registers of the core.
        primask: 0,
        ipsr: 0,           // number of the exception being handled; 0: thread
        processStack: 0,   // 1: thread code uses the process stack (CONTROL.SPSEL)
        onProcessStack: 0, // 1: R[13] is the process stack pointer just now
        otherStack: 0,     // the stack pointer that is not in R[13]
        event: 0,          // the event register of WFE
        sleeping: SLEEP.NONE,
        // Requests to the loop around the executor.
        leave: 0,          // come back at once: the executor has to read xip and the guard anew
        excReturn: 0,      // magic value of an exception return under way; 0: none
        faultPc: 0,
        locked: 0,         // lock-up: a fault inside the fault handler
        reset: 0,          // 0: none; else why the chip restarts (see reset.mjs)
    };
}

// Cycles of exception handlers and of chosen functions: number of calls, mean, least, most, and for handlers the
// share of what interrupted them taken out.
//
// A handler's cycles run from its first instruction to its return instruction, inclusive; entry and exit of the
// exception (ENTRY_CYCLES, EXIT_CYCLES) come on top and are not in the figures. A function's run from its first
// instruction to its return, the functions it calls included, exceptions with their entry and exit excluded.

import { ENTRY_CYCLES, EXIT_CYCLES } from './nvic.mjs';

const NAMES = { 3: 'hard_fault', 11: 'svcall', 14: 'pendsv', 15: 'systick' };

export class Profile {
    constructor() {
        this.statistics = new Map();
        this.samples = null; // name -> list of every figure, for names listed in keepSamples()
        this.functions = new Map(); // entry address -> name
        this.handlerAddress = new Map(); // name of a handler -> its entry address
        this.begin(() => 0, null);
    }

    // A chip starts (again): nothing is running. `now()`: cycles since power-up, at the present instruction.
    begin(now, R) {
        this.now = now;
        this.R = R;
        this.handlers = [];   // { start, nested }
        this.interrupted = [0]; // by depth of nesting: cycles taken by exceptions so far
        this.calls = [];      // { name, returnAddress, stack, start, interrupted, depth }
    }

    account(name, cycles) {
        let s = this.statistics.get(name);
        if (s === undefined) this.statistics.set(name, s = { calls: 0, cycles: 0, least: Infinity, most: 0 });
        s.calls += 1;
        s.cycles += cycles;
        s.least = Math.min(s.least, cycles);
        s.most = Math.max(s.most, cycles);
        this.samples?.get(name)?.push(cycles);
    }

    keepSamples(names) {
        this.samples = new Map(names.map((name) => [name, []]));
    }

    clear() {
        this.statistics.clear();
        this.samples?.forEach((list) => { list.length = 0; });
    }

    // `nameOf(address)`: the function there, for handlers.
    report(nameOf) {
        return Object.fromEntries([...this.statistics].map(([name, s]) => {
            const address = this.handlerAddress.get(name);
            return [name, { ...s, mean: s.cycles / s.calls, ...(address === undefined ? {} : { function: nameOf(address) }) }];
        }));
    }

    // ---- Exceptions ----------------------------------------------------------------------------------

    entered(number, address) {
        const name = NAMES[number] ?? `irq${number - 16}`;
        this.handlerAddress.set(name, address);
        this.handlers.push({ name, start: this.now(), nested: 0 });
        this.interrupted[this.handlers.length] = 0;
    }

    left() {
        const handler = this.handlers.pop();
        if (handler === undefined) return;
        const inclusive = this.now() - handler.start, whole = inclusive + ENTRY_CYCLES + EXIT_CYCLES;
        this.account(handler.name, inclusive - handler.nested);
        this.interrupted[this.handlers.length] += whole;
        if (this.handlers.length > 0) this.handlers.at(-1).nested += whole;
        while (this.calls.length > 0 && this.calls.at(-1).depth > this.handlers.length) this.calls.pop();
    }

    // ---- Functions -----------------------------------------------------------------------------------

    measure(name, address) {
        this.functions.set(address, name);
    }

    // Called at every taken branch while functions are measured. `link`: the return address register.
    branch(target, cycles) {
        const depth = this.handlers.length;
        for (let call = this.calls.at(-1); call?.returnAddress === target && call.stack === this.R[13]; call = this.calls.at(-1)) {
            if (call.depth !== depth) break;
            this.calls.pop();
            this.account(call.name, cycles - call.start - (this.interrupted[depth] - call.interrupted));
        }
        const name = this.functions.get(target);
        if (name === undefined) return;
        this.calls.push({ name, returnAddress: this.R[14] & ~1, stack: this.R[13], start: cycles, interrupted: this.interrupted[depth], depth });
    }
}

// PIO in lock-step with the processor's clock. Stock rp2040js runs it from a JavaScript timer, ignores the clock
// divider and the delays. Here every state machine is an alarm at its own next cycle, on the grid of the system clock.

import { FIFO } from 'rp2040js';

const SM_FIRST = 0x0c8, SM_LAST = 0x128, SM_SIZE = 0x18;
const CLKDIV = 0, SHIFTCTRL = 8;
const AUTOPULL = 1 << 17;
const OUT = 0b011; // in the upper three bits of an instruction
const WAITS_FOR_WORD = 5; // WaitType.Out of rp2040js
const TX_DEPTH = [4, 8, 0, 0], RX_DEPTH = [4, 0, 8, 0]; // by FJOIN_TX, FJOIN_RX

class Machine {
    constructor({ pio, machine, clock, S }) {
        Object.assign(this, { pio, machine, clock, S });
        this.join = 0;
        this.divider = 1;      // system clocks for a cycle
        this.originNanos = 0;  // `due` counts system clocks from here
        this.due = 0;
        this.scheduled = false;
        this.stepping = false;
        this.alarm = clock.createAlarm(() => this.step());
        this.checkWait = machine.checkWait.bind(machine);
        machine.checkWait = () => this.resume();
        this.writeFIFO = machine.writeFIFO.bind(machine);
        machine.writeFIFO = (value) => {
            this.writeFIFO(value);
            if (machine.enabled) this.refill();
        };
        machine.clkDivRestart = () => this.cancel();
    }

    at(due) {
        this.due = due;
        this.scheduled = true;
        const nanos = this.originNanos + Math.floor(due + 1e-6) * this.S.nanosPerCycle;
        this.alarm.schedule(Math.max(0, nanos - this.clock.nanosCounter));
    }

    cancel() {
        if (this.scheduled) this.alarm.cancel();
        this.scheduled = false;
    }

    // With autopull an empty shift register takes the next word at once, not when it is needed. True: it did.
    refill() {
        const { machine } = this;
        if (!(machine.shiftCtrl & AUTOPULL) || machine.outputShiftCount < machine.pullThreshold || machine.txFIFO.empty
            || (machine.waiting && machine.waitType === WAITS_FOR_WORD)) return false;
        machine.outputShiftReg = machine.txFIFO.pull();
        machine.outputShiftCount = 0;
        machine.updateDMATx();
        machine.pio.checkInterrupts();
        return true;
    }

    step() {
        const { machine, pio } = this, before = machine.cycles;
        this.scheduled = false;
        if (this.refill() && pio.instructions[machine.pc] >>> 13 === OUT) {
            this.at(this.due + this.divider); // it executes a cycle later
            return;
        }
        this.stepping = true;
        machine.step();
        this.stepping = false;
        this.refill();
        pio.checkChangedPins();
        if (machine.enabled && !machine.waiting) this.at(this.due + (machine.cycles - before) * this.divider);
    }

    // A stalled instruction completes on the next cycle of this machine, then its delay, then the next instruction.
    resume() {
        const { machine } = this, waited = machine.waiting, delay = Math.max(0, machine.waitDelay);
        this.checkWait();
        if (!waited || machine.waiting || !machine.enabled || this.stepping) return;
        const cycles = (this.clock.nanosCounter - this.originNanos) / this.S.nanosPerCycle / this.divider;
        this.at((Math.ceil(cycles - 1e-6) + 1 + delay) * this.divider);
        this.pio.checkChangedPins();
    }

    // Starts or stops with the enable bit.
    follow() {
        const { machine } = this;
        if (!machine.enabled) this.cancel();
        else if (!machine.waiting && !this.scheduled) {
            this.originNanos = this.clock.nanosCounter;
            this.at(this.divider);
        }
    }

    rebase() {
        this.originNanos = this.scheduled ? this.alarm.nanos : this.clock.nanosCounter;
        this.due = 0;
    }

    setDivider() {
        const { machine } = this;
        this.rebase();
        this.divider = (machine.clockDivInt || 65536) + machine.clockDivFrac / 256;
    }

    setJoin(join) {
        if (join === this.join) return;
        this.join = join;
        this.machine.txFIFO = new FIFO(TX_DEPTH[join]);
        this.machine.rxFIFO = new FIFO(RX_DEPTH[join]);
        this.machine.updateDMATx();
        this.machine.updateDMARx();
    }
}

// Returns rebase(), to be called after a change of the system clock.
export function installPio({ mcu, clock, S }) {
    const all = [];
    for (const pio of mcu.pio) {
        const write = pio.writeUint32.bind(pio);
        const machines = pio.machines.map((machine) => new Machine({ pio, machine, clock, S }));
        all.push(...machines);
        pio.run = () => {};
        pio.writeUint32 = (offset, value) => {
            write(offset, value);
            if (offset >= SM_FIRST && offset < SM_LAST) {
                const machine = machines[Math.floor((offset - SM_FIRST) / SM_SIZE)], register = (offset - SM_FIRST) % SM_SIZE;
                if (register === CLKDIV) machine.setDivider();
                if (register === SHIFTCTRL) machine.setJoin(value >>> 30);
                pio.checkChangedPins();
                machine.follow();
            } else if (offset === 0) {
                machines.forEach((machine) => machine.follow());
            }
        };
    }
    return () => all.forEach((machine) => machine.rebase());
}

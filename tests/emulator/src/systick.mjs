// SysTick: a 24-bit counter that pends its exception each time it counts from 1 to 0, exactly every RELOAD + 1
// cycles, whether the core runs, sleeps or has interrupts masked. Also logs each stretch of running, so that a trace
// can be put on the grid of ticks.

import { EXCEPTION } from './nvic.mjs';

const REFERENCE_NANOS = 1000; // the 1 MHz reference clock, used when CLKSOURCE is 0

export class SysTick {
    constructor({ nvic, clock, nanosPerCycle }) {
        Object.assign(this, { nvic, clock, nanosPerCycle });
        this.enabled = false;
        this.interrupt = false;
        this.fromCore = false;
        this.counted = false; // COUNTFLAG
        this.reload = 0;
        this.value = 0;       // while it stands still
        this.zeroNanos = 0;   // when it reaches 0 next, while it runs
        this.runs = [];       // [{ firstNanos, periodNanos, count }], newest last; count: ticks so far
        this.alarm = clock.createAlarm(() => this.zero());
    }

    unit() {
        return this.fromCore ? this.nanosPerCycle() : REFERENCE_NANOS;
    }

    readControl() {
        const counted = this.counted ? 1 << 16 : 0;
        this.counted = false;
        return counted | (this.fromCore ? 4 : 0) | (this.interrupt ? 2 : 0) | (this.enabled ? 1 : 0);
    }

    writeControl(value) {
        const value0 = this.current();
        this.stop(value0);
        this.interrupt = (value & 2) !== 0;
        this.fromCore = (value & 4) !== 0;
        if (value & 1) this.start();
    }

    current() {
        if (!this.enabled) return this.value;
        const left = Math.ceil((this.zeroNanos - this.clock.nanosCounter) / this.unit() - 1e-6);
        return left > this.reload || left < 0 ? 0 : left;
    }

    // Any write clears it; it reloads with the next clock.
    clear() {
        const { enabled } = this;
        this.stop(0);
        this.counted = false;
        if (enabled) this.start();
    }

    stop(value) {
        this.alarm.cancel();
        this.enabled = false;
        this.value = value;
    }

    start() {
        this.enabled = true;
        const cycles = this.value > 0 ? this.value : this.reload + 1;
        if (this.value === 0 && this.reload === 0) return; // stands at zero
        this.zeroNanos = this.clock.nanosCounter + cycles * this.unit();
        this.alarm.schedule(cycles * this.unit());
        const last = this.runs.at(-1), periodNanos = (this.reload + 1) * this.unit();
        if (!last || last.firstNanos + last.count * last.periodNanos !== this.zeroNanos || last.periodNanos !== periodNanos) {
            this.runs.push({ firstNanos: this.zeroNanos, periodNanos, count: 0 });
        }
    }

    zero() {
        this.counted = true;
        this.runs.at(-1).count += 1;
        if (this.reload > 0) {
            this.zeroNanos += (this.reload + 1) * this.unit();
            this.alarm.schedule(this.zeroNanos - this.clock.nanosCounter);
        }
        if (this.interrupt) this.nvic.pendSystem(EXCEPTION.SYSTICK, true);
    }

    // The system clock changed: the cycles left take longer or shorter from now on.
    clockChanged(oldNanosPerCycle) {
        if (!this.enabled || !this.fromCore) return;
        const left = (this.zeroNanos - this.clock.nanosCounter) / oldNanosPerCycle;
        this.stop(left);
        this.start();
    }
}

// One life of the chip, from power-up or restart to the next restart: puts the parts together around rp2040js's
// memories and peripherals, boots, and runs in virtual time.

import fs from 'node:fs';
import { RP2040 } from 'rp2040js';
import { Bus } from './bus.mjs';
import { installCoreRegisters } from './core_registers.mjs';
import { createExecutor } from './executor.mjs';
import { Flash } from './flash.mjs';
import { Mpu } from './mpu.mjs';
import { Nvic } from './nvic.mjs';
import { Pads } from './pads.mjs';
import { I2c } from './i2c.mjs';
import { installPio } from './pio.mjs';
import { installReset, RESET } from './reset.mjs';
import { installSio } from './sio.mjs';
import { Spi } from './spi.mjs';
import { createState } from './state.mjs';
import { createSystem } from './system.mjs';
import { SysTick } from './systick.mjs';
import { installTimer } from './timer.mjs';
import { Uart } from './uart.mjs';
import { UsbHost } from './usb.mjs';

const BOOT2_SIZE = 256, BOOT2_RAM = 0x20041f00; // where the boot ROM copies the second stage and runs it

export class Chip {
    // `shared`: what outlives the chip: { flash, ram, external, weak, bootrom, survivors, cyclesBefore };
    // `listener`: onFault(text, pc), onEdge(gpio, level), onPad(gpio), onSerial(bytes), onConnected(), onUart(byte).
    constructor(shared, listener) {
        this.S = createState();
        this.S.cyclesBefore = shared.cyclesBefore;
        this.R = new Int32Array(16);
        this.buildMemory(shared);
        this.buildCore(shared, listener);
        this.buildPeripherals(shared, listener);
        this.boot();
    }

    // ---- Building ------------------------------------------------------------------------------------

    buildMemory({ flash, ram, bootrom }) {
        const mcu = new RP2040();
        mcu.logger = { debug() {}, info() {}, warn() {}, error() {} };
        mcu.loadBootrom(bootrom);
        Object.assign(mcu, { flash, flash16: new Uint16Array(flash.buffer), flashView: new DataView(flash.buffer) });
        Object.assign(mcu, { sram: ram, sramView: new DataView(ram.buffer) });
        this.mcu = mcu;
        this.clock = mcu.clock;
        const rom = mcu.bootrom.buffer;
        this.memory = {
            ram8: ram, ram16: new Uint16Array(ram.buffer), ram32: new Int32Array(ram.buffer),
            flash8: flash, flash16: mcu.flash16, flash32: new Int32Array(flash.buffer),
            rom8: new Uint8Array(rom), rom16: new Uint16Array(rom), rom32: new Int32Array(rom),
        };
    }

    buildCore({ flash }, listener) {
        const { S, R, mcu, clock } = this;
        this.bus = new Bus({ S, mcu, clock, onFault: listener.onFault });
        this.nvic = new Nvic({
            S, R, bus: this.bus, ram32: this.memory.ram32, advance: (cycles) => this.advance(cycles),
        });
        this.systick = new SysTick({ nvic: this.nvic, clock, nanosPerCycle: () => S.nanosPerCycle });
        this.flash = new Flash({ mcu, S, clock, bytes: flash, onFault: listener.onFault });
        Object.assign(this.bus, { nvic: this.nvic, flash: this.flash });
        mcu.core = this.nvic; // the peripherals raise their interrupts here
        installCoreRegisters({
            mcu, S, nvic: this.nvic, systick: this.systick, mpu: new Mpu({ S, onFault: listener.onFault }),
            onReset: () => { S.reset = RESET.SYSTEM; },
        });
        const system = createSystem({ S, R, bus: this.bus, nvic: this.nvic });
        this.execute = createExecutor({ S, R, memory: this.memory, bus: this.bus, system });
    }

    buildPeripherals({ external, weak, survivors }, listener) {
        const { S, mcu, clock } = this;
        this.pads = new Pads({
            mcu, external, weak, onEdge: listener.onEdge, onPad: listener.onPad,
            onFault: (text) => listener.onFault(text, S.pc),
        });
        installSio({ mcu, pads: this.pads });
        installTimer({ mcu, clock });
        this.survivors = installReset({ mcu, S, survivors });
        this.uarts = [0, 1].map((index) => new Uart({ mcu, clock, index, onByte: (byte) => listener.onUart(index, byte) }));
        this.i2cs = [0, 1].map((index) => new I2c({ mcu, clock, index }));
        this.spis = [0, 1].map((index) => new Spi({ mcu, clock, index }));
        this.usb = new UsbHost({ mcu, clock, onData: listener.onSerial, onConnected: listener.onConnected });
        const rebasePio = installPio({ mcu, clock, S });
        mcu.addClockListener((frequency) => this.clockChanged(frequency, rebasePio));
    }

    clockChanged(frequency, rebasePio) {
        const { S } = this, old = S.nanosPerCycle, cycles = (this.clock.nanosCounter - S.startNanos) / old;
        S.nanosPerCycle = 1e9 / frequency;
        // The cycles of this run so far keep their number; the line of time is bent here.
        S.startNanos = this.clock.nanosCounter - cycles * S.nanosPerCycle;
        this.systick.clockChanged(old);
        rebasePio();
    }

    // As the boot ROM does it: the second stage runs from RAM and goes on to the program's vector table.
    boot() {
        const { S, R, memory } = this;
        memory.ram8.set(memory.flash8.subarray(0, BOOT2_SIZE), BOOT2_RAM - 0x20000000);
        R[13] = BOOT2_RAM;
        R[14] = 0;
        S.pc = BOOT2_RAM;
    }

    // ---- Running -------------------------------------------------------------------------------------

    // Cycles since power-up at the present instruction.
    cycles() {
        const { S } = this;
        return S.cyclesBefore + (this.clock.nanosCounter - S.startNanos) / S.nanosPerCycle;
    }

    // Lets `cycles` pass outside of instructions; what is due happens.
    advance(cycles) {
        const { S } = this;
        this.clock.tick(cycles * S.nanosPerCycle);
        S.cyclesBefore += cycles;
        S.startNanos = this.clock.nanosCounter;
    }

    // Runs until the clock reaches `limitNanos` or the chip restarts (true).
    run(limitNanos) {
        const { S, nvic, clock } = this;
        S.limitNanos = limitNanos;
        while (!S.reset) {
            if (S.excReturn) nvic.leave();
            if (S.sleeping && nvic.wakes()) S.sleeping = 0;
            if (nvic.ready !== 0 && !S.sleeping && !S.locked) {
                nvic.take();
            } else if (nvic.returned) {
                nvic.unchain();
                continue; // something may have come meanwhile
            }
            if (clock.nanosCounter >= S.limitNanos) return false;
            if (S.sleeping || S.locked) this.sleep();
            else this.runInstructions();
        }
        return true;
    }

    runInstructions() {
        const { S, bus, clock } = this;
        S.startNanos = clock.nanosCounter;
        S.leave = 0;
        bus.refreshStop();
        if (S.stop < 0) return;
        const cycles = this.execute();
        clock.nanosCounter = S.startNanos; // alarms of the stretch fire in advance()
        this.advance(cycles);
    }

    // Ends the present run sooner, for something that has come up in it.
    limit(nanos) {
        this.S.limitNanos = Math.min(this.S.limitNanos, nanos);
    }

    sleep() {
        const { S, clock } = this, alarm = clock.nextAlarm;
        const until = alarm !== null && alarm.nanos < S.limitNanos ? alarm.nanos : S.limitNanos;
        const nanos = Math.max(0, until - clock.nanosCounter);
        this.advance(nanos / S.nanosPerCycle);
    }

    // Calls `watch(target, cycles since power-up)` at every taken branch; null: nobody.
    watchBranches(watch) {
        const { S } = this;
        S.watch = watch === null ? null : (target, cycles) => watch(target, S.cyclesBefore + cycles);
    }
}

export function readBootrom(file) {
    if (!fs.existsSync(file)) throw new Error(`boot ROM ${file} is missing; run make test once, or see tests/emulator/README.md`);
    const data = fs.readFileSync(file);
    return new Uint32Array(data.buffer.slice(data.byteOffset, data.byteOffset + data.length));
}

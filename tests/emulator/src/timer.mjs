// Corrections to rp2040js's timers: hardware alarms fire exactly when the microsecond begins (stock truncates the
// delay and is up to 1 us early), and the DMA pacing timers divide the right way round.

const ALARM0 = 0x10, ALARM3 = 0x1c, FIRST_DMA_TIMER = 59;

export function installTimer({ mcu, clock }) {
    const timer = mcu.peripherals[0x40054], write = timer.writeUint32.bind(timer);
    timer.writeUint32 = (offset, value) => {
        if (offset < ALARM0 || offset > ALARM3) return write(offset, value);
        const alarm = timer.alarms[(offset - ALARM0) >> 2], nowUs = Math.floor(clock.nanosCounter / 1000);
        const targetUs = nowUs + ((value - nowUs) >>> 0);
        alarm.armed = true;
        alarm.targetMicros = value >>> 0;
        alarm.clockAlarm.schedule(Math.max(0, targetUs * 1000 - clock.nanosCounter));
    };

    const { dma } = mcu;
    dma.getTimer = (request) => {
        const fraction = [dma.timer0, dma.timer1, dma.timer2, dma.timer3][request - FIRST_DMA_TIMER] >>> 0;
        const x = fraction >>> 16, y = fraction & 0xffff;
        return x > 0 ? (y / x) * 1e6 / mcu.clkSys : 0; // microseconds for each transfer: X/Y of the system clock
    };
}

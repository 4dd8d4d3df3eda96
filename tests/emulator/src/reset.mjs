// Everything that restarts the chip: watchdog time-out, watchdog trigger, SYSRESETREQ. Flash, RAM and the watchdog's
// scratch registers survive, as on the chip.

export const RESET = { NONE: 0, TIMEOUT: 1, FORCED: 2, SYSTEM: 4 };
const REASON_MASK = 3; // what WATCHDOG_REASON shows

// `survivors`: { reason, scratch } of the life before; undefined at power-up. Returns a function that gives those of
// this life.
export function installReset({ mcu, S, survivors }) {
    const watchdog = mcu.peripherals[0x40058];
    if (survivors) {
        watchdog.scratchData.set(survivors.scratch);
        watchdog.reason = survivors.reason & REASON_MASK;
    }
    watchdog.onWatchdogTrigger = () => {
        watchdog.alarm.enable = false; // stock would trigger again and again in the same instant
        watchdog.timer.enable = false;
        S.reset = watchdog.reason || RESET.TIMEOUT;
        S.stop = -1;
    };
    return () => ({ reason: S.reset, scratch: watchdog.scratchData.slice() });
}

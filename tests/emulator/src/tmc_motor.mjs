// A motor behind a stepper driver: the field turns with the steps, the rotor follows it. Where something holds the
// rotor, the field runs ahead; by more than two full steps, and the rotor falls back to the next place where it fits,
// four full steps (one electrical period) away. Places are in 1/256 of a full step.

export const FULL_STEP = 256;
const PERIOD = 4 * FULL_STEP;

export class Motor {
    // `at`: where it stands; it cannot leave `low` to `high`. `load` (0 to 1): how much of its torque is used up.
    constructor({ at = 0, low = -Infinity, high = Infinity, load = 0 }) {
        Object.assign(this, { field: at, rotor: at, low, high, load });
        this.offset = 0;    // of the rotor's place in the field, periods lost
        this.slips = 0;
        this.unsettled = 0; // way of the field until a rotor that slipped runs evenly again
    }

    // Turns the field.
    turn(way) {
        this.field += way;
        this.unsettled = Math.max(0, this.unsettled - Math.abs(way));
        this.follow();
        if (Math.abs(this.lag) <= 2 * FULL_STEP) return;
        this.offset -= Math.sign(this.lag) * PERIOD;
        this.slips += 1;
        this.unsettled = PERIOD;
        this.follow();
    }

    follow() {
        this.rotor = Math.min(this.high, Math.max(this.low, this.field + this.offset));
    }

    // How far the field is ahead of the rotor.
    get lag() {
        return this.field + this.offset - this.rotor;
    }

    // The share of its torque that is left: 1 free, 0 at a full step of lag, where it is largest, and beyond.
    get reserve() {
        if (this.unsettled > 0) return 0;
        return Math.max(0, (1 - this.load) * (1 - Math.abs(this.lag) / FULL_STEP));
    }

    // Something is in the way at a place from now on; null: no more.
    block(place) {
        if (place === null) [this.low, this.high] = this.free ?? [this.low, this.high];
        else {
            this.free ??= [this.low, this.high];
            if (this.rotor <= place) this.high = Math.min(this.high, place);
            else this.low = Math.max(this.low, place);
        }
    }
}

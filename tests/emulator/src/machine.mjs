// Axes at the step and direction pins, and the switches they press, as the host port's --machine has them.

export class Axis {
    // `step`, `dir`: GPIOs; `at`: where it stands, steps.
    constructor({ step, dir, inverted = false, at = 0 }) {
        Object.assign(this, { step, dir, inverted, at });
        this.switches = [];
        this.driver = null; // that turns a motor with the steps (tmc2209.mjs); without one each step is made
    }

    // `pin` is driven to `level` from step `from` to step `to`, otherwise to the other one. For
    // `bounces` edges behind each change, 20 us apart, the contact opens and closes.
    addSwitch({ pin, from = -Infinity, to = Infinity, level = 0, bounces = 0 }, board) {
        const added = { pin, from, to, level, bounces, pressed: null };
        this.switches.push(added);
        this.look(added, board);
    }

    look(contact, board) {
        const pressed = this.at >= contact.from && this.at <= contact.to;
        if (pressed === contact.pressed) return;
        const first = contact.pressed === null;
        contact.pressed = pressed;
        const drive = (closed) => board.setPin(contact.pin, closed ? contact.level : 1 - contact.level);
        drive(pressed);
        for (let n = 1; n <= 2 * contact.bounces && !first; n++) {
            board.at(board.now + n * 20e3, () => drive(n % 2 === 0 ? contact.pressed : !contact.pressed));
        }
    }

    // An edge of an output pin.
    edge(gpio, level, board) {
        if (gpio !== this.step || level === 0) return;
        const way = (board.level(this.dir) === 1) !== this.inverted ? 1 : -1;
        this.at = this.driver === null ? this.at + way : this.driver.step(way);
        this.switches.forEach((contact) => this.look(contact, board));
    }
}

// The pads: the level of a pin is what drives it, else what is connected outside, else its pull, else what it was.
// Read-back, edge interrupts and PIO inputs follow that level; edges of outputs go to the recorder.

const LOW_OR_HIGH = 2; // states of rp2040js's pins below this are driven: 0 low, 1 high, then inputs
const PULL_UP = 3, PULL_DOWN = 4;

export class Pads {
    // `external`: for each pin 0, 1 or null (nothing connected); kept across resets of the chip.
    // `weak`: for each pin whether that is behind a resistor, so that the pin itself wins; kept as well.
    // `onEdge(gpio, level)`: an output changed. `onPad(gpio)`: the level of a pin has changed, or whether it is driven.
    // `onFault(text)`: two drivers fight.
    constructor({ mcu, external, weak, onEdge, onPad, onFault }) {
        Object.assign(this, { mcu, external, weak, onEdge, onPad, onFault });
        this.inputs = 0; // what GPIO_IN reads
        this.driven = new Array(mcu.gpio.length).fill(false);
        this.fighting = new Array(mcu.gpio.length).fill(false);
        mcu.gpio.forEach((pin, gpio) => {
            this.followInput(pin, gpio);
            pin.addListener((state) => this.update(pin, gpio, state));
            this.update(pin, gpio, pin.value);
        });
    }

    // Keeps `inputs` right whatever changes: level, input enable, override.
    followInput(pin, gpio) {
        const { setInputValue, checkForUpdates } = Object.getPrototypeOf(pin), bit = 1 << gpio;
        const note = () => {
            this.inputs = pin.inputValue ? this.inputs | bit : this.inputs & ~bit;
        };
        pin.setInputValue = (level) => {
            setInputValue.call(pin, level);
            note();
        };
        pin.checkForUpdates = () => {
            checkForUpdates.call(pin);
            note();
        };
    }

    level(pin, gpio, state) {
        if (state < LOW_OR_HIGH) return state === 1;
        if (this.external[gpio] !== null) return this.external[gpio] === 1;
        if (state === PULL_UP) return true;
        return state === PULL_DOWN ? false : pin.rawInputValue;
    }

    update(pin, gpio, state) {
        const level = this.level(pin, gpio, state), driven = state < LOW_OR_HIGH;
        const before = this.driven[gpio], changed = level !== pin.rawInputValue;
        this.checkFight(gpio, driven, level);
        this.driven[gpio] = driven;
        if (changed) {
            pin.setInputValue(level);
            if (driven || before) this.onEdge(gpio, level ? 1 : 0);
        }
        if (changed || driven !== before) this.onPad(gpio);
    }

    checkFight(gpio, driven, level) {
        const external = this.external[gpio];
        const fights = driven && external !== null && !this.weak[gpio] && (external === 1) !== level;
        if (fights && !this.fighting[gpio]) this.onFault(`GPIO${gpio} is driven from both sides`);
        this.fighting[gpio] = fights;
    }

    // Something outside drives the pin to 0 or 1 or lets go of it (null); through a resistor if `weak`.
    connect(gpio, level, weak = false) {
        this.external[gpio] = level;
        this.weak[gpio] = weak;
        const pin = this.mcu.gpio[gpio];
        this.update(pin, gpio, pin.value);
    }
}

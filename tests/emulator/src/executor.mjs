// Makes the interpreter: one function with one switch over the rows of the instruction table. It is generated
// because a switch over plain numbers is several times faster in V8 than a table of functions.

import { INSTRUCTIONS, UNDEFINED_EFFECT } from './instructions.mjs';

export const RAM_SIZE = 264 * 1024, ROM_SIZE = 16 * 1024;

// Operands of a row: name, shift and mask of each letter of its pattern.
export function operands(pattern) {
    const found = new Map();
    [...pattern].forEach((letter, position) => {
        if (letter === '0' || letter === '1') return;
        const field = found.get(letter) ?? { name: letter, shift: 0, width: 0 };
        field.width += 1;
        field.shift = 15 - position;
        found.set(letter, field);
    });
    return [...found.values()];
}

// For each of the 65536 half-words the number of its row + 1; 0: undefined. The first row that fits wins.
export function decodeTable() {
    const table = new Uint8Array(65536);
    INSTRUCTIONS.forEach(([, pattern], row) => {
        const mask = parseInt(pattern.replace(/[01]/g, '1').replace(/[^01]/g, '0'), 2);
        const value = parseInt(pattern.replace(/[^01]/g, '0'), 2);
        for (let op = 0; op < 65536; op++) {
            if ((op & mask) === value && table[op] === 0) table[op] = row + 1;
        }
    });
    return table;
}

function caseText([name, pattern, effect, kind], row) {
    const fields = operands(pattern)
        .map(({ name: letter, shift, width }) => `${letter} = op >> ${shift} & ${2 ** width - 1}`);
    const advance = kind === 'flow' ? '' : ' pc = (pc + 2) | 0; cyc += 1;';
    return `case ${row + 1}: { // ${name}
${fields.length ? `const ${fields.join(', ')};` : ''} ${effect}${advance} continue; }`;
}

// Returns run(): executes from S.pc until S.stop cycles have gone by (S.stop below 0: at once) and returns the
// cycles used. `memory` has the views of RAM, flash and boot ROM, `bus` everything else, `system` the rare instructions.
export function createExecutor({ S, R, memory, bus, system }) {
    const source = `
const { ram8, ram16, ram32, flash8, flash16, flash32, rom8, rom16, rom32 } = memory;
const loadWord = (a, cyc) => {
    const o = (a - 0x20000000) >>> 0;
    return o < RAM_SIZE && (o & 3) === 0 ? ram32[o >>> 2] : bus.read32(a >>> 0, cyc);
};
const storeWord = (a, value, cyc) => {
    const o = (a - 0x20000000) >>> 0;
    if (o < RAM_SIZE && (o & 3) === 0 && ((o - S.guardStart) >>> 0) >= S.guardSize) ram32[o >>> 2] = value;
    else bus.write32(a >>> 0, value, cyc);
};
const codeAt = (a) => {
    const o = (a - 0x20000000) >>> 0, f = (a - 0x10000000) >>> 0;
    return o < RAM_SIZE ? ram16[o >>> 1] : f < S.xip ? flash16[f >>> 1] : bus.fetch(a >>> 0, 0);
};
return function run() {
    let pc = S.pc, nz = S.nz, c = S.c, v = S.v, cyc = 0, stop = S.stop;
    const { xip, watch, guardStart, guardSize } = S;
    while (cyc < stop) {
        const o = (pc - 0x20000000) >>> 0, f = (pc - 0x10000000) >>> 0;
        let op;
        if (o < RAM_SIZE) op = ram16[o >>> 1];
        else if (f < xip) op = flash16[f >>> 1];
        else if ((pc >>> 0) < ROM_SIZE) op = rom16[pc >>> 1];
        else { S.pc = pc; op = bus.fetch(pc >>> 0, cyc); stop = S.stop; if (stop < 0) break; }
        switch (K[op]) {
${INSTRUCTIONS.map(caseText).join('\n')}
default: { ${UNDEFINED_EFFECT} }
        }
    }
    S.pc = pc; S.nz = nz; S.c = c; S.v = v;
    return cyc;
};`;
    const BITS = Uint8Array.from({ length: 256 }, (_, i) => i.toString(2).replace(/0/g, '').length);
    const names = ['S', 'R', 'memory', 'bus', 'system', 'K', 'BITS', 'RAM_SIZE', 'ROM_SIZE'];
    return new Function(...names, source)(S, R, memory, bus, system, decodeTable(), BITS, RAM_SIZE, ROM_SIZE);
}

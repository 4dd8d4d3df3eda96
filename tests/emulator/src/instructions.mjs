// The Thumb instructions of the Cortex-M0+ as a table: name, bit pattern, effect as JavaScript text.
// executor.mjs makes the interpreter out of it. Letters in a pattern are operands and become constants of the same
// name in the effect. An effect may use
//   R[0..14]  registers (Int32Array, R[13] is the stack pointer in use)
//   nz c v    flags: nz holds the last result (N is its sign, Z is its being zero), c and v are 0 or 1
//   pc        address of this instruction; rows of kind 'flow' must set it themselves
//   cyc       cycles so far; rows of kind 'flow' must count theirs; of others it counts 1, and memory its own
// Cycle counts: Cortex-M0+ technical reference manual, zero wait states, single-cycle multiplier.

// ---- Texts that rows share ------------------------------------------------------------------------

const add = (target, a, b) => `{ const x = ${a}, y = ${b}, z = (x + y) | 0;
    c = (z >>> 0) < (x >>> 0) ? 1 : 0; v = ((x ^ z) & (y ^ z)) >>> 31; nz = z; ${target && `${target} = z;`} }`;
const subtract = (target, a, b) => `{ const x = ${a}, y = ${b}, z = (x - y) | 0;
    c = (x >>> 0) >= (y >>> 0) ? 1 : 0; v = ((x ^ y) & (x ^ z)) >>> 31; nz = z; ${target && `${target} = z;`} }`;
const addWithCarry = (target, a, b) => `{ const x = ${a}, y = ${b}, sum = (x >>> 0) + (y >>> 0) + c, z = sum | 0;
    c = sum > 0xffffffff ? 1 : 0; v = ((x ^ z) & (y ^ z)) >>> 31; nz = z; ${target} = z; }`;
const logic = (target, value) => `nz = ${value}; ${target && `${target} = nz;`}`;

const ARRAY = { 1: ['ram8', 'flash8', 'rom8'], 2: ['ram16', 'flash16', 'rom16'], 4: ['ram32', 'flash32', 'rom32'] };
const SHIFT = { 1: 0, 2: 1, 4: 2 };

// RAM, flash and boot ROM (floating point) directly, everything else over the bus, which sets S.cost and may move S.stop.
const load = (size, target, address, extend = '') => {
    const [ram, flash, rom] = ARRAY[size], aligned = (x) => (size > 1 ? ` && (${x} & ${size - 1}) === 0` : '');
    return `{ const a = (${address}) | 0, o = (a - 0x20000000) >>> 0; let w;
    if (o < RAM_SIZE${aligned('o')}) { w = ${ram}[o >>> ${SHIFT[size]}]; cyc += 1; }
    else { const f = (a - 0x10000000) >>> 0;
        if (f < xip${aligned('f')}) { w = ${flash}[f >>> ${SHIFT[size]}]; cyc += 1; }
        else if ((a >>> 0) < ROM_SIZE${aligned('a')}) { w = ${rom}[a >>> ${SHIFT[size]}]; cyc += 1; }
        else { S.pc = pc; w = bus.read${size * 8}(a >>> 0, cyc); stop = S.stop; cyc += S.cost - 1; } }
    ${target} = ${extend ? `${extend}` : 'w'}; }`;
};
const store = (size, value, address) => {
    const [ram] = ARRAY[size], aligned = size > 1 ? ` && (o & ${size - 1}) === 0` : '';
    return `{ const a = (${address}) | 0, o = (a - 0x20000000) >>> 0;
    if (o < RAM_SIZE${aligned} && ((o - guardStart) >>> 0) >= guardSize) { ${ram}[o >>> ${SHIFT[size]}] = ${value}; cyc += 1; }
    else { S.pc = pc; bus.write${size * 8}(a >>> 0, ${value}, cyc); stop = S.stop; cyc += S.cost - 1; } }`;
};

// A branch to a register's value: `x` has the address with the Thumb bit, or in a handler the magic value that
// returns from the exception.
const interwork = (x, cycles) => `{ const x = ${x}; cyc += ${cycles};
    if ((x >>> 28) === 15 && S.ipsr !== 0) { S.excReturn = x; S.pc = pc; S.stop = stop = -1; }
    else if ((x & 1) === 0) { S.pc = pc; bus.fault('branch to ARM state', x); stop = S.stop; }
    else { pc = x & ~1; if (watch !== null) watch(pc, cyc); } }`;
const jump = (target, cycles) => `{ pc = (${target}) | 0; cyc += ${cycles}; if (watch !== null) watch(pc, cyc); }`;

// Anything that touches the state of the core beyond registers and flags is done in system.mjs.
const SYSTEM = `S.pc = pc; S.nz = nz; S.c = c; S.v = v; S.now = cyc;
    system(op); pc = S.pc; nz = S.nz; c = S.c; v = S.v; stop = S.stop; cyc += S.cost;`;

const BIT = (value, bit) => `((${value}) >>> (${bit})) & 1`;
const CONDITIONS = ['nz === 0', 'c === 1', 'nz < 0', 'v === 1', 'c === 1 && nz !== 0', '(nz < 0) === (v === 1)',
    'nz !== 0 && (nz < 0) === (v === 1)'];
const condition = (number) => (number & 1 ? `!(${CONDITIONS[number >> 1]})` : CONDITIONS[number >> 1]);

// Shifts by a register use its lowest byte; 32 and more push everything out.
const shiftByRegister = (small, at32, beyond) => `{ const x = R[d], s = R[m] & 255; let z = x;
    if (s > 0) { if (s < 32) { ${small} } else if (s === 32) { ${at32} } else { ${beyond} } } R[d] = nz = z; }`;

// ---- The table ------------------------------------------------------------------------------------

export const INSTRUCTIONS = [
    ['LSLS imm', '00000iiiiimmmddd', `{ const x = R[m]; if (i > 0) c = ${BIT('x', '32 - i')}; R[d] = nz = x << i; }`],
    ['LSRS imm', '00001iiiiimmmddd',
        `{ const x = R[m]; c = ${BIT('x', '(i || 32) - 1')}; R[d] = nz = i > 0 ? (x >>> i) | 0 : 0; }`],
    ['ASRS imm', '00010iiiiimmmddd', `{ const x = R[m]; c = ${BIT('x', '(i || 32) - 1')}; R[d] = nz = x >> (i || 31); }`],
    ['ADDS reg', '0001100mmmnnnddd', add('R[d]', 'R[n]', 'R[m]')],
    ['SUBS reg', '0001101mmmnnnddd', subtract('R[d]', 'R[n]', 'R[m]')],
    ['ADDS imm3', '0001110iiinnnddd', add('R[d]', 'R[n]', 'i')],
    ['SUBS imm3', '0001111iiinnnddd', subtract('R[d]', 'R[n]', 'i')],
    ['MOVS imm', '00100dddiiiiiiii', logic('R[d]', 'i')],
    ['CMP imm', '00101nnniiiiiiii', subtract('', 'R[n]', 'i')],
    ['ADDS imm8', '00110dddiiiiiiii', add('R[d]', 'R[d]', 'i')],
    ['SUBS imm8', '00111dddiiiiiiii', subtract('R[d]', 'R[d]', 'i')],
    ['ANDS', '0100000000mmmddd', logic('R[d]', 'R[d] & R[m]')],
    ['EORS', '0100000001mmmddd', logic('R[d]', 'R[d] ^ R[m]')],
    ['LSLS reg', '0100000010mmmddd', shiftByRegister(
        `c = ${BIT('x', '32 - s')}; z = x << s;`, 'c = x & 1; z = 0;', 'c = 0; z = 0;')],
    ['LSRS reg', '0100000011mmmddd', shiftByRegister(
        `c = ${BIT('x', 's - 1')}; z = (x >>> s) | 0;`, 'c = x >>> 31; z = 0;', 'c = 0; z = 0;')],
    ['ASRS reg', '0100000100mmmddd', shiftByRegister(
        `c = ${BIT('x', 's - 1')}; z = x >> s;`, 'c = x >>> 31; z = x >> 31;', 'c = x >>> 31; z = x >> 31;')],
    ['ADCS', '0100000101mmmddd', addWithCarry('R[d]', 'R[d]', 'R[m]')],
    ['SBCS', '0100000110mmmddd', addWithCarry('R[d]', 'R[d]', '~R[m]')],
    ['RORS', '0100000111mmmddd', `{ const x = R[d], s = R[m] & 255; let z = x;
        if (s > 0) { const k = s & 31; z = k > 0 ? (x >>> k) | (x << (32 - k)) : x; c = z >>> 31; } R[d] = nz = z; }`],
    ['TST', '0100001000mmmnnn', logic('', 'R[n] & R[m]')],
    ['RSBS', '0100001001nnnddd', subtract('R[d]', '0', 'R[n]')],
    ['CMP reg', '0100001010mmmnnn', subtract('', 'R[n]', 'R[m]')],
    ['CMN', '0100001011mmmnnn', add('', 'R[n]', 'R[m]')],
    ['ORRS', '0100001100mmmddd', logic('R[d]', 'R[d] | R[m]')],
    ['MULS', '0100001101nnnddd', logic('R[d]', 'Math.imul(R[d], R[n])')],
    ['BICS', '0100001110mmmddd', logic('R[d]', 'R[d] & ~R[m]')],
    ['MVNS', '0100001111mmmddd', logic('R[d]', '~R[m]')],
    ['ADD pc', '010001001mmmm111', jump('(pc + 4 + (m === 15 ? pc + 4 : R[m])) & ~1', 2), 'flow'],
    ['ADD hi', '01000100Dmmmmddd', `{ const r = D << 3 | d, z = (R[r] + (m === 15 ? pc + 4 : R[m])) | 0;
        R[r] = r === 13 ? z & ~3 : z; }`],
    ['CMP hi', '01000101Nmmmmnnn', subtract('', 'R[N << 3 | n]', '(m === 15 ? pc + 4 : R[m])')],
    ['MOV pc', '010001101mmmm111', jump('(m === 15 ? pc + 4 : R[m]) & ~1', 2), 'flow'],
    ['MOV hi', '01000110Dmmmmddd', `{ const r = D << 3 | d, z = m === 15 ? pc + 4 : R[m];
        R[r] = r === 13 ? z & ~3 : z; }`],
    ['BX', '010001110mmmm000', interwork('R[m]', 2), 'flow'],
    ['BLX', '010001111mmmm000', `{ const target = R[m]; R[14] = (pc + 2) | 1; ${interwork('target', 2)} }`, 'flow'],
    ['LDR literal', '01001tttiiiiiiii', load(4, 'R[t]', '((pc + 4) & ~3) + (i << 2)')],
    ['STR reg', '0101000mmmnnnttt', store(4, 'R[t]', 'R[n] + R[m]')],
    ['STRH reg', '0101001mmmnnnttt', store(2, 'R[t]', 'R[n] + R[m]')],
    ['STRB reg', '0101010mmmnnnttt', store(1, 'R[t]', 'R[n] + R[m]')],
    ['LDRSB reg', '0101011mmmnnnttt', load(1, 'R[t]', 'R[n] + R[m]', '(w << 24) >> 24')],
    ['LDR reg', '0101100mmmnnnttt', load(4, 'R[t]', 'R[n] + R[m]')],
    ['LDRH reg', '0101101mmmnnnttt', load(2, 'R[t]', 'R[n] + R[m]')],
    ['LDRB reg', '0101110mmmnnnttt', load(1, 'R[t]', 'R[n] + R[m]')],
    ['LDRSH reg', '0101111mmmnnnttt', load(2, 'R[t]', 'R[n] + R[m]', '(w << 16) >> 16')],
    ['STR imm', '01100iiiiinnnttt', store(4, 'R[t]', 'R[n] + (i << 2)')],
    ['LDR imm', '01101iiiiinnnttt', load(4, 'R[t]', 'R[n] + (i << 2)')],
    ['STRB imm', '01110iiiiinnnttt', store(1, 'R[t]', 'R[n] + i')],
    ['LDRB imm', '01111iiiiinnnttt', load(1, 'R[t]', 'R[n] + i')],
    ['STRH imm', '10000iiiiinnnttt', store(2, 'R[t]', 'R[n] + (i << 1)')],
    ['LDRH imm', '10001iiiiinnnttt', load(2, 'R[t]', 'R[n] + (i << 1)')],
    ['STR sp', '10010tttiiiiiiii', store(4, 'R[t]', 'R[13] + (i << 2)')],
    ['LDR sp', '10011tttiiiiiiii', load(4, 'R[t]', 'R[13] + (i << 2)')],
    ['ADR', '10100dddiiiiiiii', 'R[d] = ((pc + 4) & ~3) + (i << 2);'],
    ['ADD rd sp', '10101dddiiiiiiii', 'R[d] = R[13] + (i << 2);'],
    ['ADD sp', '101100000iiiiiii', 'R[13] = R[13] + (i << 2);'],
    ['SUB sp', '101100001iiiiiii', 'R[13] = R[13] - (i << 2);'],
    ['SXTH', '1011001000mmmddd', 'R[d] = (R[m] << 16) >> 16;'],
    ['SXTB', '1011001001mmmddd', 'R[d] = (R[m] << 24) >> 24;'],
    ['UXTH', '1011001010mmmddd', 'R[d] = R[m] & 0xffff;'],
    ['UXTB', '1011001011mmmddd', 'R[d] = R[m] & 0xff;'],
    ['PUSH', '1011010kllllllll', `{ let a = R[13] - 4 * (BITS[l] + k); R[13] = a; S.pc = pc;
        for (let r = 0; r < 8; r++) if (l >> r & 1) { storeWord(a, R[r], cyc); a += 4; cyc += 1; }
        if (k === 1) { storeWord(a, R[14], cyc); cyc += 1; } stop = S.stop; }`],
    ['CPS', '10110110011i0010', SYSTEM, 'flow'],
    ['REV', '1011101000mmmddd', `{ const x = R[m];
        R[d] = x << 24 | (x & 0xff00) << 8 | (x >> 8) & 0xff00 | x >>> 24; }`],
    ['REV16', '1011101001mmmddd', '{ const x = R[m]; R[d] = (x & 0xff00ff) << 8 | (x >>> 8) & 0xff00ff; }'],
    ['REVSH', '1011101011mmmddd', '{ const x = R[m]; R[d] = (x << 24) >> 16 | (x >> 8) & 0xff; }'],
    ['POP', '10111100llllllll', `{ let a = R[13]; S.pc = pc;
        for (let r = 0; r < 8; r++) if (l >> r & 1) { R[r] = loadWord(a, cyc); a += 4; cyc += 1; }
        R[13] = a; stop = S.stop; }`],
    ['POP pc', '10111101llllllll', `{ let a = R[13]; S.pc = pc;
        for (let r = 0; r < 8; r++) if (l >> r & 1) { R[r] = loadWord(a, cyc); a += 4; cyc += 1; }
        const target = loadWord(a, cyc); R[13] = a + 4; stop = S.stop; ${interwork('target', 4)} }`, 'flow'],
    ['BKPT', '10111110iiiiiiii', SYSTEM, 'flow'],
    ['NOP', '1011111100000000', ''],
    ['YIELD', '1011111100010000', ''],
    ['WFE', '1011111100100000', SYSTEM, 'flow'],
    ['WFI', '1011111100110000', SYSTEM, 'flow'],
    ['SEV', '1011111101000000', SYSTEM, 'flow'],
    ['STM', '11000nnnllllllll', `{ let a = R[n]; S.pc = pc;
        for (let r = 0; r < 8; r++) if (l >> r & 1) { storeWord(a, R[r], cyc); a += 4; cyc += 1; }
        R[n] = a; stop = S.stop; }`],
    ['LDM', '11001nnnllllllll', `{ let a = R[n]; S.pc = pc;
        for (let r = 0; r < 8; r++) if (l >> r & 1) { R[r] = loadWord(a, cyc); a += 4; cyc += 1; }
        if ((l >> n & 1) === 0) R[n] = a; stop = S.stop; }`],
    ...Array.from({ length: 14 }, (_, k) => [`B cond ${k}`, `1101${k.toString(2).padStart(4, '0')}iiiiiiii`,
        `if (${condition(k)}) ${jump('pc + 4 + ((i << 24) >> 23)', 2)} else { pc = (pc + 2) | 0; cyc += 1; }`, 'flow']),
    ['SVC', '11011111iiiiiiii', SYSTEM, 'flow'],
    ['B', '11100iiiiiiiiiii', jump('pc + 4 + ((i << 21) >> 20)', 2), 'flow'],
    ['BL, 32 bit', '11110siiiiiiiiii', `{ const op2 = codeAt(pc + 2);
        if ((op2 & 0xd000) === 0xd000) {
            const j1 = (op2 >> 13 & 1) ^ s ^ 1, j2 = (op2 >> 11 & 1) ^ s ^ 1;
            R[14] = (pc + 4) | 1;
            ${jump('pc + 4 + ((s ? 0xff000000 : 0) | j1 << 23 | j2 << 22 | i << 12 | (op2 & 0x7ff) << 1)', 3)}
        } else { ${SYSTEM} } }`, 'flow'],
];

// Anything else, the permanently undefined UDF among it.
export const UNDEFINED_EFFECT = SYSTEM;

// Symbols of a 32-bit little-endian ELF file: name -> { address, size, isFunction }, and the function at an address.

import fs from 'node:fs';

const SYMBOL_TABLE = 2, OBJECT = 1, FUNCTION = 2;

export class Symbols {
    constructor(file) {
        this.byName = new Map();
        this.functions = []; // sorted by address
        if (!file) return;
        const data = fs.readFileSync(file);
        if (data.readUInt32BE(0) !== 0x7f454c46 || data[4] !== 1) throw new Error(`${file} is not a 32-bit ELF file`);
        this.read(data);
        this.functions = [...this.byName].filter(([, s]) => s.isFunction)
            .map(([name, { address, size }]) => ({ name, address, size })).sort((a, b) => a.address - b.address);
    }

    read(data) {
        const sections = data.readUInt32LE(32), size = data.readUInt16LE(46), count = data.readUInt16LE(48);
        const section = (i) => ({
            type: data.readUInt32LE(sections + i * size + 4), offset: data.readUInt32LE(sections + i * size + 16),
            length: data.readUInt32LE(sections + i * size + 20), link: data.readUInt32LE(sections + i * size + 24),
        });
        for (let i = 0; i < count; i++) {
            const table = section(i);
            if (table.type === SYMBOL_TABLE) this.readTable(data, table, section(table.link).offset);
        }
    }

    readTable(data, { offset, length }, names) {
        for (let entry = offset; entry < offset + length; entry += 16) {
            const type = data[entry + 12] & 15;
            if (type !== OBJECT && type !== FUNCTION) continue;
            const start = names + data.readUInt32LE(entry), name = data.toString('latin1', start, data.indexOf(0, start));
            const isFunction = type === FUNCTION, value = data.readUInt32LE(entry + 4);
            this.byName.set(name, { address: isFunction ? value & ~1 : value, size: data.readUInt32LE(entry + 8), isFunction });
        }
    }

    address(name) {
        const symbol = this.byName.get(name);
        if (symbol === undefined) throw new Error(`no symbol ${name}`);
        return symbol.address;
    }

    // "hal_on_tick+0x12", or "" if the address is in no function.
    describe(address) {
        let found = null;
        for (const candidate of this.functions) {
            if (candidate.address > address) break;
            if (address < candidate.address + Math.max(candidate.size, 2)) found = candidate;
        }
        return found === null ? '' : `${found.name}+0x${(address - found.address).toString(16)}`;
    }
}

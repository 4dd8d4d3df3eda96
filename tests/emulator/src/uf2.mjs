// Reads a UF2 file into an image of the flash.

import fs from 'node:fs';
import { FLASH_SIZE } from './flash.mjs';

const BLOCK = 512, MAGIC0 = 0x0a324655, MAGIC1 = 0x9e5d5157, MAGIC_END = 0x0ab16f30;
const FLASH_START = 0x10000000, NOT_MAIN_FLASH = 1, FAMILY_PRESENT = 0x2000, RP2040 = 0xe48bff56;

export function readUf2(file) {
    const data = fs.readFileSync(file), image = new Uint8Array(FLASH_SIZE).fill(0xff);
    if (data.length === 0 || data.length % BLOCK !== 0) throw new Error(`${file} is not a UF2 file`);
    for (let offset = 0; offset < data.length; offset += BLOCK) {
        const word = (i) => data.readUInt32LE(offset + 4 * i);
        if (word(0) !== MAGIC0 || word(1) !== MAGIC1 || word(127) !== MAGIC_END) throw new Error(`${file} is not a UF2 file`);
        const flags = word(2), address = word(3) - FLASH_START, length = word(4);
        if (flags & NOT_MAIN_FLASH) continue;
        if (flags & FAMILY_PRESENT && word(7) !== RP2040) throw new Error(`${file} is not for the RP2040`);
        if (address < 0 || address + length > FLASH_SIZE) throw new Error(`${file} does not fit the flash`);
        image.set(data.subarray(offset + 32, offset + 32 + length), address);
    }
    return image;
}

// What the bench reads and writes: inputs, edges, UF2 files, USB descriptors.

import assert from 'node:assert/strict';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import test from 'node:test';
import { Symbols } from '../src/elf.mjs';
import { Recorder, readEvents, writeVcd } from '../src/recorder.mjs';
import { readUf2 } from '../src/uf2.mjs';
import { findSerialPort } from '../src/usb.mjs';

const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'stepmite-'));
const write = (name, content) => {
    const file = path.join(folder, name);
    fs.writeFileSync(file, content);
    return file;
};
test.after(() => fs.rmSync(folder, { recursive: true }));

test('inputs are sorted by time', () => {
    const file = write('events.csv', 'time_ns,gpio,level\r\n200,3,0\r\n\r\n100, 4, 1\n');
    assert.deepEqual(readEvents(file), [{ timeNanos: 100, gpio: 4, level: 1 }, { timeNanos: 200, gpio: 3, level: 0 }]);
});

for (const [row, what] of [['x,1,1', 'a time'], ['1,30,0', 'a pin'], ['1,2,2', 'a level'], ['1,2', 'a column'], ['-1,2,0', 'the past']]) {
    test(`a bad row names its line: ${what}`, () => {
        const file = write('bad.csv', `time_ns,gpio,level\n1,2,0\n${row}\n`);
        assert.throws(() => readEvents(file), /bad\.csv:3: want time_ns,gpio,level/);
    });
}

test('inputs without a header are refused', () => {
    assert.throws(() => readEvents(write('none.csv', '1,2,0\n')), /none\.csv:1: the header must be/);
});

test('a trace is complete after close, in the order of time', () => {
    const recorder = new Recorder(), file = path.join(folder, 'edges.csv');
    recorder.writeTo(file);
    for (let i = 0; i < 50001; i++) recorder.add(8 * i, i % 30, i & 1);
    recorder.close();
    const lines = fs.readFileSync(file, 'utf8').trimEnd().split('\n');
    assert.equal(lines.length, 50002);
    assert.equal(lines[0], 'time_ns,gpio,level');
    assert.equal(lines.at(-1), `${8 * 50000},${50000 % 30},0`);
});

test('a waveform file has every pin and every change', () => {
    const file = path.join(folder, 'x.vcd');
    writeVcd(file, [0, 2, 1, 8, 3, 0, 16, 2, 0], 40);
    assert.equal(fs.readFileSync(file, 'utf8'), [
        '$timescale 1ns $end', '$var wire 1 # GP2 $end', '$var wire 1 $ GP3 $end', '$enddefinitions $end',
        '#0', '$dumpvars', '0#', '1$', '$end', '1#', '#8', '0$', '#16', '0#', '#40', ''].join('\n'));
});

test('UF2: not one, for another chip, beyond the flash', () => {
    const block = Buffer.alloc(512);
    [0x0a324655, 0x9e5d5157, 0x2000, 0x10000000, 256, 0, 1, 0xe48bff56].forEach((word, i) => block.writeUInt32LE(word, 4 * i));
    block.fill(0x5a, 32, 288);
    block.writeUInt32LE(0x0ab16f30, 508);
    const image = readUf2(write('good.uf2', block));
    assert.deepEqual([...image.subarray(254, 258)], [0x5a, 0x5a, 0xff, 0xff]);
    assert.throws(() => readUf2(write('short.uf2', block.subarray(0, 511))), /is not a UF2 file/);
    const other = Buffer.from(block);
    other.writeUInt32LE(0xe48bff59, 28);
    assert.throws(() => readUf2(write('rp2350.uf2', other)), /is not for the RP2040/);
    const beyond = Buffer.from(block);
    beyond.writeUInt32LE(0x10200000, 12);
    assert.throws(() => readUf2(write('beyond.uf2', beyond)), /does not fit the flash/);
});

test('an ELF file for a PC has no symbols for us', () => {
    assert.throws(() => new Symbols(process.execPath), /is not a 32-bit ELF file/);
});

test('the first serial port of a composite device is found', () => {
    const network = [9, 4, 0, 0, 1, 0xff, 0, 0, 0, 7, 5, 0x81, 2, 64, 0, 0];
    const serial = [9, 4, 3, 0, 1, 2, 2, 0, 0, 5, 36, 0, 0x20, 1, 7, 5, 0x82, 3, 8, 0, 16,
        9, 4, 4, 0, 2, 10, 0, 0, 0, 7, 5, 0x03, 2, 64, 0, 0, 7, 5, 0x83, 2, 64, 0, 0];
    const second = [9, 4, 5, 0, 1, 2, 2, 0, 0, 9, 4, 6, 0, 2, 10, 0, 0, 0, 7, 5, 0x04, 2, 64, 0, 0, 7, 5, 0x84, 2, 64, 0, 0];
    const head = [9, 2, 0, 0, 0, 1, 0, 0, 0];
    assert.deepEqual(findSerialPort([...head, ...network, ...serial, ...second]), { control: 3, in: 3, out: 3 });
    assert.equal(findSerialPort([...head, ...network]), null);
    assert.equal(findSerialPort([...head, ...serial.slice(0, 30)]), null);
});

// The trace: every edge of every output, with its virtual time, and the edges to apply to inputs.

import fs from 'node:fs';

const HEADER = 'time_ns,gpio,level';
const FLUSH_ROWS = 20000;

export class Recorder {
    constructor() {
        this.edges = []; // time_ns, gpio, level, time_ns, ...
        this.file = null;
        this.keep = true;
        this.hash = null;
    }

    // Writes the edges to a file as they come (in blocks) instead of keeping them.
    writeTo(name) {
        this.file = fs.openSync(name, 'w');
        this.keep = false;
        fs.writeSync(this.file, `${HEADER}\n`);
    }

    add(timeNanos, gpio, level) {
        this.edges.push(Math.round(timeNanos), gpio, level);
        if (!this.keep && this.edges.length >= 3 * FLUSH_ROWS) this.flush();
    }

    flush() {
        if (this.file === null) return;
        fs.writeSync(this.file, csvRows(this.edges));
        this.edges.length = 0;
    }

    close() {
        this.flush();
        if (this.file !== null) fs.closeSync(this.file);
        this.file = null;
    }
}

function csvRows(edges) {
    const rows = [];
    for (let i = 0; i < edges.length; i += 3) rows.push(`${edges[i]},${edges[i + 1]},${edges[i + 2]}\n`);
    return rows.join('');
}

export function writeCsv(file, edges) {
    fs.writeFileSync(file, `${HEADER}\n${csvRows(edges)}`);
}

// Value change dump, for any waveform viewer. Each edge is a change, so a pin had the other level before its first one. It
// ends at `untilNanos`.
export function writeVcd(file, edges, untilNanos) {
    const pins = [...new Set(edges.filter((_, i) => i % 3 === 1))].sort((a, b) => a - b), id = (gpio) => String.fromCharCode(33 + gpio);
    const lines = ['$timescale 1ns $end', ...pins.map((gpio) => `$var wire 1 ${id(gpio)} GP${gpio} $end`), '$enddefinitions $end'];
    const before = pins.map((gpio) => `${1 - edges[edges.findIndex((value, i) => i % 3 === 1 && value === gpio) + 1]}${id(gpio)}`);
    lines.push('#0', '$dumpvars', ...before, '$end');
    let last = 0;
    for (let i = 0; i < edges.length; i += 3) {
        if (edges[i] !== last) lines.push(`#${last = edges[i]}`);
        lines.push(`${edges[i + 2]}${id(edges[i + 1])}`);
    }
    if (untilNanos > last) lines.push(`#${untilNanos}`);
    fs.writeFileSync(file, `${lines.join('\n')}\n`);
}

// Reads an EVENTS.csv: [{ timeNanos, gpio, level }], in the order of time. Throws on the first bad line.
export function readEvents(file) {
    const lines = fs.readFileSync(file, 'utf8').split(/\r?\n/);
    if (lines[0].trim() !== HEADER) throw new Error(`${file}:1: the header must be ${HEADER}`);
    const events = [];
    lines.slice(1).forEach((line, i) => {
        if (line.trim() === '') return;
        const match = /^\s*(\d+)\s*,\s*(\d+)\s*,\s*([01])\s*$/.exec(line);
        if (!match || Number(match[2]) > 29) throw new Error(`${file}:${i + 2}: want time_ns,gpio,level with gpio 0 to 29 and level 0 or 1`);
        events.push({ timeNanos: Number(match[1]), gpio: Number(match[2]), level: Number(match[3]) });
    });
    return events.sort((a, b) => a.timeNanos - b.timeNanos);
}

// The bench as a process: JSON lines on stdin, one answer line on stdout for each. Virtual time moves only inside
// `run`, `expect` and `connect`; with `serve` it follows the wall clock (see serve.mjs).
//
// Request: {"op": name, ...arguments}. Answer: {"ok": true, "now": ns, "faults": count, ...} or {"ok": false, "error": text}.

import readline from 'node:readline';
import { Board } from './board.mjs';
import { readEvents, writeCsv, writeVcd } from './recorder.mjs';
import { serve } from './serve.mjs';

const MS = 1e6;
let board = null;

const bytesOf = (text) => Buffer.from(text, 'latin1');

// What each request does. Texts are latin1: a character is a byte.
const operations = {
    boot(options) { board = new Board(options); },
    run({ ms }) { board.run(board.now + ms * MS); },
    connect({ timeout_ms: timeout }) {
        if (!board.run(board.now + timeout * MS, () => board.connected)) throw new Error(`the board did not enumerate within ${timeout} ms`);
    },
    send({ text }) { board.send(bytesOf(text)); },
    expect({ pattern, timeout_ms: timeout }) { return { match: board.expect(new RegExp(pattern), timeout * MS) }; },
    until({ suffix, timeout_ms: timeout }) { return { text: board.until(suffix, timeout * MS) }; },
    output() {
        const text = board.output;
        board.output = '';
        return { text };
    },
    send_uart({ index, text }) { board.sendUart(index, bytesOf(text)); },
    uart_output({ index }) {
        const text = board.uartOutput[index];
        board.uartOutput[index] = '';
        return { text };
    },
    spi_words({ index }) { return { words: board.chip.spis[index].take() }; },
    host_reading({ on }) { board.chip.usb.setReading(on); },
    unplug() { board.chip.usb.unplug(); },
    plug() { board.chip.usb.plug(); },
    host_open({ dtr, rts }) { board.chip.usb.setLineState(dtr, rts); },
    line_coding({ baud }) { board.chip.usb.setLineCoding(baud); },
    queued() { return { bytes: board.chip.usb.queue.length }; },
    set_pin({ gpio, level, at_ns: at = null }) {
        if (at === null) board.setPin(gpio, level);
        else board.setPinAt(at, gpio, level);
    },
    add_axis({ name, ...options }) { board.addAxis(name, options); },
    add_switch({ name, ...options }) { board.addSwitch(name, options); },
    axis({ name }) { return { at: board.axes.get(name).at }; },
    add_tmc({ name, ...options }) { board.tmc.add(name, options); },
    tmc_fault({ name, driver = null, at_ns: at = null, ...options }) { board.tmc.inject(name, driver, at, options); },
    tmc_heal({ driver = null }) { board.tmc.heal(driver); },
    tmc({ name }) { return { registers: board.tmc.driver(name).dump(), motor: board.tmc.motor(name) }; },
    tmc_log() { return { entries: board.tmc.log.splice(0) }; },
    set_analog({ channel, reading }) { board.chip.mcu.adc.channelValues[channel] = reading; },
    level({ gpio }) { return { level: board.level(gpio) }; },
    inputs({ file }) {
        for (const event of readEvents(file)) board.setPinAt(event.timeNanos, event.gpio, event.level);
    },
    edges({ gpios = null }) {
        const all = board.recorder.edges, rows = [];
        for (let i = 0; i < all.length; i += 3) {
            if (gpios === null || gpios.includes(all[i + 1])) rows.push([all[i], all[i + 1], all[i + 2]]);
        }
        return { edges: rows };
    },
    clear_edges() { board.recorder.edges.length = 0; },
    trace({ file }) { board.recorder.writeTo(file); },
    write_csv({ file }) { writeCsv(file, board.recorder.edges); },
    write_vcd({ file }) { writeVcd(file, board.recorder.edges, Math.round(board.now)); },
    tick_runs() {
        return { runs: board.tickRuns().map((r) => ({ first_ns: r.firstNanos, period_ns: r.periodNanos, count: r.count })) };
    },
    measure({ functions }) { functions.forEach((name) => board.measure(name)); },
    keep_samples({ names }) { board.profile.keepSamples(names); },
    samples({ name }) { return { cycles: board.profile.samples.get(name) }; },
    profile() { return { profile: board.report() }; },
    clear_profile() { board.profile.clear(); },
    faults() { return { list: board.faults }; },
    clear_faults() { board.faults.length = 0; },
    peek({ address = null, symbol = null }) {
        return { value: board.peek(address ?? board.symbols.address(symbol)) };
    },
    symbol({ name }) { return { address: board.symbols.address(name), size: board.symbols.byName.get(name).size }; },
    status() {
        const { S } = board.chip;
        return { connected: board.connected, resets: board.resets, sleeping: S.sleeping, pc: S.pc >>> 0, where: board.symbols.describe(S.pc >>> 0), locked: S.locked };
    },
    save_storage({ file = null }) { board.saveStorage(file ?? undefined); },
    async serve(options) { return serve(board, options); },
    close() { board?.recorder.close(); },
};

async function answer(line) {
    const { op, ...options } = JSON.parse(line);
    if (!Object.hasOwn(operations, op)) throw new Error(`unknown operation ${op}`);
    if (board === null && op !== 'boot') throw new Error('boot first');
    const result = await operations[op](options);
    return { ok: true, now: board.now, faults: board.faults.length, ...result };
}

for await (const line of readline.createInterface({ input: process.stdin })) {
    const reply = await answer(line).catch((error) => ({ ok: false, error: error.message }));
    process.stdout.write(`${JSON.stringify(reply)}\n`);
    if (JSON.parse(line).op === 'close') break;
}
board?.recorder.close(); // also if the parent has vanished
process.exit(0);

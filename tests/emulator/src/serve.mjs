// The board in (at most) real time for programs that know nothing of virtual time: its serial port is a stream over
// a Unix socket, which the parent connects to a pty or a terminal. Both ways have back-pressure: nothing is lost
// however slow a side is.

import net from 'node:net';
import { performance } from 'node:perf_hooks';

const QUEUE_LIMIT = 4096;   // bytes for the board before the stream is left to wait
const SLICE_NANOS = 1e6;
const BEHIND_MS = 100;      // time lost beyond this is not caught up
const IDLE_NANOS = 100e6;   // at the prompt for so long after the end of input: done
const TAIL = 16;

const pause = (ms) => new Promise((resolve) => { if (ms > 0) setTimeout(resolve, ms); else setImmediate(resolve); });

function connect(path) {
    return new Promise((resolve, reject) => {
        const stream = net.connect({ path, allowHalfOpen: true }, () => resolve(stream));
        stream.once('error', reject);
    });
}

// Runs until the parent closes the socket; or, after it has closed its sending half, until the board waits at its
// prompt with motion at rest. `speed`: virtual seconds per wall second at most; 0: as fast as it can.
export async function serve(board, { socket: path, speed }) {
    const stream = await connect(path);
    let closed = false, ended = false, tail = '', activeNanos = board.now;
    stream.on('data', (data) => board.send(data));
    stream.on('end', () => { ended = true; });
    stream.on('close', () => { closed = true; });
    stream.on('error', () => { closed = true; });
    stream.on('drain', () => board.chip.usb.setReading(true));
    board.onSerial = (bytes) => {
        tail = (tail + Buffer.from(bytes).toString('latin1')).slice(-TAIL);
        activeNanos = board.now;
        if (!stream.write(Buffer.from(bytes))) board.chip.usb.setReading(false);
    };
    board.onSerial(Buffer.from(board.output, 'latin1')); // what it said before anyone listened
    board.output = '';

    const finished = () => {
        if (board.chip.usb.queue.length > 0 || board.chip.systick.enabled) activeNanos = board.now;
        return ended && tail.endsWith('> ') && board.now - activeNanos > IDLE_NANOS;
    };
    const pace = new Pace(board, speed);
    const parent = process.ppid; // a parent that is killed leaves a half-open socket behind
    while (!closed && !finished() && process.ppid === parent) {
        await pause(pace.aheadMs());
        if (board.chip.usb.queue.length < QUEUE_LIMIT) stream.resume();
        else stream.pause();
        board.run(board.now + SLICE_NANOS);
    }
    board.onSerial = null;
    stream.end();
}

// Holds virtual time to the wall clock.
class Pace {
    constructor(board, speed) {
        Object.assign(this, { board, speed });
        this.restart();
    }

    restart() {
        this.startNanos = this.board.now;
        this.startMs = performance.now();
    }

    // Milliseconds to wait before going on.
    aheadMs() {
        if (this.speed <= 0) return 0;
        const ahead = (this.board.now - this.startNanos) / 1e6 / this.speed - (performance.now() - this.startMs);
        if (ahead < -BEHIND_MS) this.restart();
        return ahead > 1 ? ahead : 0;
    }
}

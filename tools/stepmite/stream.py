"""Sends a G-code program to the prompt, line by line, and keeps the queue of the board filled.

Several G-code lines travel in one BASIC line, `STEPPER GS "..."` with a PRINT after each but the
last. The firmware carries the statements out one after the other and stops at the first that fails,
so the PRINTs tell which line was refused and nothing behind it has been executed.
"""

from __future__ import annotations

import re
import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field

from stepmite.board import LINE_MAX, Board, BoardError, BoardGone, Cancelled
from stepmite.gcode import AXES, Block, GcodeError, Reader, strip_comments
from stepmite.plan import Machine, plan

MARK = "7"
"""What the PRINT between two G-code lines prints."""

_SEPARATOR = f":?{MARK}:"
_STATUS_POSITION_KNOWN = 1 << 7
_STATUS_ESTOP = 1 << 6
_POLL_S = (0.005, 0.1)
_ANSWER_S = 60.0
CYCLE_S = 3600.0
"""Homing may take so long."""
_CYCLE = re.compile(r"G0*(28|38)", re.IGNORECASE)
"""Homing and probing: the board answers when they have ended. They need a machine at rest."""
STUCK_S = 3.0
"""A queue that stays full for so long while nothing moves is given up."""


class JobError(Exception):
    """The job ended early; the text is for the user, with file and line where there is one."""


@dataclass(frozen=True)
class Line:
    """One G-code line that has something to send."""

    number: int
    text: str
    """As it stands in the file."""
    code: str
    """Without comments and blanks."""
    slots: int
    """Queue slots it takes at most."""
    duration_s: float
    """Estimate of the motion it makes."""


@dataclass
class Job:
    """A program made ready for sending."""

    name: str
    lines: list[Line] = field(default_factory=list)
    blocks: list[Block] = field(default_factory=list)
    duration_s: float = 0.0
    unreadable: GcodeError | None = None
    """First line that this PC cannot follow; the firmware may still know it."""


@dataclass(frozen=True)
class Progress:
    """What the progress bar shows."""

    lines_sent: int
    seconds_done: float
    """Estimated seconds of motion behind us."""


def prepare(name: str, text: Iterable[str], machine: Machine | None = None) -> Job:
    """Check the file as far as sending it needs and estimate its time.

    JobError names file and line of what no prompt could take: quotes, control characters, lines too
    long.
    """
    job = Job(name)
    reader = Reader()
    rows: list[tuple[int, str, str, int]] = []
    for number, raw in enumerate(text, start=1):
        code = strip_comments(raw)
        if not code:
            continue
        _check_sendable(name, number, code)
        blocks = _read(job, reader, number, raw)
        rows.append((number, raw.strip(), code, max(1, len(blocks))))
        job.blocks += blocks
        if reader.ended:
            break
    seconds: dict[int, float] = {}
    for planned in plan(job.blocks, machine):
        number = planned.block.line_number
        seconds[number] = seconds.get(number, 0.0) + planned.duration_s()
    job.lines = [Line(*row, seconds.get(row[0], 0.0)) for row in rows]
    job.duration_s = sum(seconds.values())
    return job


def _check_sendable(name: str, number: int, code: str) -> None:
    if '"' in code:
        raise JobError(f"{name}:{number}: a double quote cannot be sent inside a BASIC string")
    if not code.isascii() or not code.isprintable():
        raise JobError(f"{name}:{number}: only plain ASCII characters can be sent")
    if len(_statement(code)) > LINE_MAX:
        raise JobError(f"{name}:{number}: the line is longer than the prompt takes ({LINE_MAX})")


def _read(job: Job, reader: Reader, number: int, raw: str) -> list[Block]:
    """Follow the program locally; after the first line that cannot be followed, not any more."""
    if job.unreadable is not None:
        return []
    try:
        return reader.read(number, raw)
    except GcodeError as error:
        job.unreadable = error
        return []


def _statement(code: str) -> str:
    return f'STEPPER GS "{code}"'


def _is_cycle(line: Line) -> bool:
    return _CYCLE.search(line.code) is not None


class Streamer:
    """Sends one job. Create it, call run() once; cancel() may be called from a signal handler."""

    def __init__(
        self,
        board: Board,
        job: Job,
        reserve: int = 0,
        arm: bool = True,
        on_progress: Callable[[Progress], None] | None = None,
    ) -> None:
        self._board = board
        self._job = job
        self._reserve = reserve
        self._to_the_end = arm
        self._may_arm = arm
        self._on_progress = on_progress
        self._cancel = False
        self._resume = False
        self._credit = 0
        self._free_most = 0
        self._full_since: float | None = None
        self._sent = 0
        self._done_s = 0.0
        self._queue: list[tuple[int, float]] = []
        board.cancelled = lambda: self._cancel

    def cancel(self) -> None:
        """Ask for a controlled stop; run() raises Cancelled when the machine stands still."""
        self._cancel = True

    def resume(self) -> None:
        """Let a program go on that waits at M0 or M6; may be called from another thread."""
        self._resume = True

    def run(self) -> None:
        """Send everything and wait until motion has ended.

        Raises JobError (refused line, machine not ready; the machine has then been brought to a
        controlled stop), Cancelled (after a controlled stop) or BoardGone.
        """
        try:
            self._check_ready()
            while self._sent < len(self._job.lines):
                if _is_cycle(self._job.lines[self._sent]):
                    self._wait_for_rest()
                self._send_batch(self._next_batch())
            if self._to_the_end:
                self._wait_for_end()
        except Cancelled:
            self._board.cancelled = None
            self._board.stop()
            raise
        finally:
            self._board.cancelled = None

    # ---- Before and after ---------------------------------------------------------------------

    def _check_ready(self) -> None:
        if self._board.peek("ACTIVE") < 0:
            raise JobError("the machine is not set up: STEPPER INIT and STEPPER AXIS come first")
        if not int(self._board.peek("STATUS")) & _STATUS_POSITION_KNOWN:
            raise JobError(
                "the position is not known: STEPPER GC G28 or STEPPER POSITION HOME comes first"
            )
        self._ask_for_slots()

    def _wait_for_end(self) -> None:
        while True:
            self._check_user()
            idle = self._board.peek("ACTIVE") <= 0
            left = self._ask_for_slots() < self._free_most
            if idle and not (left and self._start_if_idle()):
                break
            time.sleep(_POLL_S[1])
        self._check_unharmed()
        self._queue.clear()
        self._report(self._job.duration_s)

    def _wait_for_rest(self) -> None:
        """Come back when all that was sent has been carried out and the machine is armed.

        The board would wait as well, but then nobody could end a pause of the program from here.
        """
        self._start_if_idle()
        while self._board.peek("ACTIVE") > 0:
            self._check_user()
            self._ask_for_slots()
            time.sleep(_POLL_S[1])
        self._check_unharmed()
        self._ask_for_slots()

    def _check_unharmed(self) -> None:
        status = int(self._board.peek("STATUS"))
        if status & _STATUS_ESTOP:
            raise JobError("emergency stop: the job did not end")
        if not status & _STATUS_POSITION_KNOWN:
            raise JobError("the machine lost its position: the job did not end")

    def _start_if_idle(self) -> bool:
        """Arm a machine that has work and does nothing; False if it is no use."""
        if not self._may_arm:
            return False
        self._may_arm = False
        self._pass_on(self._board.command("STEPPER RUN"))
        return True

    # ---- The queue of the board ---------------------------------------------------------------

    def _ask_for_slots(self) -> int:
        free = int(self._board.peek("BUFFER"))
        self._free_most = max(self._free_most, free)
        self._credit = max(0, free - self._reserve)
        in_ring = self._free_most - free
        while self._queue and sum(slots for slots, _ in self._queue) > in_ring:
            self._done_s += self._queue.pop(0)[1]
        self._report(self._done_s)
        return free

    def _wait_for_slots(self, wanted: int) -> None:
        """Come back with room for `wanted` slots at least, better for a quarter of the queue."""
        goal = max(wanted, min((self._free_most - self._reserve) // 4, 16))
        if self._free_most - self._reserve < wanted:
            raise JobError(
                f"the queue of the board has {self._free_most} free slots, {self._reserve} of"
                " them kept in reserve: too few for a line"
            )
        stuck_since = None
        in_vain = 0
        while self._credit < goal:
            self._check_user()
            before = self._credit
            active = self._board.peek("ACTIVE") > 0
            self._ask_for_slots()
            if self._credit >= goal:
                return
            if self._credit > before or active:
                stuck_since = None
            elif not self._start_if_idle():
                if self._credit >= wanted:
                    return
                stuck_since = stuck_since or time.monotonic()
                if time.monotonic() - stuck_since > STUCK_S:
                    raise JobError("the queue of the board is full and nothing moves")
            in_vain = in_vain + 1 if self._credit == before else 0
            time.sleep(self._pause_s(in_vain))

    def _pause_s(self, in_vain: int) -> float:
        """Return how long to wait before the next question.

        A fraction of the motion in the queue. After many questions in vain the longest pause: the
        host build lets virtual time pass only while nobody talks to it.
        """
        in_ring_s = sum(seconds for _, seconds in self._queue)
        if in_vain > 10:
            return _POLL_S[1]
        return min(max(in_ring_s / 8, _POLL_S[0]), _POLL_S[1])

    # ---- Sending ------------------------------------------------------------------------------

    def _next_batch(self) -> list[Line]:
        """Take as many lines as there are free slots and as fit on a BASIC line, one at least."""
        lines = self._job.lines
        # What a long line does not find room for the board keeps, and takes up by and by.
        wanted = min(lines[self._sent].slots, max(1, (self._free_most - self._reserve) // 2))
        if self._credit < wanted:
            self._wait_for_slots(wanted)
        batch: list[Line] = []
        length = slots = 0
        for line in lines[self._sent :]:
            if batch and (_is_cycle(line) or _is_cycle(batch[0])):
                break
            length += len(_statement(line.code)) + (len(_SEPARATOR) if batch else 0)
            slots += line.slots
            if batch and (length > LINE_MAX or slots > self._credit):
                break
            batch.append(line)
        return batch

    def _send_batch(self, batch: list[Line]) -> None:
        self._check_user()
        try:
            output = self._board.command(
                _SEPARATOR.join(_statement(line.code) for line in batch),
                timeout_s=CYCLE_S if _is_cycle(batch[0]) else _ANSWER_S,
            )
        except BoardError as error:
            done = sum(1 for line in error.output if line.strip() == MARK)
            self._account(batch[:done])
            self._pass_on(error.output)
            if "buffer full" not in str(error).lower():
                self._refused(batch[done], str(error))
            self._wait_after_full(progress=done > 0)
            return
        self._full_since = None
        self._pass_on(output)
        if sum(1 for line in output if line.strip() == MARK) != len(batch) - 1:
            self._board.stop()
            raise JobError(
                f"{self._job.name}:{batch[0].number}: the answer of the board is unclear"
            )
        self._account(batch)

    def _wait_after_full(self, progress: bool) -> None:
        """Give a board that had less room than it said some time, but not for ever."""
        self._credit = 0
        now = time.monotonic()
        if progress or self._full_since is None:
            self._full_since = now
        moves = self._board.peek("ACTIVE") > 0 or self._start_if_idle()
        if not moves and now - self._full_since > STUCK_S:
            raise JobError("the queue of the board is full and nothing moves")
        time.sleep(_POLL_S[0])

    def _account(self, lines: list[Line]) -> None:
        for line in lines:
            self._credit -= line.slots
            self._queue.append((line.slots, line.duration_s))
        self._sent += len(lines)
        self._report(self._done_s)

    def _pass_on(self, output: list[str]) -> None:
        for line in output:
            if line.strip() != MARK and line.strip() and self._board.on_notice is not None:
                self._board.on_notice(line.strip())

    def _refused(self, line: Line, message: str) -> None:
        self._board.stop()
        raise JobError(f"{self._job.name}:{line.number}: {line.text}\n{message}")

    def _check_user(self) -> None:
        """Do what the user has asked for meanwhile."""
        if self._cancel:
            raise Cancelled
        if self._resume:
            self._resume = False
            self._pass_on(self._board.command("STEPPER RESUME"))

    def _report(self, seconds: float) -> None:
        if self._on_progress is not None:
            self._on_progress(Progress(self._sent, seconds))


def position_text(board: Board) -> str:
    """Return where the machine stands, for instance "X10.000 Y-5.250", axes that exist only."""
    parts = []
    for letter in AXES:
        try:
            parts.append(f"{letter}{board.peek(letter):.3f}")
        except BoardError:
            continue
    return " ".join(parts)


__all__ = [
    "BoardGone",
    "Cancelled",
    "Job",
    "JobError",
    "Line",
    "Progress",
    "Streamer",
    "position_text",
    "prepare",
]

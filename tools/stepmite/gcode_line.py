"""One line of G-code, carried out in the order of RS274/NGC on the state of a reader."""

from __future__ import annotations

from typing import TYPE_CHECKING

from stepmite.arcs import PLANES, Arc, Position, read_arc
from stepmite.gcode_cycles import Drill, steps_of
from stepmite.gcode_state import AXES, Block, PathMode, Series
from stepmite.gcode_words import CYCLES, MOTIONS, WORK_SYSTEMS

if TYPE_CHECKING:
    from stepmite.gcode import Reader

INCH_MM = 25.4
ARCS = ("G2", "G3")


class Line:
    """One line, carried out in the order of RS274/NGC."""

    def __init__(
        self, reader: Reader, number: int, codes: dict[str, str], values: dict[str, float]
    ) -> None:
        self.state = reader
        self.number = number
        self.codes = codes
        self.values = values
        self.blocks: list[Block] = []
        self.once = codes.get("codes of one line", "")

    def run(self) -> list[Block]:
        """Return the blocks."""
        self._set_speeds()
        self._switch()
        if self.once == "G4":
            self._dwell()
        self._set_modes()
        self.axes = {letter: self.values[letter] for letter in AXES if letter in self.values}
        if self.once and self.once not in ("G4", "G53"):
            self._act_once()
        else:
            self._move()
        self._end()
        return self.blocks

    # ---- Speeds, switches -----------------------------------------------------------------------

    def _set_speeds(self) -> None:
        mode = self.codes.get("feed modes")
        if mode is not None:
            if self.state.inverse_time != (mode == "G93"):
                self.state.feed_per_min = None
            self.state.inverse_time = mode == "G93"
        units = self.codes.get("units")
        if units is not None:  # F of this line counts in them already
            self.state.unit_mm = INCH_MM if units == "G20" else 1.0
        if "F" in self.values:
            if self.values["F"] <= 0:
                raise ValueError("F must be above 0")
            scale = 1.0 if self.state.inverse_time else self.state.unit_mm
            self.state.feed_per_min = self.values["F"] * scale
        if "S" in self.values:
            if self.values["S"] < 0:
                raise ValueError("S must not be below 0")
            self.state.speed_rpm = self.values["S"]

    def _add(self, kind: str, **fields: float | str | Arc | PathMode | None) -> None:
        self.blocks.append(Block(kind, self.number, self.state.position, **fields))

    def _spindle(self, code: str) -> None:
        self.state.spindle = code
        on = code != "M5"
        speed = self.state.speed_rpm if on else 0.0
        self._add("spindle", spindle_on=on, clockwise=code == "M3", speed_rpm=speed)

    def _set_coolant(self, names: frozenset[str]) -> None:
        self.state.coolant = names
        self._add("coolant", coolant=" ".join(sorted(names)))

    def _switch(self) -> None:
        if "tool changes" in self.codes:
            if self.state.spindle != "M5":
                self._spindle("M5")
            self._add("pause")
        if "spindle switches" in self.codes:
            self._spindle(self.codes["spindle switches"])
        coolant = self.codes.get("coolant switches")
        if coolant is not None:
            names = {"M7": {"mist"}, "M8": {"flood"}, "M9": set()}
            added = frozenset(names[coolant])
            self._set_coolant(self.state.coolant | added if added else frozenset())

    def _seconds(self) -> float:
        if self.values.get("P", -1.0) < 0:
            raise ValueError(f"{self.once or self.state.motion} without P")
        return self.values["P"] if self.state.nist else self.values["P"] / 1000

    def _dwell(self) -> None:
        self._add("dwell", dwell_s=self._seconds())

    # ---- Modes ----------------------------------------------------------------------------------

    def _set_modes(self) -> None:
        state, codes = self.state, self.codes
        state.plane = codes.get("planes", state.plane)
        if "tool lengths" in codes:
            self._set_tool_length(codes["tool lengths"])
        if "work coordinate systems" in codes:
            state.offsets.system = WORK_SYSTEMS.index(codes["work coordinate systems"])
        if "path modes" in codes:
            self._set_path_mode(codes["path modes"])
        state.absolute = codes.get("distance modes", "G90" if state.absolute else "G91") == "G90"
        if "centre modes" in codes:
            state.centres_from_start = codes["centre modes"] == "G91.1"
        if "retract modes" in codes:
            state.returns_to_initial = codes["retract modes"] == "G98"

    def _set_tool_length(self, code: str) -> None:
        offsets = self.state.offsets
        if code == "G43":
            tool = self.values.get("H", 0.0)
            if tool != int(tool) or not 0 <= tool < len(offsets.tools):
                raise ValueError("H must be the number of a tool")
            offsets.tool_mm = offsets.tools[int(tool)]
        elif code == "G43.1":
            if "Z" not in self.values:
                raise ValueError("G43.1 without Z")
            offsets.tool_mm = self.values.pop("Z") * self.state.unit_mm
        else:
            offsets.tool_mm = 0.0

    def _set_path_mode(self, code: str) -> None:
        tolerance = self.values.get("P", 0.0) * self.state.unit_mm if code == "G64" else 0.0
        if tolerance < 0:
            raise ValueError("P must not be below 0")
        self.state.path_mode = PathMode(code, tolerance)

    # ---- Codes of one line ----------------------------------------------------------------------

    def _act_once(self) -> None:
        code = self.once
        if code in ("G28.1", "G30.1"):
            self.state.stored[code[:3]] = self.state.position
        elif code == "G28.2" or (code == "G28" and not self.state.nist):
            self._home()
        elif code in ("G28", "G30"):
            self._go_to_stored(code)
        elif code == "G10":
            self._set_offsets()
        elif code == "G92":
            if not self.axes:
                raise ValueError("G92 without an axis")
            self._place(shifts=True)
        else:
            self._change_shift(code)

    def _home(self) -> None:
        place = list(self.state.position)
        for axis in range(3):
            if AXES[axis] in self.axes or not self.axes:
                place[axis] = 0.0
        self.state.position = (place[0], place[1], place[2], place[3])
        self._add("home")

    def _go_to_stored(self, code: str) -> None:
        if code == "G30" and not self.state.nist and self.values.get("P") == 1:
            code = "G28"
        start = self.state.position
        self._line_to(self._target(), None)
        stored = self.state.stored[code]
        every = not self.axes
        pairs = enumerate(zip(stored, start, strict=True))
        x, y, z, a = (to if every or AXES[i] in self.axes else was for i, (to, was) in pairs)
        self._line_to((x, y, z, a), None)

    def _place(self, shifts: bool) -> None:
        for axis, letter in enumerate(AXES):
            if letter in self.axes:
                value = self._length(axis)
                self.state.offsets.place(axis, value, self.state.position, shifts)

    def _length(self, axis: int) -> float:
        scale = self.state.unit_mm if axis < 3 else 1.0
        return self.axes[AXES[axis]] * scale

    def _set_offsets(self) -> None:
        offsets = self.state.offsets
        kind, number = self.values.get("L"), self.values.get("P", 0.0)
        if kind == 1:
            offsets.tools[int(number)] = self._length(2)
        elif kind in (2, 20) and number == int(number) and 0 <= number <= len(offsets.systems):
            before = offsets.system
            offsets.system = int(number) - 1 if number else before
            if kind == 20:
                self._place(shifts=False)
            for axis, letter in enumerate(AXES):
                if kind == 2 and letter in self.axes:
                    offsets.systems[offsets.system][axis] = self._length(axis)
            offsets.system = before
        else:
            raise ValueError("G10 needs L1, L2 or L20 and P")

    def _change_shift(self, code: str) -> None:
        offsets = self.state.offsets
        if code == "G92.3":
            offsets.shift = list(offsets.kept_shift)
            return
        offsets.kept_shift = list(offsets.shift if code == "G92.2" else [0.0] * 4)
        offsets.shift = [0.0] * 4

    # ---- Motion ---------------------------------------------------------------------------------

    def _move(self) -> None:
        state = self.state
        code = self.codes.get("motion modes")
        if code is not None or "ends of cycles" in self.codes:
            state.motion = code
        if state.motion not in CYCLES:
            state.series = None
        curved = any(letter in self.values for letter in "IJKR")
        if not self.axes and not (curved and state.motion in ARCS):
            if curved:
                raise ValueError("I J K R without an arc")
            return
        if state.motion is None:
            raise ValueError("a position without a motion mode, G0 to G3")
        if state.motion != "G0" and state.feed_per_min is None:
            raise ValueError(f"{state.motion} before any F")
        if state.inverse_time and state.motion != "G0" and "F" not in self.values:
            raise ValueError(f"G93 needs F in each line with {state.motion}")
        if state.motion in CYCLES:
            self._cycle(state.motion)
        elif curved and state.motion not in ARCS:
            raise ValueError("I J K R without an arc")
        elif state.motion in MOTIONS:
            self._simple_move(state.motion)

    def _target(self) -> Position:
        target = list(self.state.position)
        offset = [0.0] * 4 if self.once == "G53" else self.state.offsets.total()
        for axis, letter in enumerate(AXES):
            if letter in self.axes:
                relative = not self.state.absolute and self.once != "G53"
                base = self.state.position[axis] if relative else offset[axis]
                target[axis] = base + self._length(axis)
        return target[0], target[1], target[2], target[3]

    def _simple_move(self, code: str) -> None:
        if code in ARCS and not self.state.arcs_turn_a:
            self.axes.pop("A", None)
        end = self._target()
        if code not in ARCS:
            self._line_to(end, None if code == "G0" else self.state.feed_per_min)
            return
        arc = read_arc(
            code == "G2", PLANES[self.state.plane], self.state.position, end, self._curve_words()
        )
        self._push_move(end, self.state.feed_per_min, arc)

    def _curve_words(self) -> dict[str, float]:
        scaled = {k: v * self.state.unit_mm for k, v in self.values.items() if k in "IJKR"}
        if not self.state.centres_from_start:
            offset = self.state.offsets.total()
            for axis, letter in enumerate("IJK"):
                if letter in scaled:
                    scaled[letter] += offset[axis] - self.state.position[axis]
        return scaled | {k: v for k, v in self.values.items() if k == "P"}

    def _line_to(self, end: Position, feed_per_min: float | None) -> None:
        self._push_move(end, feed_per_min, None)

    def _push_move(self, end: Position, feed: float | None, arc: Arc | None) -> None:
        state = self.state
        if feed is not None and state.inverse_time:
            feed *= self._length_to(end, arc)
        start = state.position
        state.position = end
        if arc is None and start == end and feed is not None and state.inverse_time:
            return
        speed = state.speed_rpm if state.spindle != "M5" else 0.0
        self._add("move", feed_per_min=feed, arc=arc, path_mode=state.path_mode, speed_rpm=speed)

    def _length_to(self, end: Position, arc: Arc | None) -> float:
        if arc is not None:
            return arc.length(self.state.position, end)
        change = [b - a for a, b in zip(self.state.position, end, strict=True)]
        return sum(part * part for part in change[:3]) ** 0.5 or abs(change[3])

    # ---- Canned cycles --------------------------------------------------------------------------

    def _cycle(self, code: str) -> None:
        drill = self._drill(code)
        mode, self.state.path_mode = self.state.path_mode, PathMode("G61")
        for step in steps_of(drill):
            if step.kind == "dwell":
                self._add("dwell", dwell_s=step.seconds)
            else:
                feed = self.state.feed_per_min if step.kind == "feed" else None
                self._line_to(step.target, feed)
        self.state.path_mode = mode

    def _words_of_cycle(self, series: Series, across: str) -> dict[str, float]:
        """Return R, depth, Q and P, those of the lines before where they are left out."""
        unit = self.state.unit_mm
        for letter in ("R", across, "Q"):
            if letter in self.values:
                series.sticky[letter] = self.values[letter] * unit
        if "P" in self.values:
            series.sticky["P"] = self.values["P"]
        needed = {"G73": "Q", "G83": "Q", "G82": "P"}.get(series.code, "")
        for letter in ("R", across, *needed):
            if letter not in series.sticky:
                raise ValueError(f"{series.code} without {letter}")
        return series.sticky

    def _drill(self, code: str) -> Drill:
        state = self.state
        if "A" in self.axes or state.inverse_time:
            raise ValueError(f"{code} with A or with G93")
        plane = PLANES[state.plane]
        across = 3 - plane[0] - plane[1]
        height = state.position[across]
        if state.series is None:
            state.series = Series(code, height)
        elif state.series.code != code:
            state.series = Series(code, state.series.initial)
        words = self._words_of_cycle(state.series, AXES[across])
        repeats = self.values.get("L", 1.0)
        if repeats != int(repeats) or repeats < 1 or words.get("Q", 1.0) <= 0:
            raise ValueError("L must be a whole number from 1, Q above 0")
        zero = state.offsets.total()[across]
        clear = words["R"] + (zero if state.absolute else height)
        bottom = words[AXES[across]] + (zero if state.absolute else clear)
        if clear < bottom:
            raise ValueError(f"R is below {AXES[across]}")
        seconds = words.get("P", 0.0) * (1.0 if state.nist else 0.001)
        return Drill(
            code,
            state.position,
            plane,
            across,
            self._holes(plane, int(repeats)),
            clear,
            bottom,
            max(clear, state.series.initial) if state.returns_to_initial else clear,
            words["Q"] if code in ("G73", "G83") else 0.0,
            seconds,
        )

    def _holes(self, plane: tuple[int, int], repeats: int) -> tuple[tuple[float, float], ...]:
        holes = []
        place = self.state.position
        target = self._target()
        first = target[plane[0]] - place[plane[0]], target[plane[1]] - place[plane[1]]
        for n in range(1, repeats + 1):
            times = 1 if self.state.absolute else n
            holes.append((place[plane[0]] + first[0] * times, place[plane[1]] + first[1] * times))
        return tuple(holes)

    # ---- The end --------------------------------------------------------------------------------

    def _end(self) -> None:
        code = self.codes.get("ends")
        if code == "M0" or (code == "M1" and self.state.optional_stop):
            self._add("pause")
        elif code in ("M2", "M30"):
            self._end_program()

    def _end_program(self) -> None:
        state = self.state
        if state.spindle != "M5":
            self._spindle("M5")
        if state.coolant:
            self._set_coolant(frozenset())
        state.offsets.system = 0
        state.plane, state.absolute, state.motion = "G17", True, "G1"
        state.inverse_time = False
        state.series = None
        state.ended = True

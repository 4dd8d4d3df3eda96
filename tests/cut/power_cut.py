"""A session that changes everything that is kept, with the power cut at each of its flash writes.

After each step of the session what is kept is known. When the power is cut within a step, the next
start has to find what was kept before it or behind it, and nothing in between.
"""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path
from typing import NamedTuple

from littlefs import LittleFS, LittleFSError, UserContext

FILES_START = 256 * 1024
BLOCK = 4096
CUT = 3  # exit code of a power cut
TIMEOUT_S = 30
CTRL_Z = "\x1a"


class Step(NamedTuple):
    """What is typed, and what is kept from then on: (item, content); None: it is gone."""

    typed: str
    changes: dict[str, str | None]
    # What an item may be besides, in the middle of the step: OPEN makes an empty file.
    between: dict[str, str | None] | None = None


def text_of(letter: str, lines: int) -> str:
    """Text of 32 bytes a line."""
    return "".join(f"{letter * 24}{line:06d}\r\n" for line in range(lines))


def program_of(letter: str, lines: int) -> str:
    """A program of 32 bytes a line."""
    return "".join(f"REM {letter * 20}{line:07d}\n" for line in range(lines))


def store(program: str) -> str:
    """What to type to make it the program."""
    return f"AUTOSAVE\n{program}{CTRL_Z}"


def write(name: str, mode: str, letter: str, lines: int) -> str:
    """What to type to write text_of()."""
    text = f'STRING$(24,"{letter}");STR$(i,6,0,"0")'
    return f'OPEN "{name}" FOR {mode} AS #1:FOR i=0 TO {lines - 1}:PRINT #1,{text}:NEXT:CLOSE #1\n'


BEFORE = [
    Step(store(program_of("a", 140)), {"program": program_of("a", 140)}),
    Step('SAVE "p"\n', {"p.bas": program_of("a", 140)}),
    Step("OPTION TAB 4\n", {"options": "OPTION TAB 4"}),
    Step("v=1:VAR SAVE v\n", {"variables": " 1"}),
    Step(write("old", "OUTPUT", "b", 150), {"old": text_of("b", 150)}),
    Step(write("log", "OUTPUT", "c", 130), {"log": text_of("c", 130)}),
    Step(write("small", "OUTPUT", "d", 1), {"small": text_of("d", 1)}),
    Step('MKDIR "f"\n' + write("f/r", "OUTPUT", "e", 2), {"f/r": text_of("e", 2)}),
]

SESSION = [
    Step(store(program_of("A", 270)), {"program": program_of("A", 270)}),
    Step('SAVE "q"\n', {"q.bas": program_of("A", 270)}),
    Step('SAVE "p"\n', {"p.bas": program_of("A", 270)}),
    Step("OPTION TAB 8\n", {"options": "OPTION TAB 8"}),
    Step("OPTION DISPLAY 30,90\n", {"options": "OPTION TAB 8|OPTION DISPLAY 30, 90"}),
    Step("v=2:VAR SAVE v\n", {"variables": " 2"}),
    Step(write("new", "OUTPUT", "B", 140), {"new": text_of("B", 140)}, {"new": ""}),
    Step(write("old", "OUTPUT", "C", 3), {"old": text_of("C", 3)}),
    Step(write("log", "APPEND", "D", 140), {"log": text_of("c", 130) + text_of("D", 140)}),
    Step('RENAME "f/r" AS "moved"\n', {"f/r": None, "moved": text_of("e", 2)}),
    Step('COPY "old" TO "f/copy"\n', {"f/copy": text_of("C", 3)}),
    Step('KILL "small"\n', {"small": None}),
    Step('MKDIR "g":RMDIR "g"\n', {}),
    Step("VAR CLEAR\n", {"variables": " 0"}),
    Step("OPTION RESET\n", {"options": ""}),
    Step("NEW\n", {"program": ""}),
]


def keep(state: dict[str, str], changes: dict[str, str | None]) -> dict[str, str]:
    """Return the state with these changes."""
    merged = {**state, **changes}
    return {item: content for item, content in merged.items() if content is not None}


def run(program: Path, image: Path, typed: str, *options: str) -> tuple[int, str]:
    """One life of the board: its exit code, and what it shows behind the banner."""
    done = subprocess.run(
        [program, "--virtual", "--flash", image, *options],
        input=typed.encode(),
        capture_output=True,
        timeout=TIMEOUT_S,
    )
    return done.returncode, done.stdout.decode("latin-1")


def files_of(image: Path) -> dict[str, str]:
    """The files of an image, as another implementation's littlefs sees them."""
    data = bytearray(image.read_bytes()[FILES_START:])
    if set(data[: 2 * BLOCK]) == {0xFF}:
        return {}
    context = UserContext(buffer=data)
    volume = LittleFS(context, block_size=BLOCK, block_count=len(data) // BLOCK, name_max=63)
    found = {}
    for folder, _, names in volume.walk("/"):
        for name in names:
            path = f"{folder.rstrip('/')}/{name}"
            if not name.startswith("."):
                with volume.open(path, "rb") as file:
                    found[path.lstrip("/")] = file.read().decode("latin-1")
    return found


def kept_in(program: Path, image: Path) -> dict[str, str]:
    """What the board finds in the flash at its next start."""
    typed = "LIST ALL\nPRINT 99\nOPTION LIST\nPRINT 99\nVAR RESTORE:?v\n"
    code, shown = run(program, image, typed)
    if code != 0:
        raise RuntimeError(f"the start ended with {code}: {shown[-200:]}")
    lines = [line for line in shown.split("> ", 1)[1].split("\r\n") if not line.startswith("> ")]
    first = lines.index(" 99")
    second = lines.index(" 99", first + 1)
    state = files_of(image)
    state["program"] = "".join(f"{line}\n" for line in lines[1:first])
    state["options"] = "|".join(lines[first + 1 : second])
    state["variables"] = "|".join(line for line in lines[second + 1 :] if line)
    return state


def difference(state: dict[str, str], allowed: list[dict[str, str]]) -> str | None:
    """Say where the state is none of those allowed; the nearest of them counts."""
    faults = []
    for wanted in allowed:
        items = sorted(set(state) | set(wanted))
        faults.append([item for item in items if state.get(item) != wanted.get(item)])
    worst = min(faults, key=len)
    if not worst:
        return None
    item = worst[0]
    return f"{item} is {state.get(item, 'gone')!r:.120}"


class Cutter:
    """The session on one firmware, with the power cut where it is told."""

    def __init__(self, program: Path, folder: Path) -> None:
        """Prepare the flash as it is before the session."""
        self.program = program
        self.base = folder / "base.bin"
        self.image = folder / "flash.bin"
        code, shown = run(program, self.base, "".join(step.typed for step in BEFORE))
        if code != 0 or "Error" in shown:
            raise RuntimeError(shown)
        state: dict[str, str] = {}
        for step in BEFORE:
            state = keep(state, step.changes)
        self.states = [state]  # before the session, and after each of its steps
        for step in SESSION:
            self.states.append(keep(self.states[-1], step.changes))

    def check_whole(self) -> str | None:
        """Say what is wrong if the power is never cut, or None."""
        shutil.copy(self.base, self.image)
        before = difference(kept_in(self.program, self.image), self.states[:1])
        if before:
            return f"before the session: {before}"
        code, shown = run(self.program, self.image, "".join(step.typed for step in SESSION))
        if code != 0 or "Error" in shown:
            return shown
        return difference(kept_in(self.program, self.image), self.states[-1:])

    def cut(self, number: int, how: str) -> tuple[bool, str | None]:
        """Cut at that write; whether there was one, and what the next start finds wrong."""
        shutil.copy(self.base, self.image)
        typed = "".join(step.typed for step in SESSION)
        code, _ = run(self.program, self.image, typed, "--flash-cut", f"{number},{how}")
        if code != CUT:
            return False, None if code == 0 else f"ended with code {code}"
        allowed = list(self.states)
        for index, step in enumerate(SESSION):
            if step.between:
                allowed.append(keep(self.states[index], step.between))
        try:
            fault = difference(kept_in(self.program, self.image), allowed)
        except (LittleFSError, RuntimeError, ValueError) as error:
            fault = f"{type(error).__name__}: {error}"
        return True, fault

    def go_on(self) -> str | None:
        """Say what is wrong if the session is carried out on what a cut has left."""
        code, shown = run(self.program, self.image, "".join(step.typed for step in SESSION))
        if code != 0:
            return f"ended with code {code}: {shown[-200:]}"
        state = kept_in(self.program, self.image)
        return None if state["program"] == "" else f"after NEW there is {state['program']!r:.80}"

    def find_fault(self, how: str, every: int = 1) -> tuple[int, str | None]:
        """Cut at every write, or each `every`th; how many there were, and the first fault."""
        number = 1
        while True:
            there_was, fault = self.cut(number, how)
            if fault is None and there_was and number % 10 == 1:
                fault = self.go_on()
            if fault is not None:
                return number, f"write {number} cut ({how}): {fault}"
            if not there_was:
                return number - 1, None
            number += every

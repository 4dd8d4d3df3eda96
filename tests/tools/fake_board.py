"""A minimal StepMite prompt on a pty, for the tests of Board and Streamer.

It knows the few statements that these send and keeps a list of the G-code lines it accepted. Faults
are switched on by name. The queue drains by `drain` slots each time somebody asks for ACTIVE, so no
test depends on wall time.
"""

import os
import pty
import re
import select
import threading
import tty

_STATEMENT = re.compile(r'((?:[^":]|"[^"]*")+)')


class FakeBoard:
    def __init__(
        self,
        size=32,
        drain=8,
        armed=True,
        initialized=True,
        position_known=True,
        echo=True,
        refuse=None,  # {code: message}
        notice_after=(),  # codes after which a notice is printed
        notice_while_typing=False,
        die_after=None,  # number of accepted lines after which the cable is pulled
        lie_about_slots=0,  # reports so many free slots too many
        busy=False,  # a program is running
        half_line="",  # already typed at the prompt
        estop_at=None,  # number of accepted lines after which the machine stops for good
    ):
        self.size, self.drain, self.armed = size, drain, armed
        self.initialized, self.position_known = initialized, position_known
        self.echo, self.refuse = echo, refuse or {}
        self.notice_after, self.notice_while_typing = notice_after, notice_while_typing
        self.die_after, self.lie_about_slots, self.busy = die_after, lie_about_slots, busy
        self.estop_at = estop_at
        self.estop = False
        self.typed = half_line
        self.accepted = []
        self.executed = []  # every line carried out, to see that none was lost or doubled
        self.runs = 0
        self.breaks = 0
        self.peeks = 0
        self.used = 0
        self.on_line = lambda code: None
        self._master, self._slave = pty.openpty()
        self._wake, self._waker = os.pipe()
        tty.setraw(self._slave)
        self.device = os.ttyname(self._slave)
        if not busy:
            self._print("> " + half_line)
        self._thread = threading.Thread(target=self._serve, daemon=True)
        self._thread.start()

    def close(self):
        """Pull the cable. The thread closes the pty itself, so that no number is reused early."""
        if self._waker is not None:
            os.close(self._waker)
            self._waker = None
        self._thread.join()

    unplug = close

    def _print(self, text):
        os.write(self._master, text.encode())

    def _serve(self):
        try:
            while True:
                ready, _, _ = select.select([self._master, self._wake], [], [])
                if self._wake in ready:
                    return
                for byte in os.read(self._master, 4096).decode("latin-1"):
                    self._key(byte)
        except OSError:
            return
        finally:
            for handle in (self._master, self._slave, self._wake):
                os.close(handle)

    def _key(self, key):
        if key == "\x03":
            self.breaks += 1
            self.used = 0
            self.busy = False
            self.typed = ""
            self._print("\r\n> ")
        elif self.busy:
            return
        elif key == "\x15":
            self._print("\b \b" * len(self.typed))
            self.typed = ""
        elif key == "\r":
            line, self.typed = self.typed, ""
            if self.echo:
                self._print("\r\n")
            self._line(line)
            self._print("> ")
        else:
            self.typed += key
            if self.echo:
                self._print(key)
            if self.notice_while_typing and len(self.typed) == 5:
                self._print("\r\x1b[KLimit switch X\r\n> " + self.typed)

    def _line(self, line):
        for statement in _STATEMENT.findall(line):
            error = self._statement(statement.strip())
            if error:
                self._print(f"Error : {error}\r\n")
                return

    def _statement(self, text):
        upper = text.upper()
        if match := re.fullmatch(r'STEPPER GS "(.*)"', text):
            return self._gcode(match[1])
        if upper == "STEPPER STATUS":
            self._print("Junction deviation: 0.05 mm, arc tolerance: 0.05 mm\r\n")
            self._print("X motion: 80 steps/mm, max 3000 mm/min, 250 mm/s^2\r\n")
            return None
        if upper == "STEPPER RUN":
            self.runs += 1
            self.armed = True
            return None
        if match := re.fullmatch(r"PRINT PEEK\(STEPPER (\w+)\)", upper):
            return self._peek(match[1])
        if match := re.fullmatch(r"(?:PRINT |\?)(\d+)(?:\*(\d+))?", upper):
            self._print(f" {int(match[1]) * int(match[2] or 1)}\r\n")
            return None
        if not text:
            return None
        self.executed.append(text)
        return "Unknown command"

    def _gcode(self, code):
        self.on_line(code)
        if self.estop:
            return "Emergency stop"
        if code in self.refuse:
            return self.refuse[code]
        if self.used >= self.size:
            return "G-code buffer full"
        self.used += 1
        self.accepted.append(code)
        if code in self.notice_after:
            self._print("Spindle speed reached\r\n")
        if len(self.accepted) == self.die_after:
            raise OSError("unplugged")
        if len(self.accepted) == self.estop_at:
            self.estop, self.position_known, self.used = True, False, 0
        return None

    def _peek(self, name):
        self.peeks += 1
        values = {
            "STATUS": (128 if self.position_known else 0) | (64 if self.estop else 0),
            "BUFFER": min(self.size, self.size - self.used + self.lie_about_slots),
            "X": 1.5,
            "Y": -2,
        }
        if name == "ACTIVE":
            values["ACTIVE"] = -1 if not self.initialized else int(self.armed and self.used > 0)
            if self.armed:
                self.used = max(0, self.used - self.drain)
        if name not in values:
            return f"{name} is not configured"
        value = values[name]
        self._print(f"{'' if value < 0 else ' '}{value}\r\n")
        return None

"""Step edges of an ideal machine: made from the trapezoid plan, not from the firmware.

The oracles are tried on these: a clean recording must pass, one with a planted fault must not.
"""

import numpy as np

from stepmite.follow import crossings, fastest_axis
from stepmite.gcode import read_blocks, target_steps
from stepmite.plan import Machine, Planned, plan
from stepmite.trace import TICK_NS, AxisPins, Edges, axis_trace

PINS = [AxisPins("X", 2, 3, False, 80.0), AxisPins("Y", 4, 5, True, 80.0)]
SCALE = (80.0, 80.0, 400.0, 10.0)


def time_at(row: Planned, distance):
    """Seconds from the start of a block to a distance along it."""
    up, cruise, down = row.phases()
    top = row.peak()
    a = row.acceleration
    s_up = (row.entry + top) / 2 * up
    s_cruise = top * cruise
    rising = (np.sqrt(row.entry**2 + 2 * a * distance) - row.entry) / a
    level = up + (distance - s_up) / top
    left = np.maximum(0.0, distance - s_up - s_cruise)
    falling = up + cruise + (top - np.sqrt(np.maximum(0.0, top**2 - 2 * a * left))) / a
    return (
        np.where(distance < s_up, rising, np.where(distance < s_up + s_cruise, level, falling))
        + 0.0 * down
    )


def edges_of(program, machine=None, pins=PINS, time_scale=1.0):
    """Edges and corner steps for a G-code program; `time_scale` < 1 runs it too fast."""
    rows = [row for row in plan(read_blocks(program), machine or Machine())]
    table = []
    corners = [target_steps((0.0,) * 4, SCALE)]
    clock_s = 0.001
    level = {pin.dir_gpio: 0 for pin in pins}
    for row in rows:
        begin, end = corners[-1], target_steps(row.block.target, SCALE)
        for axis, pin in enumerate(pins):
            count = end[axis] - begin[axis]
            if count == 0:
                continue
            wanted = int((count > 0) != pin.inverted)
            if level[pin.dir_gpio] != wanted:
                level[pin.dir_gpio] = wanted
                table.append((tick(clock_s), 0, pin.dir_gpio, wanted))
            part = (np.arange(abs(count)) + 0.5) / abs(count)
            for moment in clock_s + time_at(row, part * row.length) * time_scale:
                table.append((tick(moment) + TICK_NS, 2, pin.step_gpio, 1))
                table.append((tick(moment) + 2 * TICK_NS, 1, pin.step_gpio, 0))
        clock_s += row.duration_s() * time_scale
        corners.append(end)
    table.sort(key=lambda entry: entry[:2])
    edges = Edges.from_rows([(time, gpio, level) for time, _, gpio, level in table])
    return edges, np.array([corner[: len(pins)] for corner in corners])


def tick(moment_s):
    return int(np.ceil(moment_s * 1e9 / TICK_NS)) * TICK_NS


def traces_of(edges, pins=PINS):
    return [axis_trace(edges, pin) for pin in pins]


def without_step(edges, gpio, number):
    """The same recording with one step pulse missing."""
    rises = np.flatnonzero((edges.gpio == gpio) & (edges.level == 1))
    falls = np.flatnonzero((edges.gpio == gpio) & (edges.level == 0))
    keep = np.ones(len(edges), bool)
    keep[[rises[number], falls[number]]] = False
    return Edges(edges.time_ns[keep], edges.gpio[keep], edges.level[keep])


def jerk_law(phases):
    """Times, ways and last speed of a motion by (jerk, seconds) phases from rest.

    ("jump", a) adds to the acceleration at once.
    """
    speed = acceleration = way = 0.0
    times, ways = [np.zeros(1)], [np.zeros(1)]
    for jerk, amount in phases:
        if jerk == "jump":
            acceleration += amount
            continue
        t = np.linspace(0, amount, max(2, round(amount * 1e5)))[1:]
        times.append(times[-1][-1] + t)
        ways.append(way + speed * t + acceleration / 2 * t**2 + jerk / 6 * t**3)
        way = ways[-1][-1]
        speed += acceleration * amount + jerk / 2 * amount**2
        acceleration += jerk * amount
    return np.concatenate(times), np.concatenate(ways), speed


def edges_along(path, pins, law):
    """Edges of a machine that follows a path exactly, steps rounded up to ticks.

    `law` are times in s and ways along the path.
    """
    scale = np.array([pin.steps_per_unit for pin in pins])
    fastest = fastest_axis(path, scale)
    table = []
    for axis, pin in enumerate(pins):
        wanted = crossings(path, axis, scale[axis], fastest)
        moments = 0.001 + np.interp(wanted.way, law[1], law[0])
        level = 0
        for moment, direction in zip(moments, wanted.direction, strict=True):
            want = int((direction > 0) != pin.inverted)
            if want != level:
                table.append((tick(moment), 0, pin.dir_gpio, want))
                level = want
            table.append((tick(moment) + TICK_NS, 2, pin.step_gpio, 1))
            table.append((tick(moment) + 2 * TICK_NS, 1, pin.step_gpio, 0))
    table.sort(key=lambda entry: entry[:2])
    return Edges.from_rows([(time, gpio, level) for time, _, gpio, level in table])

"""Parts as CAM programs write them, made from their geometry: G-code of short moves."""

import math

import numpy as np

CHORD_TOLERANCE = 0.005
CHORD_MOST = 2.0


def chords(curve, tolerance=CHORD_TOLERANCE):
    """Points of a curve, given as a fine table (n, 2 or 3), whose chords stay within tolerance."""
    change = np.gradient(curve, axis=0)
    speed = np.linalg.norm(change, axis=1)
    direction = change / speed[:, None]
    way = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(curve, axis=0), axis=1))])
    bend = np.linalg.norm(np.gradient(direction, axis=0), axis=1) / speed
    length = np.minimum(np.sqrt(8 * tolerance / np.maximum(bend, 1e-6)), CHORD_MOST)
    density = np.concatenate([[0.0], np.cumsum(np.diff(way) * 2 / (length[1:] + length[:-1]))])
    count = math.ceil(density[-1])
    places = np.interp(np.linspace(0, density[-1], count + 1), density, way)
    return np.stack([np.interp(places, way, column) for column in curve.T], axis=1)


def moves(points, feed):
    """G1 through points; the first line carries the feed."""
    words = [
        " ".join(f"{letter}{value:.4f}" for letter, value in zip("XYZ", point, strict=False))
        for point in points
    ]
    return [f"G1 F{feed} {words[0]}", *words[1:]]


def short_line(count=2000, length=0.02, feed=6000):
    return [f"G1 F{feed}"] + [f"X{n * length:.4f}" for n in range(1, count + 1)]


def short_circle(count=10_000, length=0.02, feed=6000):
    radius = count * length / (2 * math.pi)
    angles = np.linspace(0, 2 * math.pi, count + 1)[1:]
    points = np.stack([radius * (np.cos(angles) - 1), radius * np.sin(angles)], axis=1)
    return moves(points, feed)


def contours(rows=6, width=50.0, step=0.8, feed=4800):
    """Parallel lines over a hilly surface, there and back."""
    lines = ["G0 Z4"]
    for row in range(rows):
        x = np.linspace(0, width, 20_000)[:: 1 if row % 2 == 0 else -1]
        y = np.full_like(x, row * step)
        z = 2 * np.sin(x / 4) * np.cos(y / 3) + np.exp(-((x - 25) ** 2) / 8)
        lines += moves(chords(np.stack([x, y, z], axis=1)), feed)
    return [*lines, "G0 Z6"]


def trochoidal_slot(length=20.0, step=0.6, radius=2.5, feed=6000):
    turns = int(length / step)
    t = np.linspace(0, 2 * math.pi * turns, 2000 * turns)
    x = step * t / (2 * math.pi) + radius * (np.cos(t) - 1)
    y = radius * np.sin(t)
    return moves(chords(np.stack([x, y], axis=1))[1:], feed)


def pocket_spiral(size=24.0, step=1.2, feed=6000):
    """A square spiral from inside to outside with round corners of half the size of the square."""
    t = np.linspace(0, 2 * math.pi * size / 2 / step, 120_000)
    reach = 0.4 + step * t / (2 * math.pi)
    around = (np.cos(t) ** 4 + np.sin(t) ** 4) ** -0.25
    curve = np.stack([reach * around * np.cos(t), reach * around * np.sin(t)], axis=1)
    return moves(chords(curve), feed)


def islands(feed=4200):
    """Closed outlines of two levels, with a rapid over the part in between."""
    lines = []
    t = np.linspace(0, 2 * math.pi, 20_000)
    for number, (x, y) in enumerate([(12, 10), (34, 12), (22, 30), (44, 32)]):
        radius = 5 + 1.5 * np.cos((number + 2) * t) + 0.4 * np.sin(9 * t)
        curve = np.stack([x + radius * np.cos(t), y + radius * np.sin(t)], axis=1)
        lines += ["G0 Z3", f"G0 X{curve[0, 0]:.4f} Y{curve[0, 1]:.4f}"]
        for depth in (-1, -2):
            lines += [f"G1 F600 Z{depth}", *moves(chords(curve)[1:], feed)]
    return [*lines, "G0 Z3"]


def meander(rows=14, width=30.0, step=1.5, feed=6000):
    """Straight lines joined by half circles of chords."""
    lines = []
    for row in range(rows):
        y, side = row * step, 1 if row % 2 == 0 else -1
        end = width if side == 1 else 0.0
        t = np.linspace(-math.pi / 2, math.pi / 2, 4000)
        turn = np.stack([end + side * step / 2 * np.cos(t), y + step / 2 * (1 + np.sin(t))], axis=1)
        lines += moves([(end, y), *chords(turn)[1:]], feed)
    return lines


CONTOUR_LIKE = {
    "contours over a surface": contours,
    "trochoidal slot": trochoidal_slot,
    "pocket spiral": pocket_spiral,
    "islands": islands,
    "meander": meander,
}
SHORT = {"0.02 mm line": short_line, "0.02 mm circle": short_circle}

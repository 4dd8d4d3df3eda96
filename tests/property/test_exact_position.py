"""No move, however short, loses a step."""

import random

from host_machine import Setup, run


def test_a_thousand_moves_of_a_hundredth_make_800_steps(tmp_path):
    lines = ["G90 G1 F600"] + [f"X{n / 100:.2f}" for n in range(1, 1001)]
    result = run(tmp_path, lines)
    assert result.end_steps() == [800, 0, 0, 0]
    assert len(result.traces[0].step_ns) == 800
    assert result.reported_steps() == [800, 0, 0, 0]


def test_a_thousand_relative_moves_of_a_hundredth_make_800_steps(tmp_path):
    lines = ["G91 G1 F600"] + ["X0.01"] * 1000
    assert run(tmp_path, lines).end_steps() == [800, 0, 0, 0]


def random_walk(count, seed):
    """Moves of up to 0.1 mm in both distance modes; returns the lines and the exact end in um."""
    rng = random.Random(seed)
    place = [0, 0, 0, 0]  # um and thousandths of a degree: exact
    lines = ["G90 G1 F3000"]
    absolute = True
    for _ in range(count):
        if rng.random() < 0.3:
            absolute = not absolute
            lines.append("G90" if absolute else "G91")
        words = []
        for axis in rng.sample(range(4), rng.randint(1, 3)):
            change = rng.randint(-100, 100) * (1 if axis < 3 else 5)
            place[axis] += change
            value = place[axis] if absolute else change
            words.append(f"{'XYZA'[axis]}{value / 1000:.3f}")
        motion = rng.choice(["G1 ", "G0 ", "", ""])
        lines.append(motion + " ".join(words))
    return lines, place


def exact_steps(place_um, steps_per_unit):
    """Rounds in integers: the scale is a whole number in these tests."""
    steps = []
    for um, scale in zip(place_um, steps_per_unit, strict=True):
        size = (abs(um) * int(scale) * 2 + 1000) // 2000
        steps.append(size if um >= 0 else -size)
    return steps


def test_100000_random_moves_end_with_zero_error(tmp_path):
    setup = Setup(steps_per_unit=(80.0, 80.0, 100.0, 10.0))
    lines, place = random_walk(100_000, seed=4)
    result = run(tmp_path, lines, setup)
    wanted = exact_steps(place, setup.steps_per_unit)
    assert result.end_steps() == wanted
    assert result.reported_steps() == wanted
    assert result.corners[-1].tolist() == wanted

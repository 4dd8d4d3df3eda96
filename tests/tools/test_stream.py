"""Streaming: every line arrives once and in order, and stops where the firmware refuses."""

import itertools

import pytest
from fake_board import FakeBoard
from hypothesis import given, settings
from hypothesis import strategies as st

from stepmite.board import Board, BoardGone, Cancelled
from stepmite.stream import JobError, Progress, Streamer, prepare

PROGRAM = ["%", "(a name plate)", "G90 G1 F1200", ""] + [
    f"X{i % 7}.5 Y{i} (move {i})" for i in range(200)
]
CODES = ["G90G1F1200"] + [f"X{i % 7}.5Y{i}" for i in range(200)]


def stream(machine, program=PROGRAM, **options):
    seen = []
    notices = []
    job = prepare("part.nc", program)
    with Board.open(machine.device, on_notice=notices.append) as board:
        notices.clear()
        Streamer(board, job, on_progress=seen.append, **options).run()
    return job, seen, notices


def test_every_line_arrives_once_and_in_order(fake):
    machine = fake()
    job, seen, _ = stream(machine)
    assert machine.accepted == CODES
    assert seen[-1] == Progress(len(job.lines), job.duration_s)
    assert all(a.seconds_done <= b.seconds_done for a, b in itertools.pairwise(seen))


def test_slots_are_asked_for_seldom(fake):
    machine = fake(size=256, drain=64)
    stream(machine)
    assert machine.accepted == CODES
    assert machine.peeks < 30


def test_full_buffer_loses_and_doubles_nothing(fake):
    machine = fake(size=16, drain=3, lie_about_slots=5)
    stream(machine)
    assert machine.accepted == CODES


@pytest.mark.parametrize("place", [0, 1, 37, 100, 200])
def test_refused_line_stops_the_job_exactly_there(fake, place):
    machine = fake(refuse={CODES[place]: "X: beyond the soft limit"})
    with pytest.raises(JobError) as caught:
        stream(machine)
    number = 3 if place == 0 else place + 4
    assert str(caught.value).startswith(f"part.nc:{number}: {PROGRAM[number - 1]}\n")
    assert str(caught.value).endswith("X: beyond the soft limit")
    assert machine.accepted == CODES[:place]
    assert machine.breaks == 1


def test_notices_are_passed_on_and_disturb_nothing(fake):
    machine = fake(notice_after=(CODES[5], CODES[90]), notice_while_typing=True)
    _, _, notices = stream(machine)
    assert machine.accepted == CODES
    assert notices.count("Spindle speed reached") == 2
    assert "Limit switch X" in notices


def test_machine_that_is_not_armed_is_started_once(fake):
    machine = fake(armed=False)
    stream(machine)
    assert machine.accepted == CODES
    assert machine.runs == 1
    assert machine.used == 0  # the end of motion was waited for


def test_short_job_starts_too(fake):
    machine = fake(armed=False)
    stream(machine, ["G1 X1 F100"])
    assert machine.accepted == ["G1X1F100"]
    assert machine.runs == 1
    assert machine.used == 0


def test_without_arming_a_job_is_only_queued(fake):
    machine = fake(armed=False, size=256)
    stream(machine, arm=False)
    assert machine.accepted == CODES
    assert machine.runs == 0


def test_without_arming_a_full_queue_is_reported(fake, monkeypatch):
    monkeypatch.setattr("stepmite.stream.STUCK_S", 0.2)
    with pytest.raises(JobError, match="nothing moves"):
        stream(fake(armed=False), arm=False)


def test_reserve_is_kept(fake):
    machine = fake(size=32, drain=10)
    most = []
    machine.on_line = lambda code: most.append(machine.used)
    stream(machine, reserve=12)
    assert machine.accepted == CODES
    assert max(most) < 20


def test_reserve_that_leaves_no_room(fake):
    with pytest.raises(JobError, match="too few for a line"):
        stream(fake(), reserve=32)


def test_unplugged_in_the_middle(fake):
    with pytest.raises(BoardGone, match="connection is broken"):
        stream(fake(die_after=40))


def test_emergency_stop_in_the_middle(fake):
    with pytest.raises(JobError, match="Emergency stop"):
        stream(fake(estop_at=50))


def test_emergency_stop_after_the_last_line(fake):
    with pytest.raises(JobError, match="did not end"):
        stream(fake(estop_at=len(CODES)))


@pytest.mark.parametrize(
    ("faults", "message"),
    [({"initialized": False}, "STEPPER INIT"), ({"position_known": False}, "POSITION HOME")],
)
def test_machine_that_is_not_ready(fake, faults, message):
    machine = fake(**faults)
    with pytest.raises(JobError, match=message):
        stream(machine)
    assert machine.accepted == []


def test_cancel_brings_a_controlled_stop(fake):
    machine = fake()
    job = prepare("part.nc", PROGRAM)
    with Board.open(machine.device) as board:
        streamer = Streamer(board, job)
        machine.on_line = lambda code: streamer.cancel() if code == CODES[60] else None
        with pytest.raises(Cancelled):
            streamer.run()
    assert machine.breaks == 1
    assert machine.accepted == CODES[: len(machine.accepted)]
    assert 60 <= len(machine.accepted) < 80


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ('G1 X"5"', "part.nc:2: a double quote"),
        ("G1 X5\x00", "part.nc:2: only plain ASCII"),
        ("G1 Xö", "part.nc:2: only plain ASCII"),
        ("G1 X" + "1" * 300, "part.nc:2: the line is longer"),
    ],
)
def test_what_no_prompt_can_take_is_refused_before_anything_moves(line, message):
    with pytest.raises(JobError, match=message):
        prepare("part.nc", ["G90", line])


def test_quotes_and_umlauts_in_comments_are_welcome():
    job = prepare("part.nc", ['G1 X5 F100 (Fräser "3 mm")', "; größe"])
    assert [line.code for line in job.lines] == ["G1X5F100"]


def test_unknown_words_are_left_to_the_firmware():
    job = prepare("part.nc", ["G1 X5 F100", "G95 P0.1", "X9"])
    assert [line.code for line in job.lines] == ["G1X5F100", "G95P0.1", "X9"]
    assert job.unreadable.line_number == 2


@settings(deadline=None, max_examples=25)
@given(
    size=st.integers(1, 300),
    drain=st.integers(1, 300),
    lie=st.integers(0, 40),
    armed=st.booleans(),
    echo=st.booleans(),
    refused=st.none() | st.integers(0, len(CODES) - 1),
    notices=st.sets(st.integers(0, len(CODES) - 1), max_size=5),
    typing=st.booleans(),
)
def test_whatever_the_board_does_no_line_is_lost_or_doubled(
    size, drain, lie, armed, echo, refused, notices, typing
):
    machine = FakeBoard(
        size=size,
        drain=drain,
        lie_about_slots=lie,
        armed=armed,
        echo=echo,
        refuse={} if refused is None else {CODES[refused]: "No"},
        notice_after=[CODES[index] for index in notices],
        notice_while_typing=typing and echo,
    )
    try:
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr("stepmite.board.QUIET_S", 0.02)
            patch.setattr("stepmite.stream._POLL_S", (0.001, 0.001))
            if refused is None:
                stream(machine)
            else:
                with pytest.raises(JobError, match=f"part.nc:{(refused + 4) if refused else 3}:"):
                    stream(machine)
    finally:
        machine.close()
    assert machine.accepted == CODES[:refused]

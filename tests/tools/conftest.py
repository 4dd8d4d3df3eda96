import pytest
from fake_board import FakeBoard


@pytest.fixture
def fake():
    boards = []

    def make(**faults):
        boards.append(FakeBoard(**faults))
        return boards[-1]

    yield make
    for board in boards:
        board.close()

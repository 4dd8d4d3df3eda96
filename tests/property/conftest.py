import pytest
from host_machine import HOST_PROGRAM


@pytest.fixture(scope="session", autouse=True)
def host_program():
    assert HOST_PROGRAM.exists(), f"{HOST_PROGRAM} is missing: run `make host` first"

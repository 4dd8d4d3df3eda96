"""Flash: the boot ROM's own erase and program functions, busy times, images kept in files."""

import re
from pathlib import Path

import pytest

from stepmite.emulator import Emulator, EmulatorError

STORAGE_SIZE = 1280 * 1024


def test_erase_and_program(check: Emulator) -> None:
    result = check.command("s")
    erased = re.search(r"erased ff in (\d+) us", result)
    programmed = re.search(r"programmed a5 in (\d+) us", result)
    assert erased
    assert 45_000 < int(erased[1]) < 46_000  # 45 ms typical for a sector
    assert programmed
    assert 400 < int(programmed[1]) < 900  # 0.4 ms a page, and the SDK's work
    assert "holds 05 05 next ff id e0e7" in result  # A5 AND 0F: programming only clears bits


def test_code_from_flash_while_it_is_busy_is_a_fault(check: Emulator) -> None:
    check.send("s2\r")
    check.run_ms(60)
    assert any("while it is busy" in fault.text for fault in check.faults())
    check.clear_faults()


def test_image_is_kept(check_uf2: Path, tmp_path: Path) -> None:
    image = tmp_path / "flash.bin"
    with Emulator(check_uf2, storage=image) as board:
        board.connect()
        board.until("> ")
        board.command("s")
        board.save_storage()
    data = image.read_bytes()
    assert len(data) == STORAGE_SIZE
    assert data[:256] == b"\x05" * 256
    assert set(data[256:]) == {0xFF}
    with Emulator(check_uf2, storage=image) as board:
        board.connect()
        board.until("> ")
        assert "holds 05 05" in board.command("s1")


def test_contents_survive_a_restart(check: Emulator) -> None:
    check.command("s")
    check.send("r1\r")
    check.expect("emulator-check", 2000)
    check.until("> ")
    assert "holds 05 05" in check.command("s1")


def test_image_of_the_wrong_size_is_refused(check_uf2: Path, tmp_path: Path) -> None:
    image = tmp_path / "flash.bin"
    image.write_bytes(b"\xff" * 100)
    with pytest.raises(EmulatorError, match=r"has 100 bytes; a flash image has 1310720"):
        Emulator(check_uf2, storage=image)


def test_what_is_no_uf2_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "x.uf2"
    file.write_bytes(b"x" * 512)
    with pytest.raises(EmulatorError, match="is not a UF2 file"):
        Emulator(file)

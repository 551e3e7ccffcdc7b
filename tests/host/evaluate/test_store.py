from __future__ import annotations

from pathlib import Path

import polars as pl
import pytest

from chromadock.errors import ChromadockError
from chromadock.evaluate.store import Store, write_whole

TABLE = pl.DataFrame({"frame": range(500), "passed": [i / 500 for i in range(500)]})


def test_a_part_comes_back_as_it_was(tmp_path: Path) -> None:
    store = Store(tmp_path / "parts")
    assert store.read("a") is None
    store.write("a", TABLE)
    assert TABLE.equals(store.read("a"))
    assert store.read("b") is None


def test_a_part_is_damaged_by_any_lost_end_and_any_changed_byte(tmp_path: Path) -> None:
    store = Store(tmp_path)
    store.write("a", TABLE)
    path = next(tmp_path.iterdir())
    whole = path.read_bytes()
    for damaged in (b"", whole[:-1], whole[: len(whole) // 2], flipped(whole, len(whole) // 2)):
        path.write_bytes(damaged)
        assert store.read("a") is None
    store.write("a", TABLE)
    assert TABLE.equals(store.read("a"))


def flipped(content: bytes, place: int) -> bytes:
    return content[:place] + bytes([content[place] ^ 1]) + content[place + 1 :]


def test_only_whole_parts_of_known_keys_are_kept(tmp_path: Path) -> None:
    store = Store(tmp_path)
    for key in ("a", "b"):
        store.write(key, TABLE)
    (tmp_path / "a-0123456789abcdef.parquet").write_bytes(b"damaged")
    store.keep_only(["a"])
    assert len(list(tmp_path.iterdir())) == 1
    assert TABLE.equals(store.read("a"))


def test_nothing_is_left_where_writing_fails(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(self: Path, content: bytes) -> int:
        with self.open("wb") as file:
            file.write(content[:3])
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path, "write_bytes", full)
    with pytest.raises(ChromadockError, match="No space left on device"):
        write_whole(tmp_path / "x.parquet", b"whole content")
    assert list(tmp_path.iterdir()) == []

"""Files of the cache: read when intact, made again when damaged, removed when old."""

from __future__ import annotations

import os

import numpy as np
import pytest

from thalweg.core.arrays.array_cache import load_or_make, remove_oldest


def unpack(arrays):
    if arrays["a"].shape != (4,):
        raise ValueError("not four values")
    return arrays["a"].tolist()


def load(path, made=None, **options):
    def make():
        if made is None:
            pytest.fail("made again")
        made.append(1)
        return [1.0, 2.0, 3.0, 4.0]

    options = {"pack": lambda values: {"a": np.array(values)}, "unpack": unpack, **options}
    return load_or_make(path, make, **options)


def test_a_file_is_made_once(tmp_path):
    made = []
    first = load(tmp_path / "kept.npz", made)
    assert load(tmp_path / "kept.npz") == first == [1.0, 2.0, 3.0, 4.0]
    assert len(made) == 1


def test_any_damage_to_a_file_makes_it_again(tmp_path):
    path, made = tmp_path / "kept.npz", []
    first = load(path, made)
    content = path.read_bytes()
    random = np.random.default_rng(4)
    damaged = [b"", b"PK\x03\x04", content[: len(content) // 2], b"\x93NUMPY"]
    for place in range(len(content)):  # one byte is wrong
        damaged.append(
            content[:place] + random.integers(0, 256, 1, np.uint8).tobytes() + content[place + 1 :]
        )
    for some in damaged:
        path.write_bytes(some)
        assert load(path, made) == first


@pytest.mark.parametrize("arrays", [{"b": np.zeros(4)}, {"a": np.zeros(3)}, {}])
def test_arrays_that_do_not_fit_are_made_again(tmp_path, arrays):
    path, made = tmp_path / "kept.npz", []
    np.savez(path, **arrays)
    assert load(path, made)[0] == 1.0
    assert load(path)[0] == 1.0 and len(made) == 1


def test_objects_are_never_read(tmp_path):
    path, made = tmp_path / "kept.npz", []
    np.savez(path, a=np.array([1.0, None, 3.0, 4.0], object))
    assert load(path, made)[1] == 2.0 and len(made) == 1


def test_a_folder_that_is_missing_is_no_harm(tmp_path):
    path = tmp_path / "missing" / "kept.npz"
    assert load(path, [])[0] == 1.0
    assert not path.exists()


def test_an_error_of_the_making_is_passed_on(tmp_path):
    def make():
        raise KeyError("no such sea")

    with pytest.raises(KeyError, match="no such sea") as raised:
        load_or_make(tmp_path / "kept.npz", make, pack=dict, unpack=unpack)
    assert raised.value.__context__ is None


def test_old_files_are_removed_after_one_is_written(tmp_path):
    for age in range(5):
        path = tmp_path / f"{age}.npz"
        path.touch()
        os.utime(path, (1e9 - age, 1e9 - age))
    load(tmp_path / "new.npz", [], clean=lambda folder: remove_oldest(folder.glob("*.npz"), 3))
    assert sorted(path.name for path in tmp_path.iterdir()) == ["0.npz", "1.npz", "new.npz"]

"""Files are written completely or not at all."""

from __future__ import annotations

import io
import os
import stat
import subprocess
import sys
from pathlib import Path

import pytest

from thalweg.core.errors import InputError
from thalweg.core.file_writing import (
    make_folder,
    replacing_file,
    save_figure,
    write_csv_rows,
    write_text,
)

OLD = "the earlier content\n"


@pytest.fixture
def target(tmp_path):
    path = tmp_path / "plan.json"
    path.write_text(OLD)
    return path


def test_a_file_is_replaced_and_nothing_else_remains(target):
    write_text(target, "new é\n")
    assert target.read_text("utf-8") == "new é\n"
    assert [path.name for path in target.parent.iterdir()] == ["plan.json"]


def test_what_a_killed_process_left_is_removed_and_open_files_are_not(target):
    """Kill -9 while writing once left a temporary file for ever."""
    code = (
        "import os, signal, sys\n"
        "from thalweg.core.file_writing import replacing_file\n"
        "with replacing_file(sys.argv[1]) as file:\n"
        "    file.write(b'half')\n"
        "    file.flush()\n"
        "    os.kill(os.getpid(), signal.SIGKILL)\n"
    )
    subprocess.run([sys.executable, "-c", code, str(target)], check=False)
    (left,) = target.parent.glob(".*.part")
    write_text(target, "new\n")
    assert left.exists()  # less than a minute old
    os.utime(left, (0.0, 0.0))
    with replacing_file(target) as file:
        (other,) = set(target.parent.glob(".*.part")) - {left}
        os.utime(other, (0.0, 0.0))
        write_text(target.with_name("beside.json"), "{}")
        assert not left.exists()
        assert other.exists()
        file.write(b"long\n")
    assert target.read_text() == "long\n"
    assert not list(target.parent.glob(".*.part"))


def test_an_error_in_the_middle_leaves_the_earlier_file(target):
    with pytest.raises(RuntimeError), replacing_file(target) as file:
        file.write(b"half")
        raise RuntimeError
    assert target.read_text() == OLD
    assert len(list(target.parent.iterdir())) == 1


def test_a_limit_on_the_size_of_files_is_an_error_with_three_parts(target):
    code = (
        "import resource, signal, sys; signal.signal(signal.SIGXFSZ, signal.SIG_IGN)\n"
        "resource.setrlimit(resource.RLIMIT_FSIZE, (4096, 4096))\n"
        "from thalweg.core.errors import InputError\n"
        "from thalweg.core.file_writing import write_text\n"
        "try:\n    write_text(sys.argv[1], 'x' * 100_000)\n"
        "except InputError as error:\n    print(error.asked, error.possible, error.remedy, sep='|')"
    )
    done = subprocess.run(
        [sys.executable, "-c", code, target], capture_output=True, text=True, check=True
    )
    asked, possible, remedy = done.stdout.strip().split("|")
    assert "cannot be written: File too large" in asked and "unchanged" in possible
    assert "another path" in remedy
    assert target.read_text() == OLD
    assert len(list(target.parent.iterdir())) == 1


def test_a_killed_process_leaves_the_earlier_file(target):
    code = (
        "import os, signal, sys\nfrom thalweg.core.file_writing import replacing_file\n"
        "with replacing_file(sys.argv[1]) as file:\n"
        "    file.write(b'half'); file.flush(); os.kill(os.getpid(), signal.SIGKILL)\n"
    )
    assert subprocess.run([sys.executable, "-c", code, target], check=False).returncode < 0
    assert target.read_text() == OLD


def test_permissions_and_links_are_kept(target, tmp_path):
    target.chmod(0o640)
    link = tmp_path / "link.json"
    link.symlink_to(target)
    write_text(link, "new")
    assert link.is_symlink() and target.read_text() == "new"
    assert stat.S_IMODE(target.stat().st_mode) == 0o640


def test_new_files_have_the_usual_permissions(tmp_path):
    (tmp_path / "usual").write_text("")
    write_text(tmp_path / "new", "")
    assert (tmp_path / "new").stat().st_mode == (tmp_path / "usual").stat().st_mode


@pytest.mark.parametrize("name", [".", "none/plan.json", "x" * 400, "file/plan.json", "nul\0"])
def test_paths_that_cannot_be_written_are_named(tmp_path, name):
    (tmp_path / "file").write_text("")
    with pytest.raises(InputError, match="cannot be written") as caught:
        write_text(tmp_path / name, "x")
    assert caught.value.possible and caught.value.remedy


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write everything")
def test_protected_files_are_not_replaced(target):
    target.chmod(0o444)
    with pytest.raises(InputError, match="Permission denied"):
        write_text(target, "new")
    assert target.read_text() == OLD


def test_devices_are_written_directly():
    before = Path(os.devnull).stat()
    write_text(os.devnull, "text")
    assert stat.S_ISCHR(before.st_mode) and Path(os.devnull).stat().st_ino == before.st_ino


def test_rows_become_csv_with_empty_cells(tmp_path):
    write_csv_rows(tmp_path / "a.csv", [["a", "b"], [1, None]])
    assert (tmp_path / "a.csv").read_text().split() == ["a,b", "1,"]


def test_figures_take_their_format_from_the_name(tmp_path):
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure()
    FigureCanvasAgg(figure)
    save_figure(figure, tmp_path / "a.pdf")
    save_figure(figure, tmp_path / "b")
    stream = io.BytesIO()
    save_figure(figure, stream, format="png")
    assert (tmp_path / "a.pdf").read_bytes()[:4] == b"%PDF"
    assert (tmp_path / "b.png").read_bytes()[:4] == stream.getvalue()[:4] == b"\x89PNG"
    with pytest.raises(InputError, match="'xyz'"):
        save_figure(figure, tmp_path / "c.xyz")


def test_a_folder_with_the_name_of_a_file_is_refused(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(InputError, match="a file has this name"):
        make_folder(tmp_path / "file")
    assert make_folder(tmp_path / "a" / "b").is_dir()


def test_a_plan_file_survives_a_full_disk(target, monkeypatch):
    """A voyage stands for all objects with a file of their own."""
    from thalweg.planning import Voyage

    voyage = Voyage(start=(50.0, 1.0), goal=(51.0, 2.0), depart="2026-01-01T00:00Z")
    monkeypatch.setattr(os, "fsync", _full_disk)
    with pytest.raises(InputError, match="No space left on device"):
        voyage.save(target)
    assert target.read_text() == OLD


def _full_disk(_):
    raise OSError(28, "No space left on device")


def test_no_module_writes_its_results_in_place():
    import thalweg

    root = Path(thalweg.__file__).parent
    allowed = {"core/file_writing.py", "sea/files/grib_worker.py"}
    allowed |= {"service/jobs/job_runner.py"}  # the log of a running process
    words = (".write_text(", ".write_bytes(", ".savefig(", ".to_csv(folder", 'open("w')
    found = {
        path.relative_to(root).as_posix()
        for path in root.rglob("*.py")
        if any(word in path.read_text("utf-8") for word in words)
    }
    assert found - allowed == set()

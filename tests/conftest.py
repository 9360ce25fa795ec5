"""What every test may use."""

from __future__ import annotations

import gc
import os
import signal
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from hypothesis import settings

# Threads of linear algebra that wait for a core of other workers burn the time of these. It is read
# when NumPy is imported, here and in the processes that tests start.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from tests.compile_kernels import compile_once

# A gate must not depend on luck: where CI is set, the examples are the same every time.
settings.register_profile(
    "thalweg",
    deadline=None,
    print_blob=True,
    derandomize=bool(os.environ.get("CI")),
    max_examples=int(os.environ.get("THALWEG_EXAMPLES", "40")),
)
settings.load_profile("thalweg")

# As on the command line: tests make many objects that last, which each collection goes through.
gc.set_threshold(10_000)

# A shell that starts the tests in the background lets them ignore Ctrl-C; tests of it need it.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.hookimpl(tryfirst=True)
def pytest_sessionstart(session: pytest.Session) -> None:
    """Compile the kernels before worker processes start, so that not each of them does."""
    config = session.config
    if not hasattr(config, "workerinput") and config.getoption("numprocesses", None):
        terminal = config.get_terminal_writer()
        compile_once(lambda text: terminal.write(f"{text}\n", flush=True))


@pytest.hookimpl(wrapper=True)
def pytest_collection() -> Iterator[None]:
    """Collect no garbage while tests are collected, nor afterwards among what remains of it."""
    gc.disable()
    try:
        return (yield)
    finally:
        gc.freeze()
        gc.enable()


@pytest.hookimpl(trylast=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Put modules with most slow tests first: no worker is left with one at the end."""
    slow = Counter(item.path for item in items if item.get_closest_marker("slow"))
    items.sort(key=lambda item: -slow[item.path])


@pytest.fixture(scope="session", autouse=True)
def brief_proofs() -> Iterator[None]:
    """Limit the time for proofs that a test does not set, and the rasters that plans make."""
    from thalweg.planning.pareto.front_bound import least_ways
    from thalweg.planning.single import certified_bound
    from thalweg.search.certificate import time_certificate

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(certified_bound, "LONGEST_PROOF", 0.2)
        patch.setattr(least_ways, "_SECONDS", 0.2)
        patch.setattr(certified_bound, "_CELLS_OF_PATH", 250)
        patch.setattr(time_certificate, "_CELLS_OF_GEODESIC", 120)
        yield


@pytest.fixture(scope="session", autouse=True)
def no_kept_distances() -> Iterator[None]:
    """Let distances be found each time: a test may change what they depend on."""
    from thalweg.planning.network_selection.distance_cache import DistanceQuestion

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(DistanceQuestion, "answer", lambda self: None)
        yield


@pytest.fixture(scope="session", autouse=True)
def brief_fronts() -> Iterator[Any]:
    """Refine and evaluate fewer routes of a front; the value is how many a user's front has."""
    from thalweg.planning.pareto import trade_off_context
    from thalweg.planning.pareto.trade_off_context import FrontDetail

    with pytest.MonkeyPatch.context() as patch:
        whole = trade_off_context.WHOLE_FRONT
        brief = FrontDetail(16, 6, 40, 16, 12, 6, 12, 24)
        patch.setattr(trade_off_context, "WHOLE_FRONT", brief)
        yield whole


@pytest.fixture(scope="module")
def whole_fronts(brief_fronts: Any) -> Iterator[None]:
    """Refine and evaluate as many routes of a front as for users, in a module of tests."""
    from thalweg.planning.pareto import trade_off_context

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(trade_off_context, "WHOLE_FRONT", brief_fronts)
        yield


@pytest.fixture
def coarse_networks(monkeypatch: pytest.MonkeyPatch) -> None:
    """Space the nodes of default networks two and a half times as far apart."""
    from thalweg.network.regional_lattice import lattice_builder

    usual = lattice_builder.default_spacing
    monkeypatch.setattr(lattice_builder, "default_spacing", lambda length: usual(2.5 * length))


ROOT = Path(__file__).resolve().parent.parent


def data_folder() -> Path | None:
    """Return the folder of real test data, if there is one."""
    override = os.environ.get("THALWEG_TEST_DATA")
    folder = Path(override) if override else ROOT.parent / "shared" / "data"
    return folder if folder.is_dir() else None


def data_file(name: str) -> Path:
    """Return a file of real data, or skip the test with the reason."""
    folder = data_folder()
    if folder is None or not (folder / name).exists():
        pytest.skip(f"real data file {name} is not here (set THALWEG_TEST_DATA)")
    return folder / name

"""Figures of route exchange: samples of RTZ, validity, precision, and times for 10,000 waypoints.

    python -m tests.campaigns.route_exchange_figures

The samples are those of the test data (`tests.conftest.data_file`).
"""

from __future__ import annotations

import hashlib
import tempfile
import time
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from tests.conftest import data_folder
from tests.route.planar import ship
from thalweg.core.errors import InputError, ThalwegWarning
from thalweg.core.geodesy import distance
from thalweg.core.units import NAUTICAL_MILE
from thalweg.route import Route, RouteFileOptions, Track, evaluate, read_track
from thalweg.route.formats import ROUTE_FORMATS, write_route_files
from thalweg.route.formats.file_route import file_route
from thalweg.sea import Sea

WAYPOINTS = 10_000
TEST_DATA = data_folder()


def main() -> None:
    """Print all figures."""
    if TEST_DATA is None:
        raise SystemExit("the test data are not here (set THALWEG_TEST_DATA)")
    with tempfile.TemporaryDirectory() as folder:
        _samples(Path(folder))
        _times(Path(folder))


def _read(path: Path) -> tuple[Track | None, list[str]]:
    """Return the track of a file, and what was noted; None where it is refused."""
    with warnings.catch_warnings(record=True) as noted:
        warnings.simplefilter("always", ThalwegWarning)
        try:
            return read_track(path, depart=0.0), [str(one.message) for one in noted]
        except InputError as error:
            return None, [str(error)]


def _samples(folder: Path) -> None:
    samples = sorted((TEST_DATA / "rtz" / "samples").rglob("*.rtz*"))
    equal = read = errors = named = 0
    worst_place = worst_time = 0.0
    invalid: list[str] = []
    written = 0
    for path in samples:
        track, notes = _read(path)
        if "Errors" in path.parts:
            errors += 1
            named += bool(notes)
        if track is None:
            print(f"  refused: {path.name}: {notes[0]}")
            continue
        read += 1
        route = evaluate(track, ship=ship(7.0), sea=Sea.calm(), strict=False)
        same = True
        for version in ("1.0", "1.1", "1.2"):
            options = RouteFileOptions(
                legs="great-circle", thinning=0.0, rtz_version=version, formats=("rtz",)
            )
            found = write_route_files(route, folder, "sample", options)[0]
            written += 1
            invalid += _faults(found, version)
            again, _ = _read(found)
            place, seconds = _differences(route, again)
            worst_place, worst_time = max(worst_place, place), max(worst_time, seconds)
            same &= place <= 1e-6 and seconds <= 1.0
        equal += same
    print(f"samples: {len(samples)}, read {read}, written and read again equal {equal}")
    print(f"deliberate errors: {errors}, named {named}")
    print(f"files written: {written}, not valid by the schemas: {len(invalid)} {invalid[:3]}")
    print(f"greatest difference: {worst_place:.1e} degrees, {worst_time:.2f} s")


def _differences(route: Route, again: Track | None) -> tuple[float, float]:
    """Return how far waypoints [deg] and the arrival [s] of a route are from those read again."""
    track = route.track
    if again is None:
        return np.inf, np.inf
    if len(again) != len(track):
        # waypoints closer than 20 m to the one before are one
        near = distance(
            again.lat[:, None], again.lon[:, None], track.lat[None], track.lon[None]
        ).min(axis=0)
        return (0.0 if near.max() < 20.0 else np.inf), 0.0
    turn = (again.lon - track.lon + 180.0) % 360.0 - 180.0
    place = max(float(np.abs(again.lat - track.lat).max()), float(np.abs(turn).max()))
    sailed = evaluate(again, ship=ship(7.0), sea=Sea.calm(), strict=False)
    return place, abs(sailed.time_h - route.time_h) * 3600.0


def _faults(path: Path, version: str) -> list[str]:
    """Return the first fault of a file by the schema of its version; none without lxml."""
    try:
        from lxml import etree
    except ImportError:
        return ["lxml is not installed"]
    name = f"RTZ Schema version {version.replace('.', '_')}.xsd"
    schema = etree.XMLSchema(etree.parse(str(TEST_DATA / "rtz" / "schema" / name)))
    if schema.validate(etree.parse(str(path))):
        return []
    return [str(schema.error_log[0])]


def _times(folder: Path) -> None:
    share = np.linspace(0.0, 1.0, WAYPOINTS)
    lat = 40.0 + 10.0 * np.sin(20.0 * share)
    track = Track(lat, -60.0 + 50.0 * share, 0.0)
    route = evaluate(track, ship=ship(7.0), sea=Sea.calm())
    for thinning in (0.0, 0.5):
        options = RouteFileOptions(thinning=thinning)
        found = _timed(lambda options=options: file_route(route, options))
        print(
            f"{WAYPOINTS} waypoints, {len(found[0].rows)} kept: thinned in {found[1]:.2f} s CPU, "
            f"cross-track error {found[0].cross_track_m / NAUTICAL_MILE:.4f} nm"
        )
        for form in ROUTE_FORMATS:
            only = RouteFileOptions(thinning=thinning, formats=(form,))
            files, wrote = _timed(lambda only=only: write_route_files(route, folder, "a", only))
            size = files[0].stat().st_size / 1e6
            digest = hashlib.sha256(files[0].read_bytes()).hexdigest()[:12]
            line = f"  {form}: written in {wrote:.2f} s CPU with thinning, {size:.1f} MB, {digest}"
            if form != "kml":
                back, took = _timed(lambda files=files: read_track(files[0]))
                line += f"; {len(back)} waypoints read in {took:.2f} s"
            print(line)


def _timed(work: Callable[[], Any]) -> tuple[Any, float]:
    """Return a result, and the processor time of this process for it [s]."""
    start = time.process_time()
    return work(), time.process_time() - start


if __name__ == "__main__":
    main()

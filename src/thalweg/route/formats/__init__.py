"""Route files: reading and writing RTZ, S-421, GPX 1.1, GeoJSON (RFC 7946), KML and CSV.

Files hold few waypoints, joined by rhumb lines within a cross-track limit of the route
(`RouteFileOptions`).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Final

from thalweg.core.errors import InputError
from thalweg.core.file_reading import too_large
from thalweg.core.time import TimeLike
from thalweg.route.formats.csv_format import parse_csv, write_csv
from thalweg.route.formats.geojson_format import parse_geojson, write_geojson
from thalweg.route.formats.gpx_format import parse_gpx, write_gpx
from thalweg.route.formats.kml_format import parse_kml, write_kml
from thalweg.route.formats.leg_corridors import corridor_notes
from thalweg.route.formats.parsed_track import ParsedTrack, track_of
from thalweg.route.formats.route_file_options import (
    LARGEST_FILE,
    ROUTE_FORMATS,
    RouteFileOptions,
)
from thalweg.route.formats.rtz_reader import parse_rtz, parse_rtzp
from thalweg.route.formats.rtz_writer import write_rtz, write_rtzp
from thalweg.route.formats.s421_reader import parse_s421
from thalweg.route.formats.s421_writer import write_s421
from thalweg.route.route import Route
from thalweg.route.track import Track

if TYPE_CHECKING:
    from thalweg.chart import Chart

__all__ = [
    "LARGEST_FILE",
    "ROUTE_FORMATS",
    "RouteFileOptions",
    "cross_track_notes",
    "read_track",
    "remove_route_files",
    "write_csv",
    "write_geojson",
    "write_gpx",
    "write_kml",
    "write_route_files",
    "write_rtz",
    "write_rtzp",
    "write_s421",
]

_PARSERS: dict[str, Callable[[str], ParsedTrack]] = {
    ".csv": parse_csv,
    ".txt": parse_csv,
    ".geojson": parse_geojson,
    ".json": parse_geojson,
    ".gpx": parse_gpx,
    ".kml": parse_kml,
}
_BYTE_PARSERS: dict[str, Callable[[bytes], ParsedTrack]] = {
    ".rtz": parse_rtz,
    ".rtzp": parse_rtzp,
    ".gml": parse_s421,
}

#: Writes a route into a file, as some options say.
_RouteWriter = Callable[[Route, str | Path, RouteFileOptions | None], None]
#: The writers of route files, by the ending of their files.
_WRITERS: Final[Mapping[str, _RouteWriter]] = {
    "rtz": write_rtz,
    "rtzp": write_rtzp,
    "gml": write_s421,
    "gpx": write_gpx,
    "geojson": write_geojson,
    "kml": write_kml,
    "csv": write_csv,
}


def write_route_files(
    route: Route, folder: str | Path, name: str = "route", options: RouteFileOptions | None = None
) -> list[Path]:
    """Write a route in each format of its options.

    Parameters
    ----------
    folder : It exists.
    name : Of the files, without ending.

    Returns
    -------
    list of Path
        The files written.
    """
    options = options or RouteFileOptions()
    files = [Path(folder) / f"{name}.{ending}" for ending in options.formats]
    for path, ending in zip(files, options.formats):
        _WRITERS[ending](route, path, options)
    return files


def remove_route_files(folder: str | Path, name: str) -> None:
    """Remove the route files of a name, in all formats, as far as there are any.

    Parameters
    ----------
    name : Of the files, without ending.
    """
    for ending in _WRITERS:
        (Path(folder) / f"{name}.{ending}").unlink(missing_ok=True)


def read_track(path: str | Path, *, depart: TimeLike | None = None) -> Track:
    """Read a track from a file, by its suffix.

    Parameters
    ----------
    path : str or Path
        ``.csv`` or ``.txt`` (columns lat and lon, perhaps time, waiting_h, ordered_speed_kn),
        ``.geojson`` or ``.json`` (LineString, MultiLineString or Points), ``.gpx`` (one route or
        track), ``.kml`` (placemarks with times, a line or a track), ``.rtz`` and ``.rtzp`` (RTZ 1.0
        to 1.2), ``.gml`` (S-421, experimental). Legs of RTZ and S-421 are rhumb lines unless marked
        as orthodromes; those of the other formats are geodesics unless marked as rhumb lines.
    depart : Departure; by default the first time in the file.

    Returns
    -------
    Track
        With the waits and ordered speeds of the file, which files of this package have; otherwise
        without waits, at the highest setting of the ship. Repeated positions are merged.

    Raises
    ------
    InputError
        If the file is missing, too large, not readable or of another kind, has fewer than two
        waypoints or impossible positions, or if there is no departure.
    """
    path = Path(path)
    return track_of(route_file_contents(path), depart, path.name)


def cross_track_notes(path: str | Path, chart: Chart) -> list[str]:
    """Return whether the cross-track limits in a route file keep clear of land and closed zones.

    Parameters
    ----------
    path : As of `read_track`; RTZ has such limits.

    Returns
    -------
    list of str
        One note; empty where the file has no limits.
    """
    return corridor_notes(route_file_contents(Path(path)), chart)


def route_file_contents(path: Path) -> ParsedTrack:
    """Return the contents of a route file, by its ending; see `read_track`."""
    ending = path.suffix.lower()
    if ending not in (*_PARSERS, *_BYTE_PARSERS):
        raise InputError(
            f"Routes are not read from files like {path.name!r}.",
            f"Known endings: {', '.join((*_PARSERS, *_BYTE_PARSERS))}.",
            "Convert the file, or give it the right ending.",
            file=str(path),
        )
    data = _bytes_of(path)
    if ending in _BYTE_PARSERS:
        return _BYTE_PARSERS[ending](data)
    return _PARSERS[ending](_text_of(data, path))


def _bytes_of(path: Path) -> bytes:
    try:
        size = path.stat().st_size
        data = b"" if size > LARGEST_FILE else path.read_bytes()
    except (OSError, ValueError) as error:  # ValueError: a null character in the path
        raise InputError(
            f"The route file {str(path)!r} cannot be read: "
            f"{getattr(error, 'strerror', None) or error}.",
            "A route file is RTZ, S-421, GPX, GeoJSON, KML or CSV.",
            "Check the path.",
            file=str(path),
        ) from None
    if size > LARGEST_FILE:
        words = too_large(f"route file {path.name!r}", LARGEST_FILE, size)
        raise InputError(*words, "Reduce it to the route.", file=str(path))
    return data


def _text_of(data: bytes, path: Path) -> str:
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:
        raise InputError(
            f"The route file {path.name!r} is not text (UTF-8).",
            "Route files are text in UTF-8.",
            "Save it as UTF-8 text.",
            file=str(path),
        ) from None

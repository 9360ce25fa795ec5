"""Downloads: ranges of bytes, bounded retries, resume, and a cache by address.

Addresses of forecast runs hold the run, so what they give does not change; the cache keeps it.
"""

from __future__ import annotations

import contextlib
import hashlib
import math
import os
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final
from urllib.parse import urlsplit

from thalweg.core.cache_folder import cache_folder
from thalweg.core.errors import InputError, ThalwegError
from thalweg.core.file_writing import replacing_file

ATTEMPTS: Final = 5  #: for one address
_PAUSES: Final = (1.0, 2.0, 5.0, 10.0)  #: between attempts [s]
_LONGEST_PAUSE: Final = 60.0  #: that a server may ask for [s]
_TIMEOUT: Final = (15.0, 60.0)  #: to connect, and between bytes [s]
_AGAIN: Final = frozenset({408, 429, 500, 502, 503, 504})  #: statuses that are tried again
_CHUNK: Final = 1 << 13  #: [bytes]; what a broken download loses at most
CACHE_SIZE: Final = 5_000_000_000  #: [bytes] after which the oldest files go
_SMALL: Final = 64_000_000  #: [bytes] largest answer that is kept in memory


@dataclass(frozen=True)
class DownloadPart:
    """One file, or ranges of bytes of one.

    Attributes
    ----------
    ranges : tuple of (int, int)
        First byte and number of bytes of each range, ascending; empty: the whole file.
    label : What it holds, for messages: ``waves at 2026-11-22T06:00Z``.
    body : JSON that is sent; the file is then the answer to a POST.
    """

    url: str
    ranges: tuple[tuple[int, int], ...] = ()
    label: str = ""
    body: str = ""


class TransferError(ThalwegError):
    """A server did not deliver what was requested."""


class DownloadClient:
    """Downloads files and ranges of bytes into a cache.

    Parameters
    ----------
    folder : Cache; default: ``forecasts`` in the cache of this user.
    pause : Waits for a number of seconds.

    Raises
    ------
    InputError : If the package ``requests`` is not installed.
    """

    def __init__(
        self, folder: Path | None = None, *, pause: Callable[[float], None] = time.sleep
    ) -> None:
        try:
            import requests
        except ImportError as error:
            raise InputError(
                "Fetching forecasts needs the package requests.",
                "Files downloaded by other means can be used at once.",
                "pip install 'thalweg[fetch]'",
            ) from error
        self._requests = requests
        self._session = requests.Session()
        self._session.headers["User-Agent"] = "thalweg (open-source voyage optimisation)"
        self._pause = pause
        self.folder = folder if folder is not None else cache_folder("forecasts")

    def text(self, url: str, *, body: str = "", **parameters: Any) -> str | None:
        """Return a small text; None where the server does not have it.

        Parameters
        ----------
        body : JSON that is sent with a POST.
        **parameters : Of the query.

        Returns
        -------
        str or None : None for the statuses 204, 403, 404 and 410.

        Raises
        ------
        TransferError : If the server cannot be reached or refuses.
        """

        def read(answer: Any) -> bytes:
            return _bounded(answer, url)

        data = self._attempts(url, read, {"params": parameters or None}, body=body)
        return None if data is None else data.decode("utf-8", "replace")

    def file(self, part: DownloadPart) -> Path:
        """Return the file of a part, downloaded unless it is in the cache.

        Returns
        -------
        Path : The ranges of the part, joined.

        Raises
        ------
        TransferError : If it is not there, or the server does not deliver all of it.
        """
        named = (part.url, part.ranges, part.body) if part.body else (part.url, part.ranges)
        key = hashlib.blake2b(repr(named).encode(), digest_size=16).hexdigest()
        target = self.folder / key
        if target.exists():
            os.utime(target)
            return target
        self.folder.mkdir(parents=True, exist_ok=True)
        with replacing_file(target) as stream:
            for first, count in part.ranges or ((0, -1),):
                self._range(part, first, count, stream)
        return target

    def prune(self, size: int = CACHE_SIZE) -> None:
        """Remove the files used longest ago until the cache is below a size [bytes]."""
        files = []
        for path in self.folder.iterdir() if self.folder.exists() else ():
            with contextlib.suppress(OSError):
                facts = path.stat()
                files.append((facts.st_mtime, facts.st_size, path))
        total = sum(entry[1] for entry in files)
        for _, length, path in sorted(files, key=lambda entry: entry[0]):
            if total <= size:
                return
            with contextlib.suppress(OSError):
                path.unlink()
                total -= length

    def _range(self, part: DownloadPart, first: int, count: int, stream: Any) -> None:
        """Append a range to a stream; broken downloads go on where they ended."""
        begin = stream.tell()

        def read(answer: Any) -> bytes:
            done = stream.tell() - begin
            if answer.status_code != 206 and (first or done):
                if first or count >= 0:
                    raise self._requests.RequestException("the server sends whole files only")
                stream.seek(begin)
                stream.truncate()
                done = 0
            for chunk in answer.iter_content(_CHUNK):
                stream.write(chunk)
            done = stream.tell() - begin
            wanted = count if count >= 0 else _whole_length(answer, first + done) - first
            if done < wanted:
                raise self._requests.ConnectionError(f"{done} of {wanted} bytes arrived")
            if done > wanted:
                stream.seek(begin + wanted)
                stream.truncate()
            return b""

        def headers() -> dict[str, str]:
            done = stream.tell() - begin
            if count < 0 and not first and not done:
                return {}
            last = "" if count < 0 else str(first + count - 1)
            return {"Range": f"bytes={first + done}-{last}"}

        if self._attempts(part.url, read, {"stream": True}, headers, body=part.body) is None:
            raise TransferError(
                f"{_host(part.url)} does not have {part.label or part.url}.",
                "Other times or runs of the source may be complete.",
                "Choose an earlier run, or try again later.",
                url=part.url,
            )

    def _attempts(
        self,
        url: str,
        read: Callable[[Any], bytes],
        options: dict[str, Any],
        headers: Callable[[], dict[str, str]] = dict,
        *,
        body: str = "",
    ) -> bytes | None:
        """Return what ``read`` makes of the answer; None if the server does not have it."""
        failure = ""
        kind = {"Content-Type": "application/json"} if body else {}
        for attempt in range(ATTEMPTS):
            pause = _PAUSES[min(attempt, len(_PAUSES) - 1)]
            try:
                answer = self._session.request(
                    "POST" if body else "GET",
                    url,
                    headers={**headers(), **kind},
                    timeout=_TIMEOUT,
                    data=body.encode() or None,
                    **options,
                )
                with answer:
                    if answer.status_code in (204, 403, 404, 410):
                        return None
                    if answer.status_code in (200, 206):
                        return read(answer)
                    failure = f"status {answer.status_code}"
                    if answer.status_code not in _AGAIN:
                        break
                    pause = max(pause, _requested_pause(answer))
            except self._requests.Timeout:
                failure = "no answer in time"
            except self._requests.RequestException as error:
                failure = str(error)[:200]
                if _unreachable(error):
                    raise _no_network_error(url) from error
            if attempt < ATTEMPTS - 1:
                self._pause(pause)
        raise TransferError(
            f"{_host(url)} did not deliver {urlsplit(url).path}: {failure}.",
            f"Up to {ATTEMPTS} attempts were made.",
            "Try again later; what has arrived is kept.",
            url=url,
        )


def _bounded(answer: Any, url: str) -> bytes:
    data = answer.content
    if len(data) > _SMALL:
        raise TransferError(
            f"{_host(url)} sent {len(data) / 1e6:.0f} MB where an index was expected.",
            f"At most {_SMALL / 1e6:.0f} MB are read.",
            "Report this with the request.",
        )
    return bytes(data)


def _whole_length(answer: Any, done: int) -> int:
    """Return the length of a whole file that the server states; else what has arrived."""
    total = answer.headers.get("Content-Range", "").rpartition("/")[2]
    total = total or ("" if answer.status_code == 206 else answer.headers.get("Content-Length", ""))
    packed = answer.headers.get("Content-Encoding")
    return int(total) if total.isdigit() and not packed else done


def _requested_pause(answer: Any) -> float:
    """Return the pause that a server asks for [s]."""
    try:
        seconds = float(answer.headers.get("Retry-After", "0"))
    except ValueError:
        return 0.0
    return min(seconds, _LONGEST_PAUSE) if math.isfinite(seconds) else 0.0


def _unreachable(error: Exception) -> bool:
    """Return whether no connection could be made at all."""
    text = str(error)
    words = ("resolve", "Name or service", "refused", "unreachable", "getaddrinfo")
    return any(word in text for word in words)


def _host(url: str) -> str:
    return urlsplit(url).hostname or url


def _no_network_error(url: str) -> TransferError:
    return TransferError(
        f"{_host(url)} cannot be reached: there is no connection to it.",
        "Without a network, files that were downloaded elsewhere can be used: "
        "thalweg plan ... --sea FILE.",
        "Check the connection, or copy a forecast file to this computer.",
        url=url,
    )

"""`UploadStore`: uploaded files, named by the hash of their content."""

from __future__ import annotations

import hashlib
import json
import os
import secrets
import shutil
from collections.abc import AsyncIterator
from dataclasses import dataclass
from pathlib import Path, PurePosixPath, PureWindowsPath
from typing import Any, BinaryIO, Final

from starlette.concurrency import run_in_threadpool

from thalweg.core.file_reading import too_large
from thalweg.core.file_writing import make_folder, write_text
from thalweg.service.problem_details import ServiceError, not_found

_ID_LENGTH: Final = 32  # hexadecimal digits
_NAME_LENGTH: Final = 120


@dataclass(frozen=True)
class StoredFile:
    """An uploaded file.

    Attributes
    ----------
    id : From the SHA-256 of its content.
    name : Its name at the client, for people.
    path : Where it is kept.
    facts : What was found in it.
    """

    id: str
    name: str
    path: Path
    facts: dict[str, Any]

    def as_dict(self) -> dict[str, Any]:
        """Return plain data for JSON."""
        return {"id": self.id, "name": self.name, "bytes": self.path.stat().st_size, **self.facts}


class UploadStore:
    """Files of one kind in a folder: for each a folder with the content and a record.

    Parameters
    ----------
    kind : For messages, such as ``sea``.
    endings : Endings of names that are taken.
    largest, total : Limits of one file and of all [bytes].
    clean : Remove what unfinished uploads have left; only the server does.
    """

    def __init__(
        self,
        folder: Path,
        kind: str,
        endings: tuple[str, ...],
        *,
        largest: int,
        total: int,
        clean: bool = True,
    ) -> None:
        self.folder = make_folder(folder)
        self.kind = kind
        self.endings = endings
        self.largest = largest
        self.total = total
        for left in self.folder.glob(".part-*") if clean else ():
            _remove(left)

    async def receive(self, name: str, chunks: AsyncIterator[bytes]) -> tuple[Path, str, str]:
        """Write an upload to a temporary file while it arrives.

        Parameters
        ----------
        name : Name of the file at the client.

        Returns
        -------
        part : Path
            The temporary file: `keep` or remove it.
        file_id : str
        name : str
            The name without folders and unusual characters.

        Raises
        ------
        ServiceError
            415 for another ending, 413 for too large a file, 422 for an empty one.
        """
        name = _clean_name(name)
        ending = _ending(name)
        if ending not in self.endings:
            raise ServiceError(
                415,
                f"{name!r} is not taken as a {self.kind}.",
                f"Names of {self.kind} files end with {', '.join(self.endings)}.",
                "Convert the file, or give it the right ending.",
                field="file",
            )
        part = self.folder / f".part-{secrets.token_hex(8)}{ending}"
        digest, size = hashlib.sha256(), 0
        room = self.total - await run_in_threadpool(self.used_bytes)
        try:
            with part.open("xb") as file:
                async for chunk in chunks:
                    size += len(chunk)
                    if size > min(self.largest, room):
                        raise self._too_large(room)
                    await run_in_threadpool(_write_piece, file, digest, chunk)
                file.flush()
                await run_in_threadpool(os.fsync, file.fileno())
            if size == 0:
                raise ServiceError(422, "The file is empty.", "", "Choose another.", field="file")
        except BaseException:
            part.unlink(missing_ok=True)
            raise
        return part, digest.hexdigest()[:_ID_LENGTH], name

    def _too_large(self, room: int) -> ServiceError:
        if room < self.largest:
            return ServiceError(
                507,
                "There is no room left for this file.",
                f"All {self.kind} files together may have {self.total / 1e9:.1f} GB.",
                "Delete files that are not used any more.",
                field="file",
            )
        return ServiceError(
            413,
            *too_large(f"{self.kind} file", self.largest),
            "Cut it to the area and period of the voyage.",
            field="file",
        )

    def keep(self, part: Path, file_id: str, name: str, facts: dict[str, Any]) -> StoredFile:
        """Give a received file its place; the same content twice is one file."""
        place = self.folder / file_id
        if not (place / "record.json").exists():
            draft = self.folder / f".part-{secrets.token_hex(8)}"
            draft.mkdir()
            record = {"name": name, "facts": facts}
            write_text(draft / "record.json", json.dumps(record, allow_nan=False))
            os.replace(part, draft / f"file{_ending(name)}")
            try:
                os.rename(draft, place)
            except OSError:  # another request was first
                shutil.rmtree(draft, ignore_errors=True)
        part.unlink(missing_ok=True)
        return self.get(file_id)

    def get(self, file_id: str) -> StoredFile:
        """Return a file.

        Raises
        ------
        ServiceError
            404 if there is none of this id.
        """
        place = self.folder / file_id
        known = file_id.isalnum() and (place / "record.json").exists()
        if not known:
            raise not_found(self.kind, file_id[:80], f"Upload the {self.kind} first.")
        record = json.loads((place / "record.json").read_text("utf-8"))
        path = place / f"file{_ending(record['name'])}"
        return StoredFile(file_id, record["name"], path, record["facts"])

    def all(self) -> list[StoredFile]:
        """Return all files, by name."""
        found = [self.get(path.parent.name) for path in self.folder.glob("[!.]*/record.json")]
        return sorted(found, key=lambda file: (file.name.casefold(), file.id))

    def delete(self, file_id: str) -> None:
        """Remove a file; plans made with it keep their results."""
        self.get(file_id)
        gone = self.folder / f".part-{secrets.token_hex(8)}"
        os.rename(self.folder / file_id, gone)
        shutil.rmtree(gone, ignore_errors=True)

    def used_bytes(self) -> int:
        """Return the size of all files [bytes]."""
        return sum(path.stat().st_size for path in self.folder.glob("[!.]*/file.*"))


def _write_piece(file: BinaryIO, digest: Any, piece: bytes) -> None:
    digest.update(piece)
    file.write(piece)


def file_identity(path: Path) -> str:
    """Return the id of a file by its content."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()[:_ID_LENGTH]


def _remove(path: Path) -> None:
    if path.is_dir():
        shutil.rmtree(path, ignore_errors=True)
    else:
        path.unlink(missing_ok=True)


def _ending(name: str) -> str:
    return PurePosixPath(name).suffix.lower()


def _clean_name(name: str) -> str:
    last = PureWindowsPath(PurePosixPath(name).name).name
    text = "".join(letter for letter in last if letter.isprintable()).strip()
    return text[-_NAME_LENGTH:] or "file"

"""Uploads as they arrive: in pieces, checked in another process, kept or removed."""

from __future__ import annotations

from collections.abc import AsyncIterator, Callable
from pathlib import Path
from typing import Any, Final

from fastapi import UploadFile
from starlette.concurrency import run_in_threadpool

from thalweg.core.errors import ThalwegError
from thalweg.service.upload_store import StoredFile, UploadStore

_PIECE: Final = 2**20  # bytes


async def chunks_of(file: UploadFile) -> AsyncIterator[bytes]:
    """Yield the content of an uploaded file in pieces."""
    while piece := await file.read(_PIECE):
        yield piece


async def kept_upload(
    store: UploadStore,
    name: str,
    chunks: AsyncIterator[bytes],
    facts_of: Callable[[str], dict[str, Any]],
) -> StoredFile:
    """Receive a file, check it, and keep it.

    Parameters
    ----------
    name : Name at the client.
    facts_of : Returns what is in the file at a path, or raises.
    """
    part, file_id, name = await store.receive(name, chunks)
    try:
        facts = await run_in_threadpool(facts_of, str(part))
        return await run_in_threadpool(store.keep, Path(part), file_id, name, facts)
    except ThalwegError as error:
        raise _with_the_clients_name(error, part, name) from None
    finally:
        part.unlink(missing_ok=True)


def _with_the_clients_name(error: ThalwegError, part: Path, name: str) -> ThalwegError:
    """Return an error that names the file as the client does, at the field of the upload."""
    for attribute in ("asked", "possible", "remedy"):
        text = getattr(error, attribute)
        setattr(error, attribute, text.replace(str(part), name).replace(part.name, name))
    error.details = {"field": "file", "file": name}
    return error

"""`ServiceSettings`: where the service keeps its files, who may use it, and its limits."""

from __future__ import annotations

import os
import secrets
import sys
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

from thalweg.core.errors import InputError
from thalweg.core.file_writing import make_folder, write_text
from thalweg.core.memory import machine_memory
from thalweg.route.formats.route_file_options import LARGEST_FILE

LOOPBACK_HOSTS: Final = ("127.0.0.1", "localhost", "::1")
DEFAULT_PORT: Final = 8765
_SHORTEST_TOKEN: Final = 16  # characters of a token that the user chooses


@dataclass(frozen=True)
class ServiceLimits:
    """What the service refuses or stops.

    Attributes
    ----------
    workers : Jobs that run at the same time.
    queue : Jobs that may wait.
    attempts : How often a job is started whose process ends without a result.
    job_seconds : Longest run of a job [s].
    job_bytes : Greatest resident memory of a job [bytes].
    upload_bytes : Largest uploaded sea or depth file [bytes].
    store_bytes : Largest total of all uploads [bytes].
    small_upload_bytes : Largest ship or route file, and largest body of a request [bytes].
    worker_seconds : Longest time for one task with a file: inspection, import, one frame [s].
    cancel_seconds : Time after which a job that is asked to stop is ended [s].
    """

    workers: int = max(1, (os.cpu_count() or 2) // 2)
    queue: int = 100
    attempts: int = 5
    job_seconds: float = 3600.0
    job_bytes: int = field(default_factory=lambda: machine_memory() // 2)
    upload_bytes: int = 2 * 2**30
    store_bytes: int = 20 * 2**30
    small_upload_bytes: int = LARGEST_FILE
    worker_seconds: float = 60.0
    cancel_seconds: float = 60.0


@dataclass(frozen=True)
class ServiceSettings:
    """Settings of one service.

    Attributes
    ----------
    folder : Where jobs, results and uploads are kept.
    token : Secret that every request states.
    host, port : Where it listens.
    allowed_hosts : Names under which browsers may address it, besides those of the loopback.
    """

    folder: Path
    token: str
    host: str = "127.0.0.1"
    port: int = DEFAULT_PORT
    allowed_hosts: tuple[str, ...] = ()
    limits: ServiceLimits = field(default_factory=ServiceLimits)

    def __post_init__(self) -> None:
        if len(self.token) < _SHORTEST_TOKEN:
            raise InputError(
                f"The token has {len(self.token)} characters.",
                f"It has at least {_SHORTEST_TOKEN}.",
                "Choose a longer one, or leave it out: the service then makes one.",
                field="token",
            )
        if self.host not in LOOPBACK_HOSTS and not self.allowed_hosts:
            raise InputError(
                f"The service is to listen on {self.host!r}, which other computers can reach.",
                "Without more it listens on this computer only (127.0.0.1).",
                "Add --allow-host NAME with the name or address under which it is opened.",
                field="host",
            )

    @property
    def hosts(self) -> frozenset[str]:
        """Every host name, without port, under which the service may be addressed."""
        return frozenset(name.casefold() for name in (*LOOPBACK_HOSTS, *self.allowed_hosts))

    @property
    def address(self) -> str:
        """The address of the first page, without the token."""
        host = self.allowed_hosts[0] if self.host not in LOOPBACK_HOSTS else self.host
        return f"http://[{host}]:{self.port}/" if ":" in host else f"http://{host}:{self.port}/"

    def subfolder(self, name: str) -> Path:
        """Return a folder inside `folder`, which is made where it does not exist."""
        return make_folder(self.folder / name)


def default_data_folder() -> Path:
    """Return the folder of the service without ``--data``.

    Returns
    -------
    Path
        ``THALWEG_DATA``, else ``thalweg`` in the user's folder for application data.
    """
    given = os.environ.get("THALWEG_DATA")
    if given:
        return Path(given)
    if sys.platform == "win32":
        return Path(os.environ.get("LOCALAPPDATA") or Path.home()) / "thalweg-data"
    return Path(os.environ.get("XDG_DATA_HOME") or Path.home() / ".local" / "share") / "thalweg"


def stored_token(folder: Path) -> str:
    """Return the token of a data folder; on first use one is made.

    It is kept in the file ``token``, which only its user can read.
    """
    path = make_folder(folder) / "token"
    if path.exists():
        text = path.read_text("utf-8").strip()
        if len(text) >= _SHORTEST_TOKEN:
            return text
    token = secrets.token_urlsafe(24)
    path.touch(mode=0o600)
    path.chmod(0o600)
    write_text(path, token + "\n")
    return token

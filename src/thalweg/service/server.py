"""Running the service: settings to a listening server that prints its address."""

from __future__ import annotations

import socket
import sys
from collections.abc import Callable
from typing import TYPE_CHECKING

from thalweg.core.errors import InputError
from thalweg.service.service_settings import ServiceSettings

if TYPE_CHECKING:
    from fastapi import FastAPI


def run_server(
    settings: ServiceSettings,
    announce: Callable[[str], None],
    *,
    open_page: bool = False,
    page: str = "",
) -> None:
    """Serve until Ctrl-C.

    Parameters
    ----------
    announce : Takes the text with the address, for people.
    open_page : Whether to open the page in the browser of this computer.
    page : Fragment of the page to open, such as ``demo``.

    Raises
    ------
    InputError
        If the extra ``serve`` is not installed, or the port or the folder is in use.
    """
    try:
        import uvicorn

        from thalweg.service.application import create_application
    except ImportError as error:
        raise InputError(
            f"The web application needs the package {error.name!r}.",
            "It is not part of the smallest installation.",
            'Install it with: pip install "thalweg[serve]"',
        ) from None
    listening = _listening_socket(settings)
    application: FastAPI = create_application(settings)
    address = f"{settings.address}?token={settings.token}" + (f"#{page}" if page else "")
    announce(f"Thalweg is at {address}\nData: {settings.folder}\nCtrl-C ends it.")
    if open_page:
        import webbrowser

        webbrowser.open(address)
    config = uvicorn.Config(
        application,
        log_level="warning",
        access_log=False,
        timeout_graceful_shutdown=2,
        server_header=False,
    )
    uvicorn.Server(config).run(sockets=[listening])


def _listening_socket(settings: ServiceSettings) -> socket.socket:
    family = socket.AF_INET6 if ":" in settings.host else socket.AF_INET
    # with the protocol named, asyncio sends small answers at once (TCP_NODELAY)
    listening = socket.socket(family, socket.SOCK_STREAM, socket.IPPROTO_TCP)
    if sys.platform != "win32":
        listening.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        listening.bind((settings.host, settings.port))
    except OSError as error:
        listening.close()
        raise InputError(
            f"Port {settings.port} of {settings.host} cannot be used: {error.strerror or error}.",
            "A port is a free number between 1024 and 65535.",
            "Give another one with --port, or end the program that uses it.",
            field="port",
        ) from None
    return listening

"""Who may use the service: token, host and origin of every request; headers of every answer."""

from __future__ import annotations

import base64
import hashlib
import hmac
from http.cookies import SimpleCookie
from typing import Final
from urllib.parse import parse_qs, urlencode, urlsplit

from starlette.datastructures import Headers, MutableHeaders
from starlette.responses import HTMLResponse, RedirectResponse, Response
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from thalweg.service.problem_details import ServiceError, problem_response
from thalweg.service.service_settings import ServiceSettings

COOKIE: Final = "thalweg_token"
SECURITY_HEADERS: Final = {
    "Content-Security-Policy": "default-src 'self'; img-src 'self' data: blob:; "
    "object-src 'none'; base-uri 'none'; form-action 'self'; frame-ancestors 'none'",
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
}
_STYLE: Final = """:root { color-scheme: light dark; font: 16px/1.5 system-ui, sans-serif; }
body { max-width: 32rem; margin: 12vh auto; padding: 0 1.5rem; }
form { display: flex; gap: .5rem; flex-wrap: wrap; } label { flex-basis: 100%; font-weight: 600; }
input { flex: 1; min-width: 12rem; } input, button { font: inherit; padding: .4rem .6rem; }
"""
#: The form sends the token as the printed address does; the browser keeps the part after '#'.
_NO_TOKEN_PAGE: Final = """<!doctype html><html lang="en"><meta charset="utf-8">
<meta name="viewport" content="width=device-width"><title>Thalweg</title><style>{style}</style>
<main><h1>Thalweg</h1><p{role}>{said}</p>
<form><label for="token">Token of the service</label>
<input id="token" name="token" type="password" autocomplete="current-password" required autofocus>
<button>Open</button></form>
<p>The token is at the end of the address that <code>thalweg serve</code> printed when it started,
and in the file <code>token</code> of its data folder.</p></main></html>"""


class AccessControl:
    """ASGI middleware that refuses requests of others.

    A request states the token as ``Authorization: Bearer`` or in the cookie that the first page
    sets. Browsers send the cookie with links that are followed from elsewhere (a permalink in a
    message), and with no other request of another site. The ``Host`` must be one of the service
    (against DNS rebinding), and a stated ``Origin`` the service itself.
    """

    def __init__(self, application: ASGIApp, settings: ServiceSettings) -> None:
        self.application = application
        self.settings = settings

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer a request or refuse it."""
        if scope["type"] != "http":
            if scope["type"] == "lifespan":
                await self.application(scope, receive, send)
            return
        refusal = self._refusal(scope)
        if refusal is not None:
            await refusal(scope, receive, _with_headers(send))
        else:
            await self.application(scope, receive, _with_headers(send))

    def _refusal(self, scope: Scope) -> Response | None:
        headers = Headers(scope=scope)
        host = headers.get("host", "")
        if _name_of(host) not in self.settings.hosts:
            return problem_response(
                ServiceError(
                    403,
                    f"The service is addressed as {host[:100]!r}.",
                    f"It answers to {', '.join(sorted(self.settings.hosts))}.",
                    "Start it with --allow-host to add a name.",
                )
            )
        origin = headers.get("origin")
        if origin is not None and urlsplit(origin).netloc.casefold() != host.casefold():
            return problem_response(
                ServiceError(403, "The request comes from another site.", "", "Open its own page.")
            )
        if scope["path"] == "/" and scope["method"] == "GET":
            return self._first_page(scope, headers)
        return None if self._knows_token(headers) else _unauthorised()

    def _first_page(self, scope: Scope, headers: Headers) -> Response | None:
        """Turn the token of the printed address into a cookie; refuse a page without it."""
        query = parse_qs(scope["query_string"].decode("latin-1"), keep_blank_values=True)
        given = query.pop("token", [""])[0]
        if given and self._is_token(given):
            rest = urlencode(query, doseq=True)
            answer = RedirectResponse("/" + (f"?{rest}" if rest else ""), 303)
            answer.set_cookie(COOKIE, given, httponly=True, samesite="lax", max_age=90 * 86400)
            return answer
        if self._knows_token(headers):
            return None
        return _page_for_the_token(wrong=bool(given))

    def _knows_token(self, headers: Headers) -> bool:
        kind, _, given = headers.get("authorization", "").partition(" ")
        if kind.casefold() == "bearer" and self._is_token(given.strip()):
            return True
        cookies: SimpleCookie = SimpleCookie()
        try:
            cookies.load(headers.get("cookie", ""))
        except ValueError:
            return False
        return COOKIE in cookies and self._is_token(cookies[COOKIE].value)

    def _is_token(self, given: str) -> bool:
        return hmac.compare_digest(given.encode("utf-8", "replace"), self.settings.token.encode())


def _page_for_the_token(*, wrong: bool) -> Response:
    """Return a page with a field for the token, which then opens the address that was wanted."""
    text = "This is not the token of the service." if wrong else "This address needs the token."
    page = _NO_TOKEN_PAGE.format(style=_STYLE, role=' role="alert"' if wrong else "", said=text)
    digest = base64.b64encode(hashlib.sha256(_STYLE.encode()).digest()).decode()
    policy = f"{SECURITY_HEADERS['Content-Security-Policy']}; style-src 'sha256-{digest}'"
    return HTMLResponse(page, 401, {"Content-Security-Policy": policy})


def _unauthorised() -> Response:
    return problem_response(
        ServiceError(
            401,
            "The request states no token, or not that of the service.",
            "It is a header 'Authorization: Bearer TOKEN', or the cookie of the first page.",
            "Open the address that 'thalweg serve' printed; the token is also in the file 'token' "
            "of its data folder.",
        ),
        headers={"WWW-Authenticate": "Bearer"},
    )


def _name_of(host: str) -> str:
    """Return a host without its port."""
    if host.startswith("["):
        return host[1:].partition("]")[0].casefold()
    return host.partition(":")[0].casefold()


def _with_headers(send: Send) -> Send:
    async def send_with_headers(message: Message) -> None:
        if message["type"] == "http.response.start":
            headers = MutableHeaders(scope=message)
            for name, value in SECURITY_HEADERS.items():
                headers.setdefault(name, value)
            headers.setdefault("Cache-Control", "no-cache")
        await send(message)

    return send_with_headers

"""Checks whether the package index that pip would use is reachable, and prints why not.

`pydslrep run` does this before it installs anything, because pip would retry for minutes.
Other failures, such as an untrusted certificate, are left to pip.
"""

import asyncio
import configparser
import os
import socket
import ssl
import sys
import urllib.request
from pathlib import Path
from urllib.parse import SplitResult, urlsplit

LIMIT = 2.0  # s, from the name lookup to the first reply
ABSENT = 3  # the exit code for "unreachable"
DEFAULT_PORTS = {"http": 80, "https": 443}


def configuration_files() -> list[Path]:
    """The files that pip reads settings from; later ones take precedence."""
    chosen = os.environ.get("PIP_CONFIG_FILE")
    if chosen == os.devnull:
        return []
    home = Path.home()
    if sys.platform == "win32":
        machine = Path(os.environ.get("PROGRAMDATA", "C:/ProgramData"))
        user = Path(os.environ.get("APPDATA", home))
        files = [machine / "pip/pip.ini", home / "pip/pip.ini", user / "pip/pip.ini"]
    else:
        config = Path(os.environ.get("XDG_CONFIG_HOME") or home / ".config")
        user = home / "Library/Application Support/pip/pip.conf"
        files = [Path("/etc/xdg/pip/pip.conf"), Path("/etc/pip.conf")]
        files += [home / ".pip/pip.conf", config / "pip/pip.conf", user]
    return [*files, Path(chosen)] if chosen else files


def setting(name: str) -> str:
    """One of pip's settings; the environment takes precedence over files."""
    value = os.environ.get("PIP_" + name.upper().replace("-", "_"))
    if value is not None:
        return value
    parser = configparser.RawConfigParser()
    parser.read(configuration_files(), encoding="utf-8")
    for section in ("install", "global"):
        if parser.has_option(section, name):
            return parser.get(section, name)
    return ""


def needs_no_index() -> bool:
    """Whether pip may install the client without the index."""
    links = setting("find-links").split()
    return bool(setting("no-index")) or any(
        "://" in link or any(Path(link).glob("coppeliasim*")) for link in links
    )


def proxy_for(index: SplitResult) -> SplitResult | None:
    """The proxy for the index, if any."""
    proxy = setting("proxy")
    if not proxy and not urllib.request.proxy_bypass(index.hostname or ""):
        proxies = urllib.request.getproxies()
        proxy = proxies.get(index.scheme) or proxies.get("all") or ""
    if not proxy:
        return None
    return urlsplit(proxy if "://" in proxy else f"http://{proxy}")


async def hear(place: SplitResult, is_proxy: bool) -> None:
    """Waits for a reply from an address; for a proxy, a connection is enough."""
    context = None
    if place.scheme == "https":
        # Certificates are verified by pip, not here.
        context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
        context.check_hostname = False
        context.verify_mode = ssl.CERT_NONE
    host = place.hostname or ""
    port = place.port or DEFAULT_PORTS.get(place.scheme, 80)
    reader, writer = await asyncio.open_connection(
        host, port, ssl=context, happy_eyeballs_delay=0.25
    )
    if context is None and not is_proxy:
        writer.write(f"HEAD / HTTP/1.0\r\nHost: {host}\r\n\r\n".encode())
        await reader.read(1)


def why(error: OSError) -> str:
    """A short description of an error."""
    if isinstance(error, socket.gaierror):
        return error.strerror or "no such name"
    return os.strerror(error.errno) if error.errno else "no connection"


def main() -> int:
    """Checks the index; prints a reason only if it is unreachable."""
    if needs_no_index():
        return 0
    index = urlsplit(setting("index-url") or "https://pypi.org/simple")
    proxy = proxy_for(index)
    # Closing the loop would wait for a pending name lookup, so it stays open.
    loop = asyncio.new_event_loop()
    answer = asyncio.wait_for(hear(proxy or index, proxy is not None), LIMIT)
    try:
        loop.run_until_complete(answer)
    except ssl.SSLError:
        return 0
    except TimeoutError:
        reason = f"no reply for {LIMIT:g} s"
    except OSError as error:
        reason = why(error)
    else:
        return 0
    through = f" by the proxy {proxy.hostname}" if proxy else ""
    print(f"{index.hostname} cannot be reached{through}: {reason}", flush=True)
    return ABSENT


if __name__ == "__main__":
    # The process must not wait for the lookup either.
    os._exit(main())

"""Asks the package index that pip would use whether it is there, and tells in a line why not.

`pydslrep run` does this before it installs anything: pip itself would try again and again.
What cannot be told here, such as a certificate that nobody trusts, is left to pip.
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

LIMIT = 2.0  # s, from looking up the name to the first answer
ABSENT = 3  # the exit code for "not there"
DEFAULT_PORTS = {"http": 80, "https": 443}


def configuration_files() -> list[Path]:
    """Where pip reads settings from; later ones count more."""
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
    """One of pip's settings: the environment counts more than files."""
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
    """Whether the client may come from somewhere else."""
    links = setting("find-links").split()
    return bool(setting("no-index")) or any(
        "://" in link or any(Path(link).glob("coppeliasim*")) for link in links
    )


def proxy_for(index: SplitResult) -> SplitResult | None:
    """What stands between this machine and the index."""
    proxy = setting("proxy")
    if not proxy and not urllib.request.proxy_bypass(index.hostname or ""):
        proxies = urllib.request.getproxies()
        proxy = proxies.get(index.scheme) or proxies.get("all") or ""
    if not proxy:
        return None
    return urlsplit(proxy if "://" in proxy else f"http://{proxy}")


async def hear(place: SplitResult, is_proxy: bool) -> None:
    """Waits until somebody answers at a place; a proxy answers by taking the connection."""
    context = None
    if place.scheme == "https":
        # Whom to trust is for pip to say: this only listens.
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
    """What went wrong, in a few words."""
    if isinstance(error, socket.gaierror):
        return error.strerror or "no such name"
    return os.strerror(error.errno) if error.errno else "no connection"


def main() -> int:
    """Asks; what is printed is only of use where the index is not there."""
    if needs_no_index():
        return 0
    index = urlsplit(setting("index-url") or "https://pypi.org/simple")
    proxy = proxy_for(index)
    # Its end would wait for a name that is still looked up: this never closes it.
    loop = asyncio.new_event_loop()
    answer = asyncio.wait_for(hear(proxy or index, proxy is not None), LIMIT)
    try:
        loop.run_until_complete(answer)
    except ssl.SSLError:
        return 0
    except TimeoutError:
        reason = f"no answer for {LIMIT:g} s"
    except OSError as error:
        reason = why(error)
    else:
        return 0
    through = f" by the proxy {proxy.hostname}" if proxy else ""
    print(f"{index.hostname} cannot be reached{through}: {reason}", flush=True)
    return ABSENT


if __name__ == "__main__":
    # Nor does the process wait for that.
    os._exit(main())

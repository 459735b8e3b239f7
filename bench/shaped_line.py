#!/usr/bin/env python3
"""A line between a client and a host: so many bits a second for all connections together, and half
of the round trip of delay each way.

    bench/shaped_line.py --listen 8092 --to 127.0.0.1:8093 --limit 20 --round-trip 50

Debian has no shaper that works on one pair of ports without rights on the network device (tc and
its netem) and on a host with epoll (trickle). This one is a TCP proxy: what it reads waits for its
turn in a bucket that both ways have of their own, then for the delay, and is written in that order.
To connect takes a round trip more, as on a line. Little is read ahead of the bucket, so that the other
end feels it.
"""

import argparse
import asyncio
import collections
import contextlib

CHUNK = 4 * 1024  # small, so that connections share the line fairly
QUEUE = 0.02  # seconds that a connection may have waiting before the line, so that it never idles


class Line:
    """One direction: a chunk after the other, whichever connection it is of."""

    def __init__(self, bytes_per_second):
        self.bytes_per_second = bytes_per_second
        self.free_at = 0.0

    def send(self, count):
        """When `count` bytes that are there now have passed."""
        now = asyncio.get_running_loop().time()
        self.free_at = max(self.free_at, now) + count / self.bytes_per_second
        return self.free_at


async def sleep_until(moment):
    await asyncio.sleep(max(0.0, moment - asyncio.get_running_loop().time()))


async def carry(reader, writer, line, delay):
    """From one end to the other, until one of them goes."""
    on_its_way = collections.deque()
    arrived = asyncio.Event()

    async def deliver():
        while True:
            while not on_its_way:
                arrived.clear()
                await arrived.wait()
            moment, chunk = on_its_way.popleft()
            await sleep_until(moment)
            if not chunk:
                with contextlib.suppress(OSError):
                    writer.write_eof()
                return
            writer.write(chunk)
            await writer.drain()

    delivering = asyncio.create_task(deliver())
    try:
        while True:
            chunk = await reader.read(CHUNK)
            passed = line.send(len(chunk))
            on_its_way.append((passed + delay, chunk))
            arrived.set()
            if not chunk:
                break
            await sleep_until(passed - QUEUE)
        await delivering
    finally:
        delivering.cancel()


async def join(reader, writer, arguments, up, down):
    delay = arguments.round_trip / 2000
    host, port = arguments.to.rsplit(":", 1)
    await asyncio.sleep(2 * delay)  # to connect
    try:
        far_reader, far_writer = await asyncio.open_connection(host, int(port))
    except OSError:
        writer.close()
        return
    ways = [
        asyncio.create_task(carry(reader, far_writer, up, delay)),
        asyncio.create_task(carry(far_reader, writer, down, delay)),
    ]
    _, pending = await asyncio.wait(ways, return_when=asyncio.FIRST_EXCEPTION)
    for way in pending:
        way.cancel()
    await asyncio.gather(*ways, return_exceptions=True)
    for end in (writer, far_writer):
        end.close()


async def main(arguments):
    bytes_per_second = arguments.limit * 1e6 / 8
    up, down = Line(bytes_per_second), Line(bytes_per_second)
    server = await asyncio.start_server(
        lambda r, w: join(r, w, arguments, up, down), "127.0.0.1", arguments.listen)
    async with server:
        await server.serve_forever()


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--listen", type=int, required=True, help="a port of this machine")
    parser.add_argument("--to", required=True, help="host:port")
    parser.add_argument("--limit", type=float, default=20, help="Mbit/s, each way")
    parser.add_argument("--round-trip", type=float, default=50, help="milliseconds")
    try:
        asyncio.run(main(parser.parse_args()))
    except KeyboardInterrupt:
        pass

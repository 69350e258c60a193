#!/usr/bin/env python3
"""Sends requests (lines in hex, on standard input) to a server, each on a connection of its own:
probe.py PORT FORBIDDEN... Fails if one of the texts comes back on any of them, or if nothing at all
comes back."""

import asyncio
import sys

AT_ONCE = 32
PATIENCE = 1.0  # seconds without a byte, after which no more is expected


async def answers_to(port, request):
    """All that comes until the connection ends or falls silent."""
    reader, writer = await asyncio.open_connection("127.0.0.1", port)
    received = b""
    try:
        writer.write(request)
        while more := await asyncio.wait_for(reader.read(65536), PATIENCE):
            received += more
    except (asyncio.TimeoutError, ConnectionError):
        pass
    finally:
        writer.close()
    return received


async def probe(port, requests, forbidden):
    gate = asyncio.Semaphore(AT_ONCE)

    async def one(request):
        async with gate:
            return request, await answers_to(port, request)

    faults, answered = 0, 0
    for request, received in await asyncio.gather(*map(one, requests)):
        answered += received.startswith(b"HTTP/1.")
        for text in forbidden:
            if text in received:
                faults += 1
                print(f"{request!r}: answered with {text!r}")
    print(f"{len(requests)} requests, {answered} answered, {faults} faults")
    return faults == 0 and len(requests) >= 200 and answered > len(requests) // 2


if __name__ == "__main__":
    lines = [bytes.fromhex(line) for line in sys.stdin]
    texts = [text.encode() for text in sys.argv[2:]]
    sys.exit(0 if asyncio.run(probe(int(sys.argv[1]), lines, texts)) else 1)

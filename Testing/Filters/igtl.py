"""Messages of OpenIGTLink, put together and taken apart by its description."""
import struct

import numpy as np


def checksum(body):
    """CRC-64 of ECMA-182, bit by bit."""
    crc = 0
    for byte in body:
        crc ^= byte << 56
        for _ in range(8):
            crc = (crc << 1 ^ (0x42F0E1EBA9EA3693 if crc >> 63 else 0)) & (1 << 64) - 1
    return crc


def transform_message(device, matrix, change=0):
    """By the protocol's description: header of 58 bytes, then three columns and the origin."""
    body = np.asarray(matrix)[:3].T.astype(">f4").tobytes()
    return struct.pack(">H12s20sQQQ", 1, b"TRANSFORM", device.encode(), 0, len(body), checksum(body) + change) + body


def messages(connection, silence=1.0):
    """Name and body of each message until the other side is silent, for so many seconds."""
    connection.settimeout(silence)

    def read(count):
        data = b""
        while len(data) < count:
            part = connection.recv(count - len(data))
            if not part:
                raise ConnectionError
            data += part
        return data
    try:
        while True:
            _, _, device, _, length, _ = struct.unpack(">H12s20sQQQ", read(58))
            yield device.rstrip(b"\0").decode(), read(length)
    except TimeoutError:
        return

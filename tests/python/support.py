"""What the tests of the Python module share."""
import os
import struct
import subprocess
import tempfile
import unittest
import xml.etree.ElementTree as tree
from pathlib import Path

import numpy

SOURCE = Path(os.environ["OSCULATE_SOURCE"])
PROGRAM = os.environ["OSCULATE_PROGRAM"]
PRESS = SOURCE / "tests/scenes/press.yaml"
COARSE = {
    "bodies.tube.mesh.half_tube.divisions": [7, 6, 1],
    "bodies.contactor.mesh.contactor.divisions": [6, 8, 1],
}
HALF_TUBE = SOURCE / "configs/paper/half_tube.yaml"


class InFolder(unittest.TestCase):
    """With a folder of its own."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def program(self, *words, code=0):
        done = subprocess.run([PROGRAM, *map(str, words)], capture_output=True, text=True, cwd=self.folder)
        self.assertEqual(done.returncode, code, done.stderr)
        return done


def lz4(packed):
    """A block of LZ4, unpacked."""
    data, at = bytearray(), 0

    def length(total):
        nonlocal at
        more = 255 if total == 15 else 0
        while more == 255:
            more = packed[at]
            at += 1
            total += more
        return total

    while True:
        token = packed[at]
        at += 1
        literals = length(token >> 4)
        data += packed[at : at + literals]
        at += literals
        if at >= len(packed):
            return bytes(data)
        back = packed[at] | packed[at + 1] << 8
        at += 2
        for _ in range(length(token & 15) + 4):
            data.append(data[-back])


def frame(path):
    """{name: values} of the point data of a VTK file, with the numbers' own bits."""
    types = {"Float64": "<f8", "Int32": "<i4", "Int64": "<i8", "UInt8": "u1", "Int8": "i1"}
    text = Path(path).read_bytes()
    data = text.index(b"<AppendedData")
    start = text.index(b"_", data + 30) + 1
    root = tree.fromstring(text[:data] + b"</VTKFile>")

    def decoded(at, count):
        """`count` bytes and where the next ones are."""
        return text[start + at : start + at + count], at + count

    def values(array):
        at = int(array.get("offset"))
        blocks = struct.unpack("<Q", decoded(at, 8)[0])[0]
        head, after = decoded(at, 8 * (3 + blocks))
        _, _, *sizes = struct.unpack(f"<{2 + blocks}Q", head[8:])
        packed, unpacked = decoded(after, sum(sizes))[0], b""
        for size in sizes:
            unpacked += lz4(packed[:size])
            packed = packed[size:]
        found = numpy.frombuffer(unpacked, types[array.get("type")])
        components = int(array.get("NumberOfComponents", 1))
        return found if components == 1 else found.reshape(-1, components)

    return {array.get("Name"): values(array) for array in root.find(".//PointData")}

#!/usr/bin/env python3
"""Reads csv/station.motion.csv, run.npz, run.mat and run.mcap of a folder, each by the words of its format, and
compares all numbers.

    tests/export/read_exports.py FOLDER

Exit status 0: all say the same; 1: what differs is printed.
"""

import ast
import csv
import json
import math
import pathlib
import struct
import sys
import zipfile
import zlib

SIGNAL = "station/motion"


def columns_of_csv(file):
    """By name without unit, floats; None where a cell is empty."""
    with open(file, newline="") as text:
        rows = list(csv.reader(text))
    names = [name.split(" [")[0] for name in rows[0]]
    return {name: [float(row[i]) if row[i] else None for row in rows[1:]] for i, name in enumerate(names)}


def array_of_npy(data):
    assert data[:8] == b"\x93NUMPY\x01\x00"
    (length,) = struct.unpack("<H", data[8:10])
    assert (10 + length) % 64 == 0
    head = ast.literal_eval(data[10:10 + length].decode())
    assert not head["fortran_order"]
    letter = {"<f8": "d", "<i8": "q", "|b1": "?"}[head["descr"]]
    count = math.prod(head["shape"])
    return head["shape"], struct.unpack(f"<{count}{letter}", data[10 + length:])


def columns_of_npz(file):
    archive = zipfile.ZipFile(file)
    assert archive.testzip() is None
    described = json.loads(archive.read("signals.json"))["signals"][SIGNAL]
    columns = {"time_s": array_of_npy(archive.read("time_s.npy"))[1]}
    for name, field in described.items():
        shape, values = array_of_npy(archive.read(f"station.motion.{name}.npy"))
        parts = field["components"] or [""]
        assert shape == ((5000, len(parts)) if field["components"] else (5000,)), shape
        for i, part in enumerate(parts):
            columns[f"{name}_{part}" if part else name] = values[i::len(parts)]
    return columns


def element(data, at):
    """Type, content and end of a data element of MATLAB."""
    kind, size = struct.unpack_from("<II", data, at)
    if kind >> 16:
        return kind & 0xFFFF, data[at + 4:at + 4 + (kind >> 16)], at + 8
    return kind, data[at + 8:at + 8 + size], at + 8 + size + (0 if kind == 15 else -size % 8)


def array_of_mat(data):
    """Name and value: a list of columns, a text or a dictionary."""
    _, flags, at = element(data, 0)
    _, dimensions, at = element(data, at)
    rows, width = struct.unpack("<ii", dimensions)
    _, name, at = element(data, at)
    kind = flags[0]
    if kind == 2:
        _, length, at = element(data, at)
        (length,) = struct.unpack("<i", length)
        _, names, at = element(data, at)
        value = {}
        for i in range(len(names) // length):
            key = names[i * length:(i + 1) * length].rstrip(b"\0").decode()
            _, content, at = element(data, at)
            value[key] = array_of_mat(content)[1]
        return name.decode(), value
    stored, content, _ = element(data, at)
    if kind == 4:
        return name.decode(), content.decode("utf-16-le")
    letter, size = {9: ("d", 8), 12: ("q", 8), 2: ("?", 1)}[stored]
    values = struct.unpack(f"<{len(content) // size}{letter}", content)
    return name.decode(), [values[i * rows:(i + 1) * rows] for i in range(width)]


def columns_of_mat(file):
    data = pathlib.Path(file).read_bytes()
    assert data[124:128] == b"\x00\x01IM"
    variables, at = {}, 128
    while at < len(data):
        kind, content, at = element(data, at)
        assert kind == 15
        kind, content, _ = element(zlib.decompress(content), 0)
        assert kind == 14
        name, value = array_of_mat(content)
        variables[name] = value
    columns = {"time_s": variables["time_s"][0]}
    assert variables["units"]["station_motion"]["wrench"] == "N, N, Nm"
    assert variables["frames"]["station_motion"]["inner_force"] == "imu"
    for field, values in variables["station_motion"].items():
        parts = variables["components"]["station_motion"][field].split(", ")
        for part, column in zip(parts, values):
            columns[f"{field}_{part}".replace("inner_", "inner.") if part else field] = column
    return columns


def records(data, at, end):
    while at < end:
        kind, length = struct.unpack_from("<BQ", data, at)
        yield kind, data[at + 9:at + 9 + length], at
        at += 9 + length


def columns_of_mcap(file):
    data = pathlib.Path(file).read_bytes()
    magic = b"\x89MCAP0\r\n"
    assert data.startswith(magic) and data.endswith(magic)
    columns, all_records = {"time_s": []}, list(records(data, 8, len(data) - 8))
    chunks = {at: content for kind, content, at in all_records if kind == 6}
    indexed = [struct.unpack_from("<QQQQ", content) for kind, content, _ in all_records if kind == 8]
    assert [at for _, _, at, _ in indexed] == list(chunks)
    (summary,) = struct.unpack_from("<Q", all_records[-1][1])
    assert all_records[-1][0] == 2 and any(at == summary for _, _, at in all_records)
    for chunk in chunks.values():
        # two times, sizes, checksum, an empty text, the size of the records
        inner = chunk[8 + 8 + 8 + 4 + 4 + 8:]
        for kind, content, _ in records(inner, 0, len(inner)):
            assert kind == 5
            channel, sequence, time, _ = struct.unpack_from("<HIQQ", content)
            assert channel == 1 and sequence == len(columns["time_s"])
            columns["time_s"].append(time / 1e9)
            for name, value in json.loads(content[22:]).items():
                parts = value.items() if isinstance(value, dict) else \
                    enumerate(value, 1) if isinstance(value, list) else [("", value)]
                for part, number in parts:
                    columns.setdefault(f"{name}_{part}" if part != "" else name, []).append(number)
    return columns


def same(a, b):
    def is_none(x):
        return x is None or math.isnan(x)
    return is_none(a) and is_none(b) or a == b


def main():
    folder = pathlib.Path(sys.argv[1])
    expected = columns_of_csv(folder / "csv" / "station.motion.csv")
    problems = []
    for name, columns in [("npz", columns_of_npz(folder / "run.npz")), ("mat", columns_of_mat(folder / "run.mat")),
                          ("mcap", columns_of_mcap(folder / "run.mcap"))]:
        if set(columns) != set(expected):
            problems.append(f"{name}: other columns: {sorted(set(columns) ^ set(expected))}")
            continue
        for column, values in columns.items():
            differing = [k for k, (a, b) in enumerate(zip(values, expected[column])) if not same(a, b)]
            if len(values) != len(expected[column]) or differing:
                problems.append(f"{name}: {column} differs, first in row {differing[:1]}")
    print("\n".join(problems))
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())

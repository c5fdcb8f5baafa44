#!/usr/bin/env python3
"""Reads run.h5 by h5py and run.npz by NumPy, as docs/other_tools.md says, and compares them with csv/station.motion.csv.

    tests/export/read_by_tools.py FOLDER

Exit status 0: all say the same; 1: what differs is printed; 77: h5py or NumPy is not installed.
"""

import csv
import pathlib
import sys

try:
    import h5py
    import numpy
except ImportError:
    sys.exit(77)


def problems_in(folder):
    with open(folder / "csv/station.motion.csv", newline="") as text:
        rows = list(csv.reader(text))
    names = [name.split(" [")[0] for name in rows[0]]
    table = numpy.array([[float(cell) if cell else numpy.nan for cell in row] for row in rows[1:]])

    def column(name):
        return table[:, names.index(name)]

    with h5py.File(folder / "run.h5") as run:
        if not numpy.array_equal(run["time_ns"][:, 0], numpy.rint(1e9 * column("time_s"))):
            yield "the time is not the same in run.h5 and in the table"
        wrench = run["station/motion/wrench"]
        units = wrench.attrs["unit"].decode()
        read = {"wrench_fx": wrench[:, 0], "drives_1": run["station/motion/drives"][:, 0]}
    if not units:
        yield "the wrench has no unit in run.h5"
    for name, values in read.items():
        if not numpy.array_equal(values, column(name), equal_nan=True):
            yield f"'{name}' is not the same in run.h5 and in the table"

    with numpy.load(folder / "run.npz") as archive:
        if not numpy.array_equal(archive["time_s"], column("time_s")):
            yield "the time is not the same in run.npz and in the table"
        wrench = archive["station.motion.wrench"]
        if not numpy.array_equal(wrench[:, 0], column("wrench_fx"), equal_nan=True):
            yield "the wrench is not the same in run.npz and in the table"


if __name__ == "__main__":
    found = list(problems_in(pathlib.Path(sys.argv[1])))
    print("\n".join(found), end="")
    sys.exit(1 if found else 0)

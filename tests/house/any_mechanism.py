"""What is not about one mechanism works for all: no mechanism, size or unit of one outside of its own files."""
import re
import tree

# Files of one mechanism, its presets and readers: they name it.
OWN = re.compile(r"(planar|five_bar|hexapod|bench_robot)")
FOLDERS = ("systems/", "diagrams/", "plant/", "drivers/", "experiments/", "apps/flinch/")

PATTERNS = [
    (r"\b(PlanarRrr|FiveBar|Hexapod)\w*|#include \"[^\"]*/(planar_rrr|five_bar|hexapod)\w*\.h\"", "names a mechanism"),
    (r"\b(Constant|Zero|Ones|setZero|setConstant|setOnes|resize|Random|Unit)\(3\b|\bsize\(\) [=!]= 3\b|\bdof\(\) [=!]= 3\b"
     r"|(leg|drive|joint|i) < 3\b", "counts the coordinates, drives or legs of one mechanism"),
    (r"(pose|velocity|wrench\w*|acceleration)\.(head<2>|tail<1>|z\(\)|\[2\]|\(2\))|(pose|wrench\w*)\[2\]",
     "takes a coordinate for one of a planar pose"),
    (r"\"[^\"]*(m, m, rad|m/s, m/s|m/s\^2, m/s|N, N, Nm)[^\"]*\"|\[(m, m, rad|N, N, Nm|m/s, m/s, rad/s)\]",
     "gives the units of one space"),
]
COMPILED = [(re.compile(pattern), why) for pattern, why in PATTERNS]

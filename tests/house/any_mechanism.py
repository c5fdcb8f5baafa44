"""What is not about one mechanism works for all: no mechanism, size or unit of one outside of its own files."""
import re
import tree

FOLDERS = ("systems/", "diagrams/", "plant/", "drivers/", "experiments/", "apps/flinch/")
OWN = re.compile(r"planar|five_bar|hexapod")  # in the names of a mechanism's own files

# Who must know all mechanisms, or one to fall back upon, and what it does with it.
MAY_NAME = {
    "systems/config/robot_kind.cpp": "the table of kinds",
    "plant/rig_dynamics.cpp": "takes the closed forms where there are some",
    "experiments/scenario/scenario.cpp": "a stand-in where the robot file is no good",
    "systems/robot/configuration_space.h": "says which spaces there are",
    "systems/robot/configuration_space.cpp": "and how each is moved along",
    "systems/robot/legs/platform_moves.h": "which of them the platform of legs moves in",
    "systems/robot/legs/platform_moves.cpp": "by the words of robot files",
}
NAMES = (re.compile(r"\b(PlanarRrr|FiveBar|Hexapod)\w*|/(planar_rrr|five_bar|hexapod)\w*\.h\"|"
                    r"\b(planar_pose|spatial_pose|Kind::plane|Kind::space)\b"),
         "names a mechanism, or the space of one")
RULES = [
    (re.compile(r"\b(Constant|Ones|setConstant|setOnes|Random)\(3\b|\bdof\(\) [=!]= 3\b|\b(leg|drive|joint) < 3\b"),
     "counts the coordinates, drives or legs of one mechanism"),
    (re.compile(r"(pose|velocity|wrench\w*|acceleration)\.(tail<1>|z\(\)|\(2\))|(pose|wrench\w*)\[2\]"),
     "takes a coordinate for one of a planar pose"),
    (re.compile(r"\"[^\"]*(m, m, rad|m/s, m/s|N, N, Nm)[^\"]*\"|\[(m, m, rad|N, N, Nm|m/s, m/s, rad/s)\]"),
     "gives the units of one space"),
]


def problems_of(path):
    rules = RULES if str(path) in MAY_NAME else [NAMES, *RULES]
    for number, text in tree.lines(path):
        for pattern, why in rules:
            if pattern.search(text):
                yield f"{path}:{number}: {text.strip()!r}: {why}"


paths = [path for path in tree.sources() if str(path).startswith(FOLDERS) and not OWN.search(path.name)]
tree.report(len(paths), [problem for path in paths for problem in problems_of(path)])

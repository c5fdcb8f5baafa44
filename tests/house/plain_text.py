"""Words and calls that have no place in the tree, and where they have one after all."""
import re
import tree

LIBRARIES = ("systems/", "diagrams/", "plant/", "experiments/")
CONTROL = ("systems/", "diagrams/")
EVERYWHERE = ("",)

# (pattern, folders where it is forbidden, paths that may, why)
RULES = [
    (r"\b(TODO|FIXME|XXX|HACK)\b", EVERYWHERE, (), "finish it, or write down the limit where users read it"),
    (r"(^|[\s\"'=(])/(home|root|work|tmp|Users)/", EVERYWHERE, ("dev",), "a path of one machine"),
    (r"\b(steady|system|high_resolution)_clock::now\(|\bgettimeofday\(|\bclock_gettime\(", LIBRARIES,
     ("systems/framework/monotonic_clock.cpp", "experiments/live_view/live_view.cpp"), "time comes in through the context"),
    (r"\bstd::random_device\b|\bs?rand\(", LIBRARIES, (), "randomness is state, seeded by the scenario"),
    (r"\bstd::(cout|cerr|clog)\b|\bf?printf\(", LIBRARIES, (), "only programs print"),
    (r"\bgetenv\(", LIBRARIES, (), "settings come in as arguments"),
    (r"\bstd::(thread|mutex|async)\b", CONTROL, ("systems/framework/",), "blocks are pure functions"),
    (r"\busing namespace (?!std::(chrono_)?literals)", LIBRARIES, (), "spell the namespace"),
    (r"[ \t]+$", EVERYWHERE, (), "trailing blanks"),
    (r"\t", EVERYWHERE, (), "tabs"),
]
# Names that the field has a word for: what was said, and what is said now.
RETIRED = {
    "LimitKeeper": "SafetyFilter", "limit_keeper": "safety_filter", "limit keeper": "safety filter",
    "SurpriseTail": "MahalanobisTail", "SurpriseThreshold": "MahalanobisThreshold", "surprise": "Mahalanobis distance",
    "SeenResidual": "ResidualSample", "EstimatorAnswer": "FilterResponse", "AnsweredLoad": "FilteredLoad",
    "LaglessPorts": "LowLatencyPorts", "without_lag": "low_latency", "Tidings": "RunStatus",
    "OrderDesk": "OperatorCommandQueue", "TakenForLane": "ClassificationTimeline", "KeptMotion": "GatedMotion",
    "KeptTorques": "LimitedTorques", "ErrorCourse": "AutoregressiveError", "Specimen": "PerturbedRobot",
    "UnevenTorque": "TorqueRipple", "DriveWish": "RequestedDriveState", "upper_share": "clopper_pearson_upper",
    "upper_rate": "garwood_upper", "EitherDetector": "MaxDetector", "WholeStep": "SingleStep",
    "EachInTurn": "SampleQueue", "BrokenPromises": "QosMismatch", "Insistence": "Requirement",
    "ToldContact": "OracleContact", "StageSite": "StageContext", "DriveMaster": "DriveManager",
    "ImuDoubt": "ImuFault", "CalibrationDoubt": "CalibrationWarning", "CourseMemory": "ContactWindowBuffer",
    "ContactCourse": "ContactWindow", "TurningWave": "TurningHarmonic", "PositionWave": "PositionHarmonic",
    "HalfWay": "MeetingPoint", "ConfigPlace": "SourceLocation", "PlaceLimits": "PoseConstraints",
    "BenchPlant": "RigPlant", "BenchDynamics": "RigDynamics", "ServedBench": "ServedRig",
    r"(?!Stop)[A-Z]\w*Watch\b": "Monitor", "noticed": "detected",
}
RULES += [(rf"\b{old}", EVERYWHERE, ("CHANGELOG.md",), f"the field says {new!r}") for old, new in RETIRED.items()]
THIS_FILE = "tests/house/plain_text.py"
COMPILED = [(re.compile(pattern), folders, allowed, why) for pattern, folders, allowed, why in RULES]


def problems_of(path):
    name = str(path)
    rules = [(pattern, why) for pattern, folders, allowed, why in COMPILED
             if name.startswith(folders) and not (allowed and name.startswith(allowed))]
    for number, text in tree.lines(path):
        for pattern, why in rules:
            if pattern.search(text):
                yield f"{name}:{number}: {text.strip()!r}: {why}"


paths = [path for path in tree.files() if str(path) != THIS_FILE]
tree.report(len(paths), [problem for path in paths for problem in problems_of(path)])

"""A floor includes only floors below it: the dependency arrows of docs/architecture.md."""
import re
import tree

FOUNDATION = ["systems/foundation"]
FRAMEWORK = ["systems/framework", *FOUNDATION]
ROBOT = ["systems/robot", *FOUNDATION]
SIGNALS = ["systems/signals", *FRAMEWORK, *ROBOT]
# Rooms of blocks: what passes between them is a signal, so none includes another.
ROOMS = [f"systems/{room}" for room in ("sensors", "model", "estimators", "contact", "motion", "laws", "safety")]
BLOCKS = [*ROOMS, *SIGNALS]
DIAGRAMS = ["diagrams", *BLOCKS]
# What reads and judges an experiment, whatever stands for the robot.
EXPERIMENT_ROOMS = [f"experiments/{room}" for room in ("scenario", "verdict", "report", "recorded", "live", "robot_check", "graph")]
EXPERIMENTS = [*EXPERIMENT_ROOMS, "systems/config", *DIAGRAMS]

MAY_INCLUDE = {
    "systems/foundation": FOUNDATION,
    "systems/framework": FRAMEWORK,
    "systems/robot": ROBOT,
    "systems/config": ["systems/config", *ROBOT],
    "convert": ["convert", "systems/config", *ROBOT],
    "systems/signals": SIGNALS,
    **{room: [room, *SIGNALS] for room in ROOMS},
    "diagrams": DIAGRAMS,
    "plant": ["plant", *DIAGRAMS],
    "drivers": ["drivers", *DIAGRAMS],
    **{room: EXPERIMENTS for room in EXPERIMENT_ROOMS},
    "identification": ["identification", "calibration", *EXPERIMENTS],
    "calibration": ["calibration", *EXPERIMENTS],
    "import": ["import", *EXPERIMENTS],
    "export": ["export", *FRAMEWORK],
    "experiments/comparison": ["experiments/comparison", "export", *EXPERIMENTS],
    "learning": ["learning", *EXPERIMENTS],
    "experiments/simulated": ["experiments/simulated", "plant", *EXPERIMENTS],
    "experiments/bus": ["experiments/bus", "drivers", "convert", *EXPERIMENTS],
    "experiments/campaign": ["experiments/campaign", "experiments/simulated", "plant", *EXPERIMENTS],
    "experiments/speed_limit": ["experiments/speed_limit", "experiments/campaign", "experiments/simulated", "plant",
                                *EXPERIMENTS],
    "experiments/reproduction": ["experiments/reproduction", "experiments/campaign", "experiments/simulated", "plant",
                                 *EXPERIMENTS],
    "experiments/dataset": ["experiments/dataset", "learning", "experiments/campaign", "experiments/simulated", "plant",
                            *EXPERIMENTS],
    "experiments/ranks": ["experiments/ranks", "experiments/campaign", "experiments/simulated", "plant", *EXPERIMENTS],
    "experiments/live_view": ["experiments/live_view", *EXPERIMENTS],
    "experiments/served": ["experiments/served", "experiments/simulated", "plant", "drivers", *EXPERIMENTS],
}
# Parts of the program that a build without the bus, or without the plant, leaves out: only they may include these.
PARTS = {
    ("drivers", "experiments/bus"): ["apps/flinch/bus", "apps/flinch/served"],
    ("plant", "experiments/simulated", "experiments/campaign", "experiments/reproduction"): ["apps/flinch/simulated", "apps/flinch/served"],
    ("experiments/served",): ["apps/flinch/served"],
    ("experiments/live_view",): ["apps/flinch/live"],
    ("learning",): ["apps/flinch/learning", "apps/flinch/datasets"],
    ("experiments/dataset",): ["apps/flinch/datasets"],
    ("experiments/ranks", "experiments/speed_limit"): ["apps/flinch/simulated"],
    ("identification",): ["apps/flinch/identified"],
}
INCLUDE = re.compile(r'^\s*#\s*include\s*"([^"]+)"')


def within(path, folder):
    return str(path).startswith(folder + "/")


def within_any(path, folders):
    return any(within(path, folder) for folder in folders)


def floor_of(path):
    return next((floor for floor in MAY_INCLUDE if within(path, floor)), None)


def problem_in_program(path, included):
    if within(included, "tests"):
        return "programs do not include tests"
    if within(path, "apps/flinch"):
        for optional, parts in PARTS.items():
            if within_any(included, optional) and not within_any(path, parts):
                return f"only {' and '.join(parts)} may include {included}, which is not in every build"
    return None


def problem_with(path, included):
    if not (tree.ROOT / included).is_file():
        return f'"{included}" is no path from the root of the tree'
    if within(path, "tests"):
        return None
    if within(path, "apps"):
        return problem_in_program(path, included)
    floor = floor_of(path)
    if floor is None:
        return f"no floor owns this file; name its folder in {__file__}"
    if not within_any(included, MAY_INCLUDE[floor]):
        return f"{floor} must not include {included}"
    return None


problems = []
for path in tree.sources():
    for number, text in tree.lines(path):
        match = INCLUDE.match(text)
        problem = problem_with(path, match.group(1)) if match else None
        if problem:
            problems.append(f"{path}:{number}: {problem}")
tree.report(len(tree.sources()), problems)

"""The presets of quick tests leave out what takes long: campaigns, real time, and the installed package.

Usage: quick_tests.py BUILD_FOLDER
"""
import json
import shutil
import subprocess
import sys

import tree

tests, problems = [], []
for preset in ("quick", "asan", "tsan"):
    folder = tree.ROOT / "build" / preset
    if folder.is_dir() and not (folder / "CMakeCache.txt").exists():
        shutil.rmtree(folder)  # ctest makes it for a log, and then lists what is not in there
    listing = subprocess.run(["ctest", "--preset", preset, "--test-dir", sys.argv[1], "--show-only=json-v1"],
                             cwd=tree.ROOT, capture_output=True, text=True, check=True)
    of_preset = json.loads(listing.stdout)["tests"]
    if len(of_preset) < 100:
        problems.append(f"preset {preset}: only {len(of_preset)} tests")
    for test in of_preset:
        labels = {label for field in test["properties"] if field["name"] == "LABELS" for label in field["value"]}
        if labels & {"campaign", "realtime"} or test["name"].startswith("package/"):
            problems.append(f"preset {preset}: {test['name']} is no quick test")
    tests += of_preset
print(f"{len(tests)} tests checked, {len(problems)} problems", *problems[:20], sep="\n")
sys.exit(1 if problems else 0)

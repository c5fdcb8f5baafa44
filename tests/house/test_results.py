"""What ctest's results say: how long the tests of each folder ran, what was left out and why, and what failed.

Usage: test_results.py RESULT.xml...     as 'ctest --output-junit' writes them; of a test that is in repeated-PRESET.xml
                                         too, that result counts, if it comes after ctest-PRESET.xml
"""
import collections
import itertools
import pathlib
import re
import sys

from ctest_results import is_failed, is_skipped, results_of

REASON = re.compile(r"^(not measured: .*|(?:\S+: )?Skipped\n.*)$", re.MULTILINE)


def folder_of(name):
    """systems/robot of systems/robot/Suite.Name, house of house/links."""
    parts = name.split("/")
    if "." not in name:
        return parts[0]
    return "/".join(itertools.takewhile(re.compile(r"[a-z_0-9]+$").match, parts))


def reason_of(test):
    found = REASON.findall(test.findtext("system-out") or "")
    return found[-1].split("\n")[-1] if found else "see the log"


def main():
    failed, repeated = {}, []
    for file in sys.argv[1:]:
        tests = results_of(file)
        print(f"\n{pathlib.Path(file).stem}: seconds from start to end of all tests of a folder, added up")
        seconds, count = collections.Counter(), collections.Counter()
        for name, test in tests.items():
            seconds[folder_of(name)] += float(test.get("time"))
            count[folder_of(name)] += 1
        for folder, sum_of_times in seconds.most_common():
            print(f"  {sum_of_times:8.1f} s  {count[folder]:5d} tests  {folder}")
        preset = pathlib.Path(file).stem.removeprefix("ctest-").removeprefix("repeated-")
        for name, test in tests.items():
            if is_skipped(test):
                print(f"  left out: {name}: {reason_of(test)}")
            if failed.get(f"{preset}: {name}"):
                repeated.append(f"{preset}: {name}")
            failed[f"{preset}: {name}"] = is_failed(test)
    print()
    for name in repeated:
        print(f"FAILED beside others, and was repeated alone: {name}")
    for name in filter(failed.get, failed):
        print(f"FAILED: {name}")


main()

"""The tests that failed while the machine stalled, as a regular expression for 'ctest --tests-regex'.

Usage: stalled_tests.py RESULT.xml [REPEATED.xml]       as 'ctest --output-junit' writes them

Such a test has printed "not measured: " (tests/support/machine_watch.h); each is judged by itself, whatever else has
failed. Exits with 1, and prints nothing, where there is none. With the results of repeating them it exits with 1 where
any test that had failed has not passed now: skipped is not passed, nor is what was not repeated.
"""
import re
import sys

from ctest_results import is_failed, results_of


def main():
    failed = {name: test for name, test in results_of(sys.argv[1]).items() if is_failed(test)}
    if len(sys.argv) > 2:
        repeated = results_of(sys.argv[2])
        sys.exit(not all(name in repeated and repeated[name].get("status") == "run" for name in failed))
    stalled = [name for name, test in failed.items() if "not measured: " in (test.findtext("system-out") or "")]
    if not stalled:
        sys.exit(1)
    names = (re.escape(name).replace("\\-", "-") for name in stalled)
    print(f"^({'|'.join(names)})(  #|$)")


main()

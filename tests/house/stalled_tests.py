"""The tests that failed while the machine stalled, as a regular expression for 'ctest --tests-regex'.

Usage: stalled_tests.py RESULT.xml [REPEATED.xml]       as 'ctest --output-junit' writes them

Such a test has printed "not measured: " (tests/support/machine_watch.h). Exits with 1, and prints nothing, where another
test has failed or could not be run. With the results of repeating them it prints nothing, and exits with 1 where one of
them has not passed: skipped is not passed.
"""
import re
import sys

from ctest_results import is_failed, results_of


def main():
    failed = {name: test for name, test in results_of(sys.argv[1]).items() if is_failed(test)}
    if not failed or not all("not measured: " in (test.findtext("system-out") or "") for test in failed.values()):
        sys.exit(1)
    if len(sys.argv) > 2:
        repeated = results_of(sys.argv[2])
        sys.exit(not all(name in repeated and repeated[name].get("status") == "run" for name in failed))
    names = (re.escape(name).replace("\\-", "-") for name in failed)
    print(f"^({'|'.join(names)})(  #|$)")


main()

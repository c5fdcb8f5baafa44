"""The tests that failed, if they are few, as a regular expression for 'ctest --tests-regex'.

Usage: doubtful_tests.py RESULT.xml [REPEATED.xml]       as 'ctest --output-junit' writes them

Such a test may have measured a busy machine. Exits with 1, and prints nothing, where there is none, or more than the
machine explains. With the results of repeating them it exits with 1 where any test that had failed has not passed now:
skipped is not passed, nor is what was not repeated.
"""
import re
import sys

from ctest_results import is_failed, results_of

MOST = 8


def main():
    failed = [name for name, test in results_of(sys.argv[1]).items() if is_failed(test)]
    if len(sys.argv) > 2:
        repeated = results_of(sys.argv[2])
        sys.exit(not all(name in repeated and repeated[name].get("status") == "run" for name in failed))
    if not failed or len(failed) > MOST:
        sys.exit(1)
    names = (re.escape(name).replace("\\-", "-") for name in failed)
    print(f"^({'|'.join(names)})(  #|$)")


main()

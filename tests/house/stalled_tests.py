"""The tests that failed while the machine stalled, as a regular expression for 'ctest --tests-regex'.

Usage: stalled_tests.py RESULT.xml       as 'ctest --output-junit' writes it

Such a test has printed "not measured: " (tests/support/machine_watch.h). Exits with 1, and prints nothing, where another
test has failed.
"""
import re
import sys
import xml.etree.ElementTree


def main():
    tests = xml.etree.ElementTree.parse(sys.argv[1]).getroot().iter("testcase")
    failed = [test for test in tests if test.get("status") == "fail"]
    if not failed or not all("not measured: " in (test.findtext("system-out") or "") for test in failed):
        sys.exit(1)
    names = (re.escape(test.get("name").split("  #")[0]).replace("\\-", "-") for test in failed)
    print(f"^({'|'.join(names)})(  #|$)")


main()

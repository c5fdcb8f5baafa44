"""What stalled_tests.py says of results that are made up."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

STALLED = pathlib.Path(__file__).parent / "stalled_tests.py"
PASSED, FAILED = '"run"/>', '"fail"><system-out>Failure</system-out></testcase>'
LATE = '"fail"><system-out>Failure\nnot measured: the machine stalled for 12 ms</system-out></testcase>'
SKIPPED = '"notrun"><skipped message="SKIP_REGULAR_EXPRESSION_MATCHED"/></testcase>'
MISSING = '"notrun"><skipped message="Unable to find executable: a"/></testcase>'


def stalled(*results):
    """Exit status and output for files of (name, result)."""
    with tempfile.TemporaryDirectory() as folder:
        files = []
        for tests in results:
            files.append(pathlib.Path(folder) / f"{len(files)}.xml")
            cases = "".join(f'<testcase name="{name}" status={result}' for name, result in tests.items())
            files[-1].write_text(f"<testsuite>{cases}</testsuite>")
        done = subprocess.run([sys.executable, STALLED, *files], capture_output=True, text=True, check=False)
        return done.returncode, done.stdout


class StalledTests(unittest.TestCase):
    def test_only_late_ones_are_repeated(self):
        self.assertEqual(stalled({"a/B.c": LATE, "a/B.d": PASSED, "e": SKIPPED}), (0, "^(a/B\\.c)(  #|$)\n"))
        self.assertEqual(stalled({"P/A.b/0  # GetParam() = x": LATE, "c": LATE}), (0, "^(P/A\\.b/0|c)(  #|$)\n"))

    def test_each_is_judged_by_itself(self):
        for other in (FAILED, MISSING):
            self.assertEqual(stalled({"a": LATE, "b": other}), (0, "^(a)(  #|$)\n"))
            self.assertEqual(stalled({"b": other}), (1, ""))
        self.assertEqual(stalled({"a": PASSED}), (1, ""))

    def test_what_is_repeated_must_pass(self):
        self.assertEqual(stalled({"a": LATE, "b": PASSED}, {"a": PASSED})[0], 0)
        for result in (SKIPPED, FAILED, LATE, MISSING):
            self.assertEqual(stalled({"a": LATE}, {"a": result})[0], 1)
        for other in (LATE, FAILED, MISSING):
            self.assertEqual(stalled({"a": LATE, "b": other}, {"a": PASSED})[0], 1)


unittest.main()

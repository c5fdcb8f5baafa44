"""What doubtful_tests.py says of results that are made up."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

DOUBTFUL = pathlib.Path(__file__).parent / "doubtful_tests.py"
PASSED, FAILED = '"run"/>', '"fail"><system-out>Failure</system-out></testcase>'
SKIPPED = '"notrun"><skipped message="SKIP_REGULAR_EXPRESSION_MATCHED"/></testcase>'
MISSING = '"notrun"><skipped message="Unable to find executable: a"/></testcase>'


def doubtful(*results):
    """Exit status and output for files of (name, result)."""
    with tempfile.TemporaryDirectory() as folder:
        files = []
        for tests in results:
            files.append(pathlib.Path(folder) / f"{len(files)}.xml")
            cases = "".join(f'<testcase name="{name}" status={result}' for name, result in tests.items())
            files[-1].write_text(f"<testsuite>{cases}</testsuite>")
        done = subprocess.run([sys.executable, DOUBTFUL, *files], capture_output=True, text=True, check=False)
        return done.returncode, done.stdout


class DoubtfulTests(unittest.TestCase):
    def test_only_failed_ones_are_repeated(self):
        self.assertEqual(doubtful({"a/B.c": FAILED, "a/B.d": PASSED, "e": SKIPPED}), (0, "^(a/B\\.c)(  #|$)\n"))
        self.assertEqual(doubtful({"P/A.b/0  # GetParam() = x": FAILED, "c": MISSING}), (0, "^(P/A\\.b/0|c)(  #|$)\n"))
        self.assertEqual(doubtful({"a": PASSED}), (1, ""))

    def test_many_are_not_the_machine(self):
        self.assertEqual(doubtful({f"a{i}": FAILED for i in range(8)})[0], 0)
        self.assertEqual(doubtful({f"a{i}": FAILED for i in range(9)}), (1, ""))

    def test_what_is_repeated_must_pass(self):
        self.assertEqual(doubtful({"a": FAILED, "b": PASSED}, {"a": PASSED})[0], 0)
        for result in (SKIPPED, FAILED, MISSING):
            self.assertEqual(doubtful({"a": FAILED}, {"a": result})[0], 1)
        for other in (FAILED, MISSING):
            self.assertEqual(doubtful({"a": FAILED, "b": other}, {"a": PASSED})[0], 1)


unittest.main()

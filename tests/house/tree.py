"""The files of the tree that the house rules look at, and how a rule reports."""
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
INCLUDE = re.compile(r'^\s*#\s*include\s*["<]([^">]+)[">]', re.MULTILINE)


def files(*suffixes):
    """Paths relative to the root: tracked files and new ones that git does not ignore."""
    listing = subprocess.run(
        ["git", "ls-files", "--cached", "--others", "--exclude-standard"],
        cwd=ROOT, capture_output=True, text=True)
    if listing.returncode == 0:
        paths = [pathlib.PurePath(line) for line in listing.stdout.splitlines()]
    else:  # an unpacked archive
        paths = [path.relative_to(ROOT) for path in ROOT.rglob("*")
                 if not {"build", "out", ".git"} & set(path.relative_to(ROOT).parts)]
    return sorted(path for path in paths
                  if (path.suffix in suffixes or not suffixes) and (ROOT / path).is_file())


def sources():
    return files(".h", ".cpp")


def lines(path):
    """(number, text) of each line; nothing for a file that is not text."""
    try:
        return list(enumerate((ROOT / path).read_text(encoding="utf-8").splitlines(), start=1))
    except UnicodeDecodeError:
        return []


def report(checked, problems):
    """Prints the problems and ends the program: 0 if there are none. Checking nothing is a problem too."""
    for problem in problems:
        print(problem)
    print(f"{checked} files checked, {len(problems)} problems")
    sys.exit(1 if problems or not checked else 0)

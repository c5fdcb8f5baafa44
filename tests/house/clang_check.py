"""clang's opinion of every source: its warnings on all of them, the rules of .clang-tidy on all but the tests.

Usage: clang_check.py BUILD_DIR [FILE...]     BUILD_DIR: configured with the preset clang

Most of the time goes into the headers that a source includes, so sources that can stand in one translation unit are
looked at together; where that cannot be compiled, or is not clean, in smaller parts. What was found clean is remembered
in BUILD_DIR by the hash of its text, of the headers of the tree that it includes, and of how it is compiled, and not
looked at again; headers of the system count as unchanged.
"""
import concurrent.futures
import functools
import hashlib
import json
import os
import pathlib
import shlex
import subprocess
import sys
import tree

sys.path.append(str(tree.ROOT / "cmake"))
from bundles import clash, own_names

COMPILER_ONLY = ("tests/",)
# What tests/CMakeLists.txt precompiles stands before every source of a folder of tests, alone or beside others; a program
# that is not one of them sees no Eigen.
PRECOMPILED = ("-include", "gmock/gmock.h", "-include", "gtest/gtest.h", "-include", "Eigen/Dense")
LARGEST_BUNDLE = 16
RULES = (tree.ROOT / ".clang-tidy").read_text() + subprocess.check_output(["clang++", "--version"], text=True)


class Source:
    def __init__(self, path, entry):
        self.path = path
        self.file = entry["file"]
        self.folder = entry["directory"]
        words = shlex.split(entry["command"])
        start = next(i for i, word in enumerate(words) if word.endswith(("clang++", "clang++-14")))
        self.compiler = [word for word in words[start:words.index("-o")] if word != "-c"]
        self.by_compiler_only = path.startswith(COMPILER_ONLY)
        if self.by_compiler_only and any("eigen3" in word for word in self.compiler):
            self.compiler += PRECOMPILED
        self.own_names = {}
        self.mark = None

    def read(self, build_dir):
        """Learns its own names, and what all that the outcome depends on hashes to, comments (NOLINT) included."""
        file = pathlib.Path(self.file)
        text = text_of(file)
        self.own_names = own_names(text)
        folders = tuple(pathlib.Path(self.folder, word[2:]) for word in self.compiler if word.startswith("-I"))
        mark = hashlib.sha256(repr((RULES, self.compiler, self.by_compiler_only)).encode())
        for part in with_headers(file, folders):
            mark.update(text_of(part).encode())
        self.mark = build_dir / "clean" / mark.hexdigest()

    def is_clean(self):
        return self.mark.exists()


@functools.cache
def text_of(file):
    return file.read_text(errors="replace")


@functools.cache
def included_by(file, folders):
    """The headers that a file includes from its own folder or these; those of the system are elsewhere."""
    found = (next(filter(pathlib.Path.is_file, (folder / name for folder in (file.parent, *folders))), None)
             for name in tree.INCLUDE.findall(text_of(file)))
    return [header for header in found if header is not None]


def with_headers(source, folders):
    """The source and all that it includes, in one order."""
    found, waiting = {source}, [source]
    while waiting:
        new = set(included_by(waiting.pop(), folders)) - found
        found |= new
        waiting += new
    return sorted(found)


def run(command, folder):
    return subprocess.run(command, capture_output=True, text=True, errors="replace", cwd=folder)


def check(source, file, *more_flags):
    """Checks a file, which may be a bundle, as this source is compiled."""
    if source.by_compiler_only:
        return run([*source.compiler, *more_flags, "-fsyntax-only", file], source.folder)
    return run(["clang-tidy", "--quiet", file, "--", *source.compiler[1:], *more_flags], source.folder)


def bundles_of(sources):
    """Sources that are compiled alike and have no name of their own in common."""
    bundles = []
    for source in sources:
        fitting = (bundle for bundle in bundles
                   if bundle[0].compiler == source.compiler and bundle[0].by_compiler_only == source.by_compiler_only
                   and len(bundle) < LARGEST_BUNDLE
                   and not any(clash(source.own_names, other.own_names) for other in bundle))
        bundle = next(fitting, None)
        if bundle is None:
            bundles.append([source])
        else:
            bundle.append(source)
    return bundles


def problems_of(bundle, build_dir):
    """[(source, what is wrong with it)] of those that are not clean."""
    if len(bundle) == 1:
        result = check(bundle[0], bundle[0].file)
        if result.returncode != 0:
            return [(bundle[0], result.stdout + result.stderr)]
    else:
        together = build_dir / "bundles" / (bundle[0].path.replace("/", "_") + f"_{len(bundle)}.cpp")
        together.parent.mkdir(exist_ok=True)
        together.write_text("".join(f'#include "{source.file}"\n' for source in bundle))
        # A name in one source does not shadow that of another.
        if check(bundle[0], str(together), "-Wno-shadow").returncode != 0:
            half = len(bundle) // 2
            return problems_of(bundle[:half], build_dir) + problems_of(bundle[half:], build_dir)
    remember(bundle)
    return []


def remember(sources):
    for source in sources:
        source.mark.parent.mkdir(exist_ok=True)
        source.mark.touch()


def sources_of(build_dir, wanted):
    found = {}
    for entry in json.loads((build_dir / "compile_commands.json").read_text()):
        file = pathlib.Path(entry["file"])
        if file.is_relative_to(tree.ROOT) and not file.is_relative_to(build_dir):
            path = str(file.relative_to(tree.ROOT))
            if not wanted or path in wanted:
                found[path] = Source(path, entry)
    return [found[path] for path in sorted(found)]


def main():
    build_dir = pathlib.Path(sys.argv[1]).resolve()
    wanted = {str(pathlib.Path(file).resolve().relative_to(tree.ROOT)) for file in sys.argv[2:]}
    sources = sources_of(build_dir, wanted)
    for source in sources:
        source.read(build_dir)
    problems = []
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        bundles = bundles_of([source for source in sources if not source.is_clean()])
        bundles.sort(key=len, reverse=True)
        for found in pool.map(lambda bundle: problems_of(bundle, build_dir), bundles):
            for source, what in found:
                print(what, flush=True)
                problems.append(f"{source.path}: see above")
    tree.report(len(sources), problems)


main()

"""clang's opinion of every source: its warnings on all of them, the rules of .clang-tidy on all but the tests.

Usage: clang_check.py BUILD_DIR [FILE...]     BUILD_DIR: configured with the preset clang

Most of the time goes into the headers that a source includes, so sources that can stand in one translation unit are
looked at together, with the flags of all of them; where that cannot be compiled, or is not clean, in smaller parts, at
last alone with their own flags. What was found clean is remembered in BUILD_DIR by the hash of its preprocessed text
and not looked at again.
"""
import concurrent.futures
import hashlib
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys
import tree

COMPILER_ONLY = ("tests/",)
# What tests/CMakeLists.txt precompiles stands before every source of a folder of tests, alone or beside others; a program
# that is not one of them sees no Eigen.
PRECOMPILED = ("-include", "gmock/gmock.h", "-include", "gtest/gtest.h", "-include", "Eigen/Dense")
LARGEST_BUNDLE = 40
LOCATED_ERROR = re.compile(r"^(/[^:\n]+):\d+:\d+: (?:fatal )?error: ", re.MULTILINE)
FLAG = re.compile(r"^-.*(?:\n[^-].*)?$", re.MULTILINE)
PARAMETERS = re.compile(r"\([^()]*")
PARAMETER_NAME = re.compile(r" ?\b\w+(?=,|$)")
USING = re.compile(r"(?:using|namespace) (?:::)?(?:\w+::)*(\w+)(?: =.*)?;")


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
        # Those with a value of their own, as -isystem, together with it.
        self.flags = [tuple(flag.split("\n")) for flag in FLAG.findall("\n".join(self.compiler[1:]))]
        self.definitions = dict(flag[0].split("=", 1) for flag in self.flags if "=" in flag[0])
        self.own_names = {}
        self.mark = None

    def read(self, build_dir):
        """Learns what all that the outcome depends on hashes to: the text with its comments (NOLINT), rules, flags."""
        text = pathlib.Path(self.file).read_text(errors="replace")
        self.own_names = own_names(text)
        preprocessed = run([*self.compiler, "-E", "-C", self.file], self.folder)
        if preprocessed.returncode == 0:
            rules = (tree.ROOT / ".clang-tidy").read_text() + repr((self.compiler, self.by_compiler_only))
            mark = hashlib.sha256((preprocessed.stdout + rules).encode()).hexdigest()
            self.mark = build_dir / "clean" / mark
        return self

    def is_clean(self):
        return self.mark is not None and self.mark.exists()


def own_names(text):
    """What is defined outside of classes and functions: of functions the types of parameters, of names that only stand for
    others what they stand for, of anything else None."""
    names = {}
    for line in text.split("\n"):
        using = USING.match(line)
        head = re.split(r"[({=;]| : ", line.replace(" final", ""))[0]
        name = re.search(r"(?<!::)\b(\w+) ?$", head)
        if using:
            names[using.group(1)] = line.replace(" ::", " ")
        elif line[:1].isalpha() and name and not head.isupper() and not head.startswith("namespace"):
            parameters = PARAMETERS.match(line[len(head):]) if name.group(1) != "main" else None
            names[name.group(1)] = PARAMETER_NAME.sub("", parameters.group()) if parameters else None
    return names


def clash(one, other):
    """Whether they define a name twice. Functions of other parameters are others, and names for the same are one."""
    def clashes(name):
        is_same = one[name] == other[name]
        if one[name] is None or other[name] is None:
            return True
        if one[name].startswith("(") and other[name].startswith("("):
            return is_same
        return not is_same
    return any(clashes(name) for name in one.keys() & other.keys())


def run(command, folder):
    return subprocess.run(command, capture_output=True, text=True, errors="replace", cwd=folder)


def check(source, file, flags):
    """Checks a file, which may be a bundle that this source is in."""
    if source.by_compiler_only:
        return run([source.compiler[0], *flags, "-fsyntax-only", file], source.folder)
    return run(["clang-tidy", "--quiet", file, "--", *flags], source.folder)


def flags_of_all(bundle):
    """Each flag once."""
    flags = {}
    for source in bundle:
        flags.update(dict.fromkeys(source.flags))
    return [word for flag in flags for word in flag]


def definitions_clash(one, other):
    return any(other.definitions.get(name, value) != value for name, value in one.definitions.items())


def bundles_of(sources):
    """Sources that are looked at alike, and have no name of their own in common."""
    bundles = []
    for source in sources:
        fitting = (bundle for bundle in bundles
                   if bundle[0].by_compiler_only == source.by_compiler_only and len(bundle) < LARGEST_BUNDLE
                   and not any(definitions_clash(source, other) or clash(source.own_names, other.own_names)
                               for other in bundle))
        bundle = next(fitting, None)
        if bundle is None:
            bundles.append([source])
        else:
            bundle.append(source)
    return bundles


def problems_of(bundle, build_dir):
    """[(source, what is wrong with it)] of those that are not clean."""
    if len(bundle) == 1:
        result = check(bundle[0], bundle[0].file, flags_of_all(bundle))
        if result.returncode != 0:
            return [(bundle[0], result.stdout + result.stderr)]
    else:
        together = build_dir / "bundles" / (bundle[0].path.replace("/", "_") + f"_{len(bundle)}.cpp")
        together.parent.mkdir(exist_ok=True)
        together.write_text("".join(f'#include "{source.file}"\n' for source in bundle))
        # A name in one source does not shadow that of another.
        result = check(bundle[0], str(together), [*flags_of_all(bundle), "-Wno-shadow"])
        if result.returncode != 0:
            return [problem for part in parts_of(bundle, result.stdout + result.stderr)
                    for problem in problems_of(part, build_dir)]
    remember(bundle)
    return []


def parts_of(bundle, errors):
    """Those in which errors stand, each alone, and the others; halves where errors stand nowhere, or everywhere."""
    named = set(LOCATED_ERROR.findall(errors))
    others = [source for source in bundle if source.file not in named]
    if others and len(others) < len(bundle):
        return [*([source] for source in bundle if source.file in named), others]
    half = len(bundle) // 2
    return [bundle[:half], bundle[half:]]


def remember(sources):
    for source in sources:
        if source.mark is not None:
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
    problems = []
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        list(pool.map(lambda source: source.read(build_dir), sources))
        bundles = bundles_of([source for source in sources if not source.is_clean()])
        bundles.sort(key=len, reverse=True)
        for found in pool.map(lambda bundle: problems_of(bundle, build_dir), bundles):
            for source, what in found:
                print(what, flush=True)
                problems.append(f"{source.path}: see above")
    tree.report(len(sources), problems)


main()

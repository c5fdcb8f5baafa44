"""clang's opinion of every source: its warnings on all of them, the rules of .clang-tidy on all but the tests.

Usage: clang_check.py BUILD_DIR [FILE...]     BUILD_DIR: configured with the preset clang

What was found clean is remembered in BUILD_DIR by the hash of its preprocessed text and not looked at again.
"""
import concurrent.futures
import hashlib
import json
import os
import pathlib
import shlex
import subprocess
import sys
import tree

COMPILER_ONLY = ("tests/",)


def run(command, **options):
    return subprocess.run(command, capture_output=True, text=True, errors="replace", **options)


def compile_command(entry):
    """The compiler and its flags, without what makes an object file of it."""
    words = shlex.split(entry["command"])
    start = next(i for i, word in enumerate(words) if word.endswith(("clang++", "clang++-14")))
    words = words[start:]
    end = words.index("-o")
    return [word for word in words[:end] if word != "-c"]


def check_of(path, entry, build_dir):
    if path.startswith(COMPILER_ONLY):
        return [*compile_command(entry), "-fsyntax-only", entry["file"]]
    return ["clang-tidy", "--quiet", "-p", str(build_dir), entry["file"]]  # the compiler's warnings are among them


def fingerprint(check, entry):
    """Hash of all that the outcome depends on: the text with its comments (NOLINT), the rules, the flags."""
    compiler = compile_command(entry)
    preprocessed = run([*compiler, "-E", "-C", entry["file"]], cwd=entry["directory"])
    rules = (tree.ROOT / ".clang-tidy").read_text()
    text = preprocessed.stdout + rules + repr(check)
    return hashlib.sha256(text.encode()).hexdigest() if preprocessed.returncode == 0 else None


def problems_of(path, entry, build_dir):
    check = check_of(path, entry, build_dir)
    mark = fingerprint(check, entry)
    clean = build_dir / "clean" / str(mark)
    if mark and clean.exists():
        return ""
    result = run(check, cwd=entry["directory"])
    if result.returncode != 0:
        return result.stdout + result.stderr
    clean.parent.mkdir(exist_ok=True)
    clean.touch()
    return ""


def main():
    build_dir = pathlib.Path(sys.argv[1]).resolve()
    wanted = {str(pathlib.Path(file).resolve().relative_to(tree.ROOT)) for file in sys.argv[2:]}
    entries = {}
    for entry in json.loads((build_dir / "compile_commands.json").read_text()):
        file = pathlib.Path(entry["file"])
        if file.is_relative_to(tree.ROOT) and not file.is_relative_to(build_dir):
            path = str(file.relative_to(tree.ROOT))
            if not wanted or path in wanted:
                entries[path] = entry
    problems = []
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        outputs = pool.map(lambda item: problems_of(*item, build_dir), sorted(entries.items()))
        for path, output in zip(sorted(entries), outputs):
            if output:
                print(output, flush=True)
                problems.append(f"{path}: see above")
    tree.report(len(entries), problems)


main()

"""Runs the commands of the documents: every fenced block marked `sh`, page by page, in the root of the tree. A block
marked `text prints` behind them holds lines that the last one has printed: words as they stand, numbers to 2 %.

Usage: run_documents.py [FILE.md...]     without files: README.md and docs/
"""
import re
import subprocess
import sys
import textwrap
import tree

BLOCK = re.compile(r"^( *)```(sh|text prints)\n(.*?)^\1```", re.MULTILINE | re.DOTALL)  # indented in lists
NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e-?\d+)?")
LARGEST_DIFFERENCE = 0.02


def documents():
    if len(sys.argv) > 1:
        return sys.argv[1:]
    return [path for path in tree.files(".md") if str(path) == "README.md" or path.parts[0] == "docs"]


def run(block):
    """Whether it succeeded, and what it printed."""
    lines = []
    with subprocess.Popen(["bash", "-euo", "pipefail", "-c", block], cwd=tree.ROOT, text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT) as program:
        for line in program.stdout:
            print(line, end="", flush=True)
            lines.append(line)
    return program.returncode == 0, lines


def is_alike(documented, printed):
    if NUMBER.sub("#", " ".join(documented.split())) != NUMBER.sub("#", " ".join(printed.split())):
        return False
    pairs = zip(map(float, NUMBER.findall(documented)), map(float, NUMBER.findall(printed)))
    return all(abs(one - other) <= LARGEST_DIFFERENCE * max(abs(one), abs(other)) for one, other in pairs)


def main():
    problems = []
    for path in documents():
        printed = []
        for _, kind, indented in BLOCK.findall((tree.ROOT / path).read_text()):
            block = textwrap.dedent(indented)
            if kind == "sh":
                print(f"--- {path}\n{block}", flush=True)
                good, printed = run(block)
                if not good:
                    problems.append(f"{path}: this failed:\n{block}")
                continue
            for line in block.splitlines():
                if line.strip() and not any(is_alike(line, other) for other in printed):
                    problems.append(f"{path}: is not printed any more:\n{line}")
    tree.report(len(documents()) or 1, problems)


if __name__ == "__main__":
    main()

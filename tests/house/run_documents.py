"""Runs the commands of the documents: every fenced block marked `sh`, page by page, in the root of the tree.

Usage: run_documents.py [FILE.md...]     without files: README.md and docs/
"""
import re
import subprocess
import sys
import textwrap
import tree

BLOCK = re.compile(r"^( *)```sh\n(.*?)^\1```", re.MULTILINE | re.DOTALL)  # indented in lists


def documents():
    if len(sys.argv) > 1:
        return sys.argv[1:]
    return [path for path in tree.files(".md") if str(path) == "README.md" or path.parts[0] == "docs"]


problems = []
for path in documents():
    for _, indented in BLOCK.findall((tree.ROOT / path).read_text()):
        block = textwrap.dedent(indented)
        print(f"--- {path}\n{block}", flush=True)
        if subprocess.run(["bash", "-euo", "pipefail", "-c", block], cwd=tree.ROOT).returncode != 0:
            problems.append(f"{path}: this failed:\n{block}")
tree.report(len(documents()) or 1, problems)

"""Tests mirror the tree: a folder of tests has a folder that it tests, and nothing is without a test.

A source of a library counts as tested when a test includes its header; that it is tested well is for people to see.
"""
import re
import tree

MIRRORED = ("systems", "diagrams", "plant", "apps")
INCLUDE = re.compile(r'^#include "([^"]+)"')

sources = tree.sources()
tests = [path for path in sources if path.parts[0] == "tests"]
included = {match.group(1) for test in tests for _, text in tree.lines(test) if (match := INCLUDE.match(text))}

problems = [f"{test}: there is no folder {'/'.join(test.parts[1:-1])} to test"
            for test in tests if test.parts[1] in MIRRORED and not tree.ROOT.joinpath(*test.parts[1:-1]).is_dir()]
problems += [f"{source}: no test includes {source.with_suffix('.h')}"
             for source in sources
             if source.parts[0] in MIRRORED and source.suffix == ".cpp"
             and (tree.ROOT / source.with_suffix(".h")).exists()
             and str(source.with_suffix(".h")) not in included]
tree.report(len(sources), problems)

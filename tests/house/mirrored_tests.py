"""Tests mirror the tree: a folder of tests has a folder that it tests, and no source is without a test.

A source counts as tested when some test includes its header, or one whose implementation does, and so on; that it is
tested well is for people to see.
"""
import re
import tree

LIBRARIES = ("systems", "diagrams", "plant", "learning", "identification", "experiments", "export", "import", "convert")
INCLUDE = re.compile(r'^#include "([^"]+)"')

sources = tree.sources()
known = {str(path) for path in sources}
includes = {str(path): {match.group(1) for _, text in tree.lines(path) if (match := INCLUDE.match(text))} & known
            for path in sources}

tests = [path for path in sources if path.parts[0] == "tests"]
reached = set()
to_visit = [str(test) for test in tests]
while to_visit:
    header = to_visit.pop()
    if header not in reached:
        reached.add(header)
        to_visit += includes[header] | includes.get(header.removesuffix(".h") + ".cpp", set())

problems = [f"{test}: there is no folder {'/'.join(test.parts[1:-1])} to test"
            for test in tests
            if test.parts[1] in LIBRARIES and not tree.ROOT.joinpath(*test.parts[1:-1]).is_dir()]
problems += [f"{source}: no test includes {source.with_suffix('.h')}"
             for source in sources
             if source.parts[0] in LIBRARIES and source.suffix == ".cpp"
             and str(source.with_suffix(".h")) in known - reached]
tree.report(len(sources), problems)

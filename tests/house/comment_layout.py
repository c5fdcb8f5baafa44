"""Comments that clang-format leaves alone: it reflows none, for they hold examples and equations line by line.

So lines may not grow too long, and no comment may push the declaration that it follows into two lines.
"""
import re
import tree

LONGEST = 110
OPEN_DECLARATION = re.compile(r"^\s*(?!return\b|else\b|do\b|public:|private:)[\w:]+(<.*>)?( \w+ =)?$")
COMMENTED_REST = re.compile(r"^\s+[^/\s][^/]*;\s+//")


def problems_of(path):
    before = ""
    for number, text in tree.lines(path):
        if len(text) > LONGEST:
            yield f"{path}:{number}: {len(text)} characters, and {LONGEST} fit"
        if OPEN_DECLARATION.match(before) and COMMENTED_REST.match(text):
            yield f"{path}:{number}: its comment splits the declaration; put it above"
        before = text


paths = tree.sources()
tree.report(len(paths), [problem for path in paths for problem in problems_of(path)])

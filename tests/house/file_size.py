"""One noun a file: none is longer than a reader can hold."""
import tree

MOST_LINES = 450

problems = [f"{path}: {len(tree.lines(path))} lines, at most {MOST_LINES}"
            for path in tree.sources() if len(tree.lines(path)) > MOST_LINES]
tree.report(len(tree.sources()), problems)

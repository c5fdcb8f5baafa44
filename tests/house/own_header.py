"""A source includes its own header first, so that compiling it shows that the header needs no other before it."""
import tree

sources = [path for path in tree.sources() if path.suffix == ".cpp" and (tree.ROOT / path).with_suffix(".h").is_file()]
problems = []
for path in sources:
    first = next((match.group(1) for _, text in tree.lines(path) if (match := tree.INCLUDE.match(text))), None)
    if first != str(path.with_suffix(".h")):
        problems.append(f"{path}: the first include is {first}, not its own header")
tree.report(len(sources), problems)

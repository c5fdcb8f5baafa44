"""The reference of blocks (docs/site/blocks.py) finds every block and says what flows through its ports."""
import re
import sys
import tree

sys.path.insert(0, str(tree.ROOT / "docs/site"))
import blocks  # noqa: E402

told = {name: (comment, inputs, outputs) for found in blocks.blocks().values() for name, comment, _, inputs, outputs in found}
problems = []
for path in tree.sources():
    if not str(path).startswith(tuple(blocks.ROOMS)):
        continue
    for _, text in tree.lines(path):
        declared = re.match(r"(?:class|struct) (\w+)(?: final)? : public (?:System|MotionModel)\b", text)
        if declared and declared[1] not in {*told, "Diagram"} and path.suffix == ".h":
            problems.append(f"{path}: {declared[1]} is not in the reference of blocks")
problems += [f"{name} is told without ports or without a comment" for name, (comment, inputs, outputs) in told.items()
             if not comment or not (inputs or outputs)]
tree.report(len(told), problems)

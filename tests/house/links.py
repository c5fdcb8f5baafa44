"""Every relative link in the documents leads to a file, and every heading that it names is there."""
import re
import tree

LINK = re.compile(r"\]\(([^)#\s]*)(?:#([^)\s]+))?\)")


def anchors(path):
    headings = [text for _, text in tree.lines(path) if text.startswith("#")]
    words = [re.sub(r"[^\w\- ]", "", heading.lstrip("#").strip().lower()) for heading in headings]
    return {word.replace(" ", "-") for word in words}


def problem_with(path, target, anchor):
    if "://" in target or target.startswith("mailto:"):
        return None
    file = (tree.ROOT / path).parent / target if target else tree.ROOT / path
    if not file.exists():
        return f"no such file: {target}"
    if anchor and file.suffix == ".md" and anchor not in anchors(file):
        return f"no such heading: {target}#{anchor}"
    return None


problems = []
documents = tree.files(".md")
for path in documents:
    for number, text in tree.lines(path):
        for target, anchor in LINK.findall(text):
            problem = problem_with(path, target, anchor)
            if problem:
                problems.append(f"{path}:{number}: {problem}")
tree.report(len(documents) or 1, problems)

"""Which sources can stand in one translation unit: those that have no name of their own in common.

Usage: bundles.py LARGEST FILE...     prints 'NUMBER;FILE' for each file: those of one number may stand together.
Of several names that one line declares only the last before its first '=' is seen: give each a line of its own.
"""
import pathlib
import re
import sys

ANONYMOUS = re.compile(r"^namespace \{$(.*?)^\}  // namespace$", re.DOTALL | re.MULTILINE)
USING = re.compile(r"(?:using|namespace) (?:\w+::)*(\w+)(?: =.*)?;")


def own_names(text):
    """What a source defines in anonymous namespaces; for names that only stand for others, what they stand for."""
    names = {}
    own = "".join(ANONYMOUS.findall(text)) + "".join(re.findall(r"^int main\(", text, re.M))
    for line in own.split("\n"):
        using = USING.match(line)
        head = re.split(r"[({=;]| : ", line.replace(" final", ""))[0]
        name = re.search(r"(\w+) ?$", head)
        if using:
            names[using.group(1)] = line
        elif line[:1].isalpha() and name and not head.isupper():
            names[name.group(1)] = None
    return names


def clash(one, other):
    return any(one[name] is None or one[name] != other[name] for name in one.keys() & other.keys())


def main():
    largest = int(sys.argv[1])
    bundles = []
    for file in sys.argv[2:]:
        names = own_names(pathlib.Path(file).read_text(errors="replace"))
        number = next((i for i, bundle in enumerate(bundles)
                       if len(bundle) < largest and not any(clash(names, other) for other in bundle)), len(bundles))
        if number == len(bundles):
            bundles.append([])
        bundles[number].append(names)
        print(f"{number};{file}")


if __name__ == "__main__":
    main()

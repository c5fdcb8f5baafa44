"""Which sources can stand in one translation unit: those that have no name of their own in common.

Usage: bundles.py LARGEST FILE...             prints 'NUMBER;FILE' for each file: those of one number may stand together.
       bundles.py --tests LARGEST FILE...     the same, as --write makes one source of them.
       bundles.py --write OUTPUT FILE...      one source of several, for compilers that report places in those.

Of several names that one line declares only the last before its first '=' is seen: give each a line of its own.
A test stands in an anonymous namespace whole, from which nothing of it is used: --write gives each such namespace a name
inside, so that tests have no names in common.
"""
import pathlib
import re
import sys

ANONYMOUS = re.compile(r"^namespace \{$(.*?)^\}  // namespace$", re.DOTALL | re.MULTILINE)
USING = re.compile(r"(?:using|namespace) (?:\w+::)*(\w+)(?: =.*)?;")
WHOLE = re.compile(r"^namespace \{$[^\0]*^\}  // namespace\n+\}  // namespace [\w:]+\s*(?:#endif\s*)?\Z", re.MULTILINE)


def text_of(file):
    return pathlib.Path(file).read_text(errors="replace")


def is_whole(text):
    return len(ANONYMOUS.findall(text)) == 1 and WHOLE.search(text) is not None


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


def print_bundles(largest, files, tests):
    bundles = []
    for file in files:
        text = text_of(file)
        names = {} if tests and is_whole(text) else own_names(text)
        number = next((i for i, bundle in enumerate(bundles)
                       if len(bundle) < largest and not any(clash(names, other) for other in bundle)), len(bundles))
        if number == len(bundles):
            bundles.append([])
        bundles[number].append(names)
        print(f"{number};{file}")


def write_bundle(output, files):
    parts = []
    for number, file in enumerate(files):
        text = text_of(file)
        if is_whole(text):
            text = text.replace("\nnamespace {\n", f"\nnamespace {{ namespace source_{number} {{\n")
            text = text.replace("\n}  // namespace\n", "\n}}  // namespace\n")
        parts.append(f'#line 1 "{file}"\n{text}')
    pathlib.Path(output).write_text("".join(parts))


def main():
    first, *files = sys.argv[1:]
    if first == "--write":
        write_bundle(files[0], files[1:])
    elif first == "--tests":
        print_bundles(int(files[0]), files[1:], tests=True)
    else:
        print_bundles(int(first), files, tests=False)


if __name__ == "__main__":
    main()

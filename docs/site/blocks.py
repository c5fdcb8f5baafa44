"""The reference of blocks, out of their headers: what each does, its ports, and what flows through them."""
import html
import pathlib
import re

ROOT = pathlib.Path(__file__).resolve().parents[2]
ROOMS = {"systems/sensors": "Sensors", "systems/model": "Model of the robot", "systems/estimators": "Estimators",
         "systems/contact": "Contact", "systems/motion": "Motion", "systems/laws": "Control laws",
         "systems/safety": "Safety", "diagrams": "Diagrams", "systems/framework": "Framework", "plant": "Simulated robot",
         "drivers": "Drivers"}
COMMENT = r"((?:^[ \t]*///[^\n]*\n)+)"
BLOCK = re.compile(COMMENT + r"(?:template <[^\n]*>\n)?(?:class|struct) (\w+)(?: final)? : public (System|MotionModel) \{(.*?)^\};",
                   re.S | re.M)
PORT = re.compile(r"\b(Input|Output)Port<((?:[^<>]|<[^<>]*>)+)>\s+(\w+)\s*(?:=|;)", re.S)
VALUE = re.compile(COMMENT + r"struct (\w+) \{(.*?)^\};", re.S | re.M)
FIELD = re.compile(r'visit\("([^"]+)",\s*"([^"]*)"')


def text_of(comment):
    """The comment as text, with its paragraphs."""
    lines = [line.strip().removeprefix("///").strip() for line in comment.strip().splitlines()]
    return "\n".join(lines).replace("<", "\\<")


def headers(folder):
    return sorted((ROOT / folder).rglob("*.h"))


def values():
    """Of each type that flows through ports: its comment, its header and (name, unit) of its fields."""
    found = {}
    for path in [*headers("systems/signals"), *headers("systems/robot"), *headers("plant"), *headers("diagrams"),
                 *headers("systems")]:
        for comment, name, body in VALUE.findall(path.read_text()):
            fields = FIELD.findall(body)
            if fields and name not in found:
                found[name] = (text_of(comment), path.relative_to(ROOT), fields)
    return found


def blocks():
    """Of each room its blocks: (name, comment, header, inputs, outputs), ports as (type, name)."""
    rooms = {}
    for folder in ROOMS:
        for path in headers(folder):
            for comment, name, _, body in BLOCK.findall(path.read_text()):
                if name == "Diagram":  # it is made of blocks; its ports are theirs
                    continue
                ports = PORT.findall(body)
                inputs = [(kind, port) for way, kind, port in ports if way == "Input"]
                outputs = [(kind, port) for way, kind, port in ports if way == "Output"]
                rooms.setdefault(folder, []).append((name, text_of(comment), path.relative_to(ROOT), inputs, outputs))
    return rooms


def picture(name, inputs, outputs):
    """A block as SVG: inputs on the left, outputs on the right."""
    row, top, width, side = 20, 34, 210, 170
    height = top + row * max(len(inputs), len(outputs), 1) + 10
    parts = [f'<svg class="block" viewBox="0 0 {width + 2 * side} {height}" width="{width + 2 * side}" '
             f'role="img" aria-label="ports of {name}" font-family="sans-serif" font-size="12" fill="currentColor">',
             f'<rect x="{side}" y="1" width="{width}" height="{height - 2}" rx="6" fill="none" stroke="currentColor"/>',
             f'<text x="{side + width / 2}" y="20" text-anchor="middle" font-weight="bold">{name}</text>']
    for ports, edge, anchor, way in ((inputs, side, "end", -1), (outputs, side + width, "start", 1)):
        for number, (_, port) in enumerate(ports):
            y = top + row * number + 10
            parts.append(f'<line x1="{edge}" y1="{y}" x2="{edge + 12 * way}" y2="{y}" stroke="currentColor"/>')
            parts.append(f'<text x="{edge + 17 * way}" y="{y + 4}" text-anchor="{anchor}">{html.escape(port)}</text>')
    return "".join([*parts, "</svg>"])


def type_link(kind, known):
    return f"[`{kind}`](#{kind.lower()})" if kind in known else f"`{kind}`"


def page():
    known = values()
    text = ["# Blocks", "", "Each block is a class with typed ports; values are in SI units. The way from here to a diagram: "
            "[a block of your own](../docs/your_block.md), [architecture](../docs/architecture.md).", ""]
    used = set()
    for folder, found in blocks().items():
        text += [f"## {ROOMS[folder]}", ""]
        for name, comment, path, inputs, outputs in found:
            text += [f"### {name}", "", comment, "", picture(name, inputs, outputs), "",
                     f"Header: [{path}](../{path})", ""]
            if inputs or outputs:
                text += ["| port | | value |", "| --- | --- | --- |"]
                for way, ports in (("in", inputs), ("out", outputs)):
                    for kind, port in ports:
                        used.add(kind)
                        text.append(f"| `{port}` | {way} | {type_link(kind, known)} |")
                text.append("")
    text += ["## Values at ports", ""]
    for name in sorted(used & known.keys()):
        comment, path, fields = known[name]
        text += [f"### {name}", "", comment, "", f"Header: [{path}](../{path})", "", "| field | unit |", "| --- | --- |"]
        text += [f"| `{field}` | {html.escape(unit) or '-'} |" for field, unit in fields]
        text.append("")
    return "\n".join(text) + "\n"


if __name__ == "__main__":
    print(page(), end="")

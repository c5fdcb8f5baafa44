"""Makes the site of all documents: python3 docs/site/make_site.py PROGRAM OUT [--without-api]

PROGRAM is a built flinch, which tells of its verbs. Everything lies in OUT, and no page asks the network for anything.
"""
import pathlib
import re
import shutil
import subprocess
import sys

import blocks
import formulas

ROOT = pathlib.Path(__file__).resolve().parents[2]
SITE = ROOT / "docs/site"
DOCUMENTS = ["README.md", "CHANGELOG.md", "CONTRIBUTING.md", "SECURITY.md", *sorted(f"docs/{p.name}" for p in (ROOT / "docs").glob("*.md"))]


def printed_by(*command):
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout


def verbs_page(program):
    """What every verb says of itself."""
    names = re.findall(r"^  ([a-z][a-z-]+)  ", printed_by(program, "--help"), re.M)
    text = ["# Verbs of the program", "", "Each as `flinch help VERB` prints it.", ""]
    for name in dict.fromkeys(names):
        text += [f"## {name}", "", "```text", printed_by(program, name, "--help").rstrip(), "```", ""]
    return "\n".join(text)


def in_myst(text, folder):
    """Formulas as Sphinx wants them, and of links to folders and to pages that the site has not their text alone."""
    def shown(link):
        target = link[2].split("#")[0]
        if "://" in target or not target:
            return link[0]
        path = (folder / target).resolve()
        has_no_page = path.is_dir() or (path.suffix == ".md" and str(path.relative_to(ROOT)) not in DOCUMENTS)
        return link[1] if has_no_page else link[0]

    return re.sub(r"\[((?:[^\[\]]|\[[^\]]*\])*)\]\(([^)\s]+)\)", shown, text).replace("```math\n", "```{math}\n")


def lay_out(program, source):
    """The documents, and links to the folders that they show."""
    shutil.rmtree(source, ignore_errors=True)
    (source / "docs").mkdir(parents=True)
    (source / "reference").mkdir()
    for name in DOCUMENTS:
        if (ROOT / name).exists():
            (source / name).write_text(in_myst((ROOT / name).read_text(), (ROOT / name).parent))
    for entry in ROOT.iterdir():
        if entry.name not in ("docs", "build", "out") and not entry.name.startswith(".") and entry.suffix != ".md":
            (source / entry.name).symlink_to(entry)
    (source / "docs/images").symlink_to(ROOT / "docs/images")
    shutil.copy(SITE / "index.md", source)
    shutil.copy(SITE / "conf.py", source)
    (source / "reference/blocks.md").write_text(blocks.page())
    (source / "reference/verbs.md").write_text(verbs_page(program))


def make_api(out):
    settings = {"PROJECT_NAME": "flinch", "OUTPUT_DIRECTORY": out, "HTML_OUTPUT": "api", "GENERATE_LATEX": "NO",
                "RECURSIVE": "YES", "FILE_PATTERNS": "*.h", "INPUT": "systems diagrams plant drivers calibration identification "
                "import export convert learning experiments", "QUIET": "YES", "WARNINGS": "NO", "JAVADOC_AUTOBRIEF": "YES",
                "EXTRACT_ALL": "YES", "HIDE_UNDOC_RELATIONS": "YES", "HAVE_DOT": "NO", "SOURCE_BROWSER": "NO",
                "SEARCHENGINE": "YES", "SERVER_BASED_SEARCH": "NO", "MARKDOWN_SUPPORT": "YES", "STRIP_FROM_PATH": ROOT}
    text = "".join(f"{key} = {value}\n" for key, value in settings.items())
    subprocess.run(["doxygen", "-"], input=text, text=True, check=True, cwd=ROOT, stdout=subprocess.DEVNULL,
                   stderr=subprocess.DEVNULL)


def main(program, out, with_api):
    out = pathlib.Path(out).resolve()
    source = out.with_name(out.name + "_source")
    lay_out(program, source)
    shutil.rmtree(out, ignore_errors=True)
    subprocess.run(["sphinx-build", "-q", "-b", "html", "-d", f"{source}/.doctrees", source, out], check=True)
    formulas.show_formulas(out)
    if with_api:
        make_api(out)


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    main(sys.argv[1], sys.argv[2], "--without-api" not in sys.argv[3:])

"""Formulas of built pages as MathML, which browsers show by themselves: KaTeX makes it, all of a site at once."""
import html
import json
import os
import re
import subprocess

FORMULA = re.compile(r'<(span|div) class="math notranslate nohighlight"([^>]*)>\s*\\[(\[](.*?)\\[)\]]\s*</\1>', re.S)
SCRIPT = re.compile(r"<script[^>]*(?:MathJax\.js|mathjax)[^>]*></script>|<script>window\.MathJax = .*?</script>", re.S)
PROGRAM = """
const katex = require("katex");
const formulas = JSON.parse(require("fs").readFileSync(0));
const made = ([tex, displayMode]) => katex.renderToString(tex, {output: "mathml", displayMode, strict: false});
console.log(JSON.stringify(formulas.map(made)));
"""


def in_mathml(formulas):
    answer = subprocess.run(["node", "-e", PROGRAM], input=json.dumps(formulas), text=True, capture_output=True,
                            env={**os.environ, "NODE_PATH": "/usr/share/nodejs"})
    if answer.returncode != 0:
        raise SystemExit(f"a formula cannot be shown:\n{answer.stderr}")
    return json.loads(answer.stdout)


def show_formulas(folder):
    """In all pages of `folder`."""
    pages = {path: SCRIPT.sub("", path.read_text()) for path in folder.rglob("*.html")}
    found = [(html.unescape(match[3]).strip(), match[1] == "div") for text in pages.values() for match in FORMULA.finditer(text)]
    made = iter(in_mathml(found) if found else [])

    def shown(match):
        return f'<{match[1]} class="formula"{match[2]}>{next(made)}</{match[1]}>'

    for path, text in pages.items():
        path.write_text(FORMULA.sub(shown, text))

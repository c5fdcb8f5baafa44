"""The picture of README.md that moves: the robot of a report while it touches, tick by tick.

Usage: moving_picture.py REPORT.html OUT.gif FIRST LAST STEP     every STEP-th of these ticks, then the last for a while

Needs chromium-driver, and convert of ImageMagick. That of README.md is of 'flinch run platform_collision_fused', ticks
488 to 600, every fourth.
"""
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tests/experiments/report"))
from browser import Browser  # noqa: E402

FRAME, LAST_FRAME = "8", "200"  # [1/100 s]


def main():
    report, out, first, last, step = sys.argv[1:]
    with tempfile.TemporaryDirectory() as folder, Browser(1000, 1000) as browser:
        browser.open(pathlib.Path(report).resolve().as_uri())
        browser.look(1000, 1000, "light")
        browser.run("byId('view-close').click(); document.querySelector('.stage').scrollIntoView()")
        part = browser.run("const box = document.querySelector('.stage').getBoundingClientRect();"
                           "return `${Math.round(box.width)}x${Math.round(box.height)}"
                           "+${Math.round(box.left)}+${Math.round(box.top)}`")
        frames = []
        for tick in range(int(first), int(last) + 1, int(step)):
            browser.run("clock.seek(arguments[0]); return new Promise(done => requestAnimationFrame(() => done()))", tick)
            frames.append(f"{folder}/{tick:06d}.png")
            browser.screenshot(frames[-1])
        subprocess.run(["convert", "-delay", FRAME, *frames, "-delay", LAST_FRAME, frames[-1], "-crop", part, "+repage",
                        "-resize", "600x", "+dither", "-colors", "16", "-loop", "0", "-layers", "Optimize", out], check=True)


if __name__ == "__main__":
    main()

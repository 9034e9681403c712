"""Reads drawings with MuPDF, Poppler, Inkscape and hp2xx, and compares pages, pens and lengths with an SVG's text.

Arguments: the SVG, and the same drawing as PDF and as HPGL for the HP 7475A. A program that is missing is named, with exit
code 77 at the end."""

import math
import re
import shutil
import subprocess
import sys
import xml.etree.ElementTree as ElementTree

from svg_layers import svg_layers

MM = 25.4 / 72
SVG = "{http://www.w3.org/2000/svg}"


def run(*arguments):
    finished = subprocess.run(arguments, capture_output=True, text=True, timeout=120)
    assert finished.returncode == 0, finished.stderr
    return finished.stdout


def add(lengths, pen, points):
    length = sum(math.dist(a, b) for a, b in zip(points, points[1:]))
    lengths[pen] = lengths.get(pen, 0.0) + length


def expected(svg):
    """Length by color and width."""
    lengths = {}
    for group, length in svg_layers(svg):
        if len(group):
            pen = (group.get("stroke"), round(float(group.get("stroke-width")), 3))
            lengths[pen] = lengths.get(pen, 0.0) + length
    return lengths


def by_mupdf(pdf):
    document = ElementTree.fromstring(run("mutool", "trace", pdf))
    page = document.find("page")
    width, height = (float(n) * MM for n in page.get("mediabox").split()[2:])
    assert abs(width - 297) < 0.01 and abs(height - 210) < 0.01, (width, height)
    lengths = {}
    for stroke in page.iter("stroke_path"):
        a, b, c, d, e, f = (float(n) * MM for n in stroke.get("transform").split())
        points = [(float(p.get("x")), float(p.get("y"))) for p in stroke if p.get("x")]
        points = [(a * x + c * y + e, b * x + d * y + f) for x, y in points]
        if stroke.find("closepath") is not None:
            points.append(points[0])
        color = "#" + "".join(f"{round(255 * float(n)):02x}" for n in stroke.get("color").split())
        width_mm = float(stroke.get("linewidth")) * math.sqrt(abs(a * d - b * c))
        add(lengths, (color, round(width_mm, 3)), points)
    return lengths


def by_poppler(pdf):
    out = pdf + ".svg"
    run("pdftocairo", "-svg", "-origpagesizes", "-noshrink", pdf, out)
    root = ElementTree.parse(out).getroot()
    page = (float(root.get(side).removesuffix("pt")) * MM for side in ("width", "height"))
    assert all(abs(found - wanted) < 0.01 for found, wanted in zip(page, (297, 210)))
    lengths = {}
    for path in root.iter(f"{SVG}path"):
        style = dict(re.findall(r"([a-z-]+):([^;]+)", path.get("style") or "")) or path.attrib
        if style.get("stroke", "none") == "none":
            continue
        percents = [float(n) for n in re.findall(r"([\d.]+)%", style["stroke"])]
        color = "#" + "".join(f"{round(2.55 * n):02x}" for n in percents)
        matrix = re.search(r"matrix\(([^)]+)\)", path.get("transform") or "matrix(1,0,0,1,0,0)")
        a, b, c, d, e, f = (float(n) * MM for n in re.split(r"[ ,]+", matrix[1]))
        numbers = [float(n) for n in re.findall(r"-?[\d.]+", path.get("d"))]
        points = [(a * x + c * y + e, b * x + d * y + f) for x, y in zip(numbers[::2], numbers[1::2])]
        if "Z" in path.get("d"):
            points = points[:-1] if points[-1] == points[0] else points
            points.append(points[0])
        width_mm = float(style["stroke-width"]) * math.sqrt(abs(a * d - b * c))
        add(lengths, (color, round(width_mm, 3)), points)
    return lengths


def by_inkscape(svg):
    out = svg + ".inkscape.pdf"
    run("inkscape", svg, "--export-type=pdf", "-o", out)
    return by_mupdf(out)


def by_hp2xx(plt):
    """Length of all pens together: hp2xx takes a plotter unit for 0.025 mm, and rounds to 0.01 mm."""
    out = plt + ".eps"
    run("hp2xx", "-q", "-t", "-N", "-m", "eps", "-f", out, plt)
    scale = 0.02488 / 0.025
    length, at = 0.0, None
    with open(out, encoding="latin-1") as file:
        for x, y, what in re.findall(r"(-?[\d.]+)\s+(-?[\d.]+) ([MD])\b", file.read()):
            point = (float(x) * scale, float(y) * scale)
            length += math.dist(at, point) if what == "D" else 0.0
            at = point
    return length


def same(reader, found, wanted, tolerance):
    assert found.keys() == wanted.keys(), (found, wanted)
    for pen, length in wanted.items():
        assert abs(found[pen] - length) < tolerance, (reader, pen, found[pen], length)
        print(f"{reader}: {pen[0]}, {pen[1]} mm: {found[pen]:.2f} mm")


svg, pdf, plt = sys.argv[1:]
wanted = expected(svg)
readers = [
    ("MuPDF", ["mutool"], lambda: same("MuPDF", by_mupdf(pdf), wanted, 0.01)),
    ("Poppler", ["pdftocairo"], lambda: same("Poppler", by_poppler(pdf), wanted, 0.01)),
    ("Inkscape", ["inkscape", "mutool"], lambda: same("Inkscape", by_inkscape(svg), wanted, 0.01)),
]
is_any_missing = False
for name, programs, check in readers:
    if all(map(shutil.which, programs)):
        check()
    else:
        is_any_missing = True
        print(f"interop: skipped {name}, which is missing and cannot be installed")
if shutil.which("hp2xx"):
    length, drawn = by_hp2xx(plt), sum(wanted.values())
    # Whole plotter units, rounded once more on the way: a thousandth.
    assert abs(length / drawn - 1) < 1e-3, (length, drawn)
    print(f"hp2xx: {length:.1f} mm of {drawn:.1f}")
else:
    is_any_missing = True
    print("interop: skipped hp2xx, which is missing and cannot be installed")
sys.exit(77 if is_any_missing else 0)

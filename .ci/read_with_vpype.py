"""Reads a drawing with vpype and compares pages, layers, pens and lengths with the file's text."""

import math
import re
import sys
import xml.etree.ElementTree as ElementTree

import vpype

MM = 96 / 25.4
path = sys.argv[1]
document = vpype.read_multilayer_svg(path, quantization=0.1)
width, height = (size / MM for size in document.page_size)
assert abs(width - 297) < 0.01 and abs(height - 210) < 0.01, (width, height)

SVG = "{http://www.w3.org/2000/svg}"
INKSCAPE = "{http://www.inkscape.org/namespaces/inkscape}"
groups = ElementTree.parse(path).getroot().findall(f"{SVG}g")
assert sorted(document.layers) == [1, 2], sorted(document.layers)
for group in groups:
    number, name = group.get(f"{INKSCAPE}label").split(" ", 1)
    layer = document.layers[int(number)]
    assert layer.property("vp_name") == f"{number} {name}", layer.metadata
    assert abs(layer.property("vp_pen_width") / MM - float(group.get("stroke-width"))) < 1e-6
    color = layer.property("vp_color")
    assert f"#{color.red:02x}{color.green:02x}{color.blue:02x}" == group.get("stroke"), color
    length = 0.0
    for stroke in group.findall(f"{SVG}path"):
        numbers = [float(n) for n in re.findall(r"-?[\d.]+", stroke.get("d"))]
        points = list(zip(numbers[::2], numbers[1::2]))
        if stroke.get("d").endswith("Z"):
            points.append(points[0])
        length += sum(math.dist(a, b) for a, b in zip(points, points[1:]))
    assert abs(layer.length() / MM - length) < 0.01, (layer.length() / MM, length)
    assert len(layer) == len(group), (len(layer), len(group))
    print(f"vpype: {number} {name}: {len(layer)} strokes, {length:.2f} mm")

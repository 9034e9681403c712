"""Reads drawings with vpype and compares pages, layers, pens and lengths with the files' text."""

import math
import re
import sys
import warnings
import xml.etree.ElementTree as ElementTree

import vpype

MM = 96 / 25.4
SVG = "{http://www.w3.org/2000/svg}"
INKSCAPE = "{http://www.inkscape.org/namespaces/inkscape}"


def check(path):
    document = vpype.read_multilayer_svg(path, quantization=0.1)
    width, height = (size / MM for size in document.page_size)
    assert abs(width - 297) < 0.01 and abs(height - 210) < 0.01, (width, height)
    groups = ElementTree.parse(path).getroot().findall(f"{SVG}g")
    labels = [group.get(f"{INKSCAPE}label") for group in groups]
    numbers = [int(label.split(" ", 1)[0]) for label in labels]
    # vpype keeps no layer on which nothing is drawn.
    drawn = sorted(number for number, group in zip(numbers, groups) if len(group))
    assert sorted(document.layers) == drawn, (sorted(document.layers), labels)
    for number, label, group in zip(numbers, labels, groups):
        if not len(group):
            continue
        layer = document.layers[number]
        assert layer.property("vp_name") == label, layer.metadata
        assert abs(layer.property("vp_pen_width") / MM - float(group.get("stroke-width"))) < 1e-6
        color = layer.property("vp_color")
        assert f"#{color.red:02x}{color.green:02x}{color.blue:02x}" == group.get("stroke"), color
        length = 0.0
        for stroke in group.findall(f"{SVG}path"):
            coordinates = [float(n) for n in re.findall(r"-?[\d.]+", stroke.get("d"))]
            points = list(zip(coordinates[::2], coordinates[1::2]))
            if stroke.get("d").endswith("Z"):
                points.append(points[0])
            length += sum(math.dist(a, b) for a, b in zip(points, points[1:]))
        assert abs(layer.length() / MM - length) < 0.01, (layer.length() / MM, length)
        assert len(layer) == len(group), (len(layer), len(group))
        print(f"vpype: {label}: {len(layer)} strokes, {length:.2f} mm")


warnings.simplefilter("error")
for path in sys.argv[1:]:
    check(path)

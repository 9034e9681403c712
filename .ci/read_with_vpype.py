"""Reads drawings with vpype and compares pages, layers, pens and lengths with the files' text."""

import sys
import warnings

import vpype

from svg_layers import svg_layers

MM = 96 / 25.4
INKSCAPE = "{http://www.inkscape.org/namespaces/inkscape}"


def check(path):
    document = vpype.read_multilayer_svg(path, quantization=0.1)
    width, height = (size / MM for size in document.page_size)
    assert abs(width - 297) < 0.01 and abs(height - 210) < 0.01, (width, height)
    layers = svg_layers(path)
    labels = [group.get(f"{INKSCAPE}label") for group, _ in layers]
    numbers = [int(label.split(" ", 1)[0]) for label in labels]
    # vpype keeps no layer on which nothing is drawn.
    drawn = sorted(number for number, (group, _) in zip(numbers, layers) if len(group))
    assert sorted(document.layers) == drawn, (sorted(document.layers), labels)
    for number, label, (group, length) in zip(numbers, labels, layers):
        if not len(group):
            continue
        layer = document.layers[number]
        assert layer.property("vp_name") == label, layer.metadata
        assert abs(layer.property("vp_pen_width") / MM - float(group.get("stroke-width"))) < 1e-6
        color = layer.property("vp_color")
        assert f"#{color.red:02x}{color.green:02x}{color.blue:02x}" == group.get("stroke"), color
        assert abs(layer.length() / MM - length) < 0.01, (layer.length() / MM, length)
        assert len(layer) == len(group), (len(layer), len(group))
        print(f"vpype: {label}: {len(layer)} strokes, {length:.2f} mm")


warnings.simplefilter("error")
for path in sys.argv[1:]:
    check(path)

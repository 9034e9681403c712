"""The layers of an SVG that hiddenline wrote, from its text alone."""

import math
import re
import xml.etree.ElementTree as ElementTree

SVG = "{http://www.w3.org/2000/svg}"


def svg_layers(path):
    """Each layer's element, with the length of its strokes in millimeters."""
    layers = []
    for group in ElementTree.parse(path).getroot().findall(f"{SVG}g"):
        length = 0.0
        for stroke in group.findall(f"{SVG}path"):
            coordinates = [float(n) for n in re.findall(r"-?[\d.]+", stroke.get("d"))]
            points = list(zip(coordinates[::2], coordinates[1::2]))
            if stroke.get("d").endswith("Z"):
                points.append(points[0])
            length += sum(math.dist(a, b) for a, b in zip(points, points[1:]))
        layers.append((group, length))
    return layers

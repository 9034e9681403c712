"""Reads a DXF with ezdxf and compares units, layers and lengths with an SVG of the same drawing."""

import math
import re
import sys
import xml.etree.ElementTree as ElementTree

import ezdxf

SVG = "{http://www.w3.org/2000/svg}"


def svg_lengths(path):
    lengths = []
    for group in ElementTree.parse(path).getroot().findall(f"{SVG}g"):
        length = 0.0
        for stroke in group.findall(f"{SVG}path"):
            coordinates = [float(n) for n in re.findall(r"-?[\d.]+", stroke.get("d"))]
            points = list(zip(coordinates[::2], coordinates[1::2]))
            if stroke.get("d").endswith("Z"):
                points.append(points[0])
            length += sum(math.dist(a, b) for a, b in zip(points, points[1:]))
        if len(group):
            lengths.append(length)
    return lengths


def dxf_lengths(path):
    document = ezdxf.readfile(path)
    assert document.header["$INSUNITS"] == 4, "millimeters"
    assert document.header["$EXTMAX"][:2] == (297, 210), document.header["$EXTMAX"]
    auditor = document.audit()
    assert not auditor.has_errors, auditor.errors
    lengths = {}
    for line in document.modelspace().query("POLYLINE"):
        points = [vertex.dxf.location for vertex in line.vertices]
        if line.is_closed:
            points.append(points[0])
        assert all(0 <= p.x <= 297 and 0 <= p.y <= 210 for p in points)
        length = sum(a.distance(b) for a, b in zip(points, points[1:]))
        lengths[line.dxf.layer] = lengths.get(line.dxf.layer, 0.0) + length
    return lengths


drawn, read = svg_lengths(sys.argv[1]), dxf_lengths(sys.argv[2])
assert len(drawn) == len(read), (drawn, read)
for length, (layer, found) in zip(drawn, read.items()):
    # The SVG is rounded to micrometers, the DXF to tenths of one.
    assert abs(length - found) < 0.01, (layer, length, found)
    print(f"ezdxf: {layer}: {found:.2f} mm")

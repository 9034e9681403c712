"""Reads DXF files with ezdxf and compares units, layers, linetypes and lengths with an SVG of the same drawing."""

import math
import sys

import ezdxf

from svg_layers import svg_layers


def read(path, unit, page):
    document = ezdxf.readfile(path)
    assert document.header["$INSUNITS"] == unit, document.header["$INSUNITS"]
    assert math.dist(document.header["$EXTMAX"][:2], page) < 1e-3, document.header["$EXTMAX"]
    auditor = document.audit()
    assert not auditor.has_errors and not auditor.has_fixes, auditor.errors + auditor.fixes
    return document


def lengths_by_layer(document):
    lengths = {}
    width, height = document.header["$EXTMAX"][:2]
    for line in document.modelspace().query("POLYLINE"):
        points = [vertex.dxf.location for vertex in line.vertices]
        if line.is_closed:
            points.append(points[0])
        assert all(0 <= p.x <= width and 0 <= p.y <= height for p in points)
        length = sum(a.distance(b) for a, b in zip(points, points[1:]))
        lengths[line.dxf.layer] = lengths.get(line.dxf.layer, 0.0) + length
    return lengths


def same_as_svg(svg, dxf):
    drawn = [length for group, length in svg_layers(svg) if len(group)]
    read_back = lengths_by_layer(read(dxf, 4, (297, 210)))
    assert len(drawn) == len(read_back), (drawn, read_back)
    for length, (layer, found) in zip(drawn, read_back.items()):
        # The SVG is rounded to micrometers, the DXF to tenths of one.
        assert abs(length - found) < 0.01, (layer, length, found)
        print(f"ezdxf: {layer}: {found:.2f} mm")


def native_dashes(native, solid):
    """Hidden lines are whole and have a linetype; at 1:2 in inches, coordinates are inches of the model."""
    page = (297 * 2 / 25.4, 210 * 2 / 25.4)
    whole, plain = read(native, 1, page), read(solid, 1, page)
    assert lengths_by_layer(whole) == lengths_by_layer(plain)
    hidden = [layer for layer in whole.layers if "HIDDEN" in layer.dxf.name]
    assert [layer.dxf.linetype for layer in hidden] == ["DASHED"]
    pattern = [tag.value for tag in whole.linetypes.get("DASHED").pattern_tags.tags if tag.code == 49]
    assert all(abs(value - mm * 2 / 25.4) < 1e-4 for value, mm in zip(pattern, (4, -2))), pattern
    for line in whole.modelspace().query("POLYLINE"):
        # 128: the pattern runs on around corners.
        assert bool(line.dxf.flags & 128) == ("HIDDEN" in line.dxf.layer)
    print(f"ezdxf: linetype DASHED {pattern}, inches of the model")


same_as_svg(*sys.argv[1:3])
native_dashes(*sys.argv[3:5])

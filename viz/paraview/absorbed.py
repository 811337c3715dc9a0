"""Cells that the cut absorbed: initially exterior, interior after it. The solid, cut open.

    pvbatch viz/paraview/absorbed.py stages --screenshot absorbed.png
"""

import os
import sys

# ParaView does not look for modules beside a script that it runs as state, and names no file for --script.
sys.path[:0] = [os.path.dirname(os.path.abspath(globals()["__file__"])) if "__file__" in globals()
                else os.environ.get("CELLOCUT_PARAVIEW", "")]

import kit  # noqa: E402
from paraview import simple  # noqa: E402

ENTRIES = [(0, "interior from the start", kit.SOLID), (1, "absorbed", kit.DISTINCT[1]),
           (2, "given up", kit.MARKED)]


def build(options, view):
    cells = kit.open_cells(options.files, "label_initial", "label")
    change = kit.calculate(cells, "change", '"label_initial" + 2 * "label"')
    shown = kit.select(change, "change", 0, 2, "not exterior")
    if kit.count(shown) == 0:
        raise kit.KitError("no cell is interior, before or after the cut")
    print(f"absorbed: {kit.count(kit.select(change, 'change', 1, 1, 'absorbed'))} cells absorbed, "
          f"{kit.count(kit.select(change, 'change', 2, 2, 'given up'))} given up")
    box = kit.bounds(shown)
    origin = options.origin or kit.middle(box)
    behind = simple.Show(kit.cut_away(shown, origin, options.normal), view)
    kit.colour_by(behind, "change", ENTRIES)
    behind.Ambient, behind.Diffuse, behind.Specular = 0.35, 0.6, 0.0
    # The cut itself is flat, a little in front of what lies behind it.
    length = sum(x * x for x in options.normal) ** 0.5
    front = [o + 1e-3 * kit.diagonal(box) * x / length for o, x in zip(origin, options.normal)]
    cap = simple.Show(kit.cut_plane(shown, front, options.normal), view)
    kit.colour_by(cap, "change", ENTRIES)
    kit.edges(cap)
    kit.flat(cap)
    kit.look(view, box, kit.oblique(options.normal, options.up), options.up)


add_arguments = kit.add_plane


def main(arguments=None):
    kit.run("absorbed", __doc__, build, add_arguments, arguments)


if kit.start(__name__):
    main()

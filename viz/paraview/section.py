"""A section through the labelled cells with the outline of the input.

    pvbatch viz/paraview/section.py stages --screenshot section.png
    pvbatch viz/paraview/section.py cells.vtu input.obj --array ambiguous --normal 1,0,0 --up y
"""

import os
import sys

# ParaView does not look for modules beside a script that it runs as state, and names no file for --script.
sys.path[:0] = [os.path.dirname(os.path.abspath(globals()["__file__"])) if "__file__" in globals()
                else os.environ.get("CELLOCUT_PARAVIEW", "")]

import kit  # noqa: E402
from paraview import simple  # noqa: E402


def build(options, view):
    cells = kit.open_cells(options.files, options.array)
    outline = kit.open_outline(options.files)
    box = kit.bounds(outline or cells)
    origin = options.origin or kit.middle(box)
    cut = kit.cut_plane(cells, origin, options.normal)
    display = simple.Show(cut, view)
    kit.edges(display)
    kit.flat(display)
    entries = None
    if options.array not in kit.CONTINUOUS:
        low, high = cells.CellData.GetArray(options.array).GetRange()
        entries = kit.categories(options.array, low, high)
    kit.colour_by(display, options.array, entries)
    if outline is not None:
        line = simple.Show(kit.cut_plane(outline, origin, options.normal, "outline"), view)
        kit.plain(line, kit.OUTLINE)
        kit.flat(line)
        line.LineWidth = 2.5
    kit.look(view, box, options.normal, options.up)


def add_arguments(parser):
    parser.add_argument("--array", default="label", help="the cell array that colours (label)")
    kit.add_plane(parser)


def main(arguments=None):
    kit.run("section", __doc__, build, add_arguments, arguments)


if kit.start(__name__):
    main()

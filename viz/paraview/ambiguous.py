"""Ambiguous cells, which some minimum cuts make interior and others not, in the far walls of the solid.

    pvbatch viz/paraview/ambiguous.py stages --screenshot ambiguous.png
"""

import os
import sys

# ParaView does not look for modules beside a script that it runs as state, and names no file for --script.
sys.path[:0] = [os.path.dirname(os.path.abspath(globals()["__file__"])) if "__file__" in globals()
                else os.environ.get("CELLOCUT_PARAVIEW", "")]

import kit  # noqa: E402
from paraview import simple  # noqa: E402


def build(options, view):
    cells = kit.open_cells(options.files, "ambiguous", "label")
    kit.show_marked(cells, "ambiguous", kit.categories("ambiguous", 0, 1)[1:], view, options,
                    "cells ambiguous", "the minimum cut is unique")


def add_arguments(parser):
    parser.add_argument("--normal", type=kit.vector, help="where the viewer is: x,y,z (the front)")


def main(arguments=None):
    kit.run("ambiguous", __doc__, build, add_arguments, arguments)


if kit.start(__name__):
    main()

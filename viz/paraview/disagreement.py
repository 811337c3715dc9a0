"""Where solvers, or two backends, label differently.

    pvbatch viz/paraview/disagreement.py DIR/bunny_cgal.vtu --screenshot solvers.png
    pvbatch viz/paraview/disagreement.py DIR/bunny_cgal.vtu DIR/bunny_tetgen.vtu --screenshot backends.png

One file: its label_<solver> arrays and `disagree`, in the far walls of the solid. Two files: their cells
may differ, so both labellings are compared on a plane, point by point.
"""

import os
import sys

# ParaView does not look for modules beside a script that it runs as state, and names no file for --script.
sys.path[:0] = [os.path.dirname(os.path.abspath(globals()["__file__"])) if "__file__" in globals()
                else os.environ.get("CELLOCUT_PARAVIEW", "")]

import kit  # noqa: E402
from paraview import simple  # noqa: E402

STEPS = 500  # points along the longer side of the plane


def solver_arrays(cells):
    return [name for name in cells.CellData.keys()
            if name.startswith("label_") and name not in ("label_initial", "label_path")]


def build_solvers(cells, path, options, view):
    names = solver_arrays(cells)
    if len(names) < 2:
        kit.require(cells, "disagree", path)
    votes = " + ".join(f'"{name}"' for name in names) or "0"
    formula = f"if(({votes}) > 0 and ({votes}) < {len(names)}, 1, 0)" if len(names) > 1 else "0"
    if cells.CellData.GetArray("disagree"):
        formula = f'max({formula}, "disagree")'
    kit.require(cells, "label", path)
    compared = kit.calculate(cells, "solvers", formula)
    kit.show_marked(compared, "solvers", [(1, "solvers disagree", kit.MARKED)], view, options,
                    "cells labelled differently by solvers", "they all agree")


def build_backends(both, paths, options, view):
    for cells, path in zip(both, paths):
        kit.require(cells, "label", path)
    names = [os.path.basename(path) for path in paths]
    box = kit.bounds(kit.select(both[0], "label", 0, 0, "solid"))
    origin = options.origin or kit.middle(box)
    plane = kit.plane_over(box, origin, options.normal, STEPS)
    # A point outside all cells has 0 there, which is to mean exterior.
    for number, cells in enumerate(both):
        interior = kit.calculate(cells, f"interior_{number}", '1 - "label"')
        plane = simple.ResampleWithDataset(registrationName=f"on the plane {number}",
                                           SourceDataArrays=interior, DestinationMesh=plane)
        plane.PassPointArrays = 1
    joined = kit.calculate(plane, "backends", '"interior_0" + 2 * "interior_1"', "Point Data")
    flat = simple.PointDatatoCellData(registrationName="backends", Input=joined)
    flat.CategoricalData = 1
    display = simple.Show(flat, view)
    kit.flat(display)
    kit.colour_by(display, "backends", [(0, "exterior in both", kit.PALE), (3, "interior in both", kit.SOLID),
                                        (1, f"interior in {names[0]}", kit.ANCHORED),
                                        (2, f"interior in {names[1]}", kit.MARKED)])
    kit.look(view, kit.bounds(flat), options.normal, options.up)


def build(options, view):
    paths = kit.find(options.files, "cells.vtu", (".vtu",))
    if len(paths) < 2:
        cells = kit.open_cells(options.files)
        build_solvers(cells, paths[0], options, view)
    else:
        build_backends([kit.open_file(path) for path in paths[:2]], paths, options, view)


add_arguments = kit.add_plane


def main(arguments=None):
    kit.run("disagreement", __doc__, build, add_arguments, arguments)


if kit.start(__name__):
    main()

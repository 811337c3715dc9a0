"""Shows labelled tetrahedra (a .vtu of `cellocut remesh --vtu`) cut open, with categorical colours.

Against ParaView 5.11's `paraview.simple`.

    pvbatch viz/paraview/labelled_cells.py cells.vtu --screenshot cells.png
    pvpython viz/paraview/labelled_cells.py cells.vtu --array ambiguous --mode section ...

In ParaView itself: select the file in the pipeline browser and run this script (Tools, Python Shell,
Run Script). From Python: `import labelled_cells; labelled_cells.show("cells.vtu", array="label")`.
"""

import argparse
import os
import sys

from paraview.simple import (
    Clip,
    GetActiveSource,
    GetActiveViewOrCreate,
    Hide,
    Render,
    ResetCamera,
    SaveScreenshot,
    SetActiveSource,
    Show,
    Slice,
    UpdatePipeline,
    XMLUnstructuredGridReader,
)

sys.path[:0] = [os.path.dirname(os.path.abspath(globals()["__file__"])) if "__file__" in globals()
                else os.environ.get("CELLOCUT_PARAVIEW", "")]

import kit  # noqa: E402


def cut_open(source, mode, origin, normal):
    if mode == "section":
        cut = Slice(registrationName="section", Input=source)
        cut.SliceType = "Plane"
        plane = cut.SliceType
    else:
        cut = Clip(registrationName="clip", Input=source)
        cut.ClipType = "Plane"
        cut.Crinkleclip = 1  # whole cells
        plane = cut.ClipType
    plane.Origin = list(origin)
    plane.Normal = list(normal)
    return cut


def show(source, array="label", mode="clip", origin=None, normal=(0.0, 1.0, 0.0), view=None):
    """Cuts `source` (a reader, or the path of a .vtu) by a plane and colours it by `array`.

    mode: "clip" keeps whole cells on one side, "section" shows the plane alone. origin: by default the
    middle of the box. Returns the filter and its display.
    """
    if isinstance(source, str):
        source = XMLUnstructuredGridReader(registrationName=source, FileName=[source])
    UpdatePipeline(proxy=source)
    info = source.CellData.GetArray(array)
    if info is None:
        names = ", ".join(source.CellData.keys())
        raise ValueError(f"there is no cell array '{array}'; there are: {names}")
    if origin is None:
        box = source.GetDataInformation().GetBounds()
        origin = [0.5 * (box[2 * k] + box[2 * k + 1]) for k in range(3)]
    view = view or GetActiveViewOrCreate("RenderView")
    cut = cut_open(source, mode, origin, normal)
    display = Show(cut, view)
    display.Representation = "Surface With Edges"
    display.EdgeColor = [0.3, 0.3, 0.35]
    if mode == "section":
        kit.flat(display)  # the colours of the legend; light would only darken them
    entries = None if array in kit.CONTINUOUS else kit.categories(array, *info.GetRange())
    kit.colour_by(display, array, entries, view)
    Hide(source, view)
    SetActiveSource(cut)
    # Look at the cut: the clip keeps the side that the normal points away from.
    up = [0.0, 1.0, 0.0] if abs(normal[2]) > max(abs(normal[0]), abs(normal[1])) else [0.0, 0.0, 1.0]
    view.CameraFocalPoint = list(origin)
    view.CameraPosition = [o + n for o, n in zip(origin, normal)]
    view.CameraViewUp = up
    ResetCamera(view)
    Render(view)
    return cut, display


def main(arguments):
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("vtu", help="labelled cells")
    parser.add_argument("--array", default="label", help="the cell array that colours (label)")
    parser.add_argument("--mode", choices=["clip", "section"], default="clip")
    parser.add_argument("--origin", type=kit.vector, help="a point on the plane (middle of the box)")
    parser.add_argument("--normal", type=kit.vector, default=[0.0, 1.0, 0.0], help="(0,1,0)")
    parser.add_argument("--screenshot", help="a PNG to write")
    options = parser.parse_args(arguments)
    show(options.vtu, options.array, options.mode, options.origin, options.normal)
    if options.screenshot:
        SaveScreenshot(options.screenshot, GetActiveViewOrCreate("RenderView"),
                       ImageResolution=[1200, 900], OverrideColorPalette="WhiteBackground")


if __name__ == "__main__":
    # The graphical program passes no arguments of ours: there, what is selected is shown.
    if any(argument.lower().endswith(".vtu") for argument in sys.argv[1:]):
        main(sys.argv[1:])
    elif GetActiveSource() is not None:
        show(GetActiveSource())
    else:
        print("labelled_cells: open a .vtu first, or name one as argument", file=sys.stderr)

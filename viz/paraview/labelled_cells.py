"""Shows labelled tetrahedra (a .vtu of `cellocut remesh --vtu`) cut open, with categorical colours.

Against ParaView 5.11's `paraview.simple`.

    paraview cells.vtu --script=viz/paraview/labelled_cells.py      opens and shows
    pvbatch viz/paraview/labelled_cells.py cells.vtu --screenshot cells.png
    pvpython viz/paraview/labelled_cells.py cells.vtu --array ambiguous --mode section ...

In ParaView itself: select the file in the pipeline browser and run this script (Tools, Python Shell,
Run Script). From Python: `import labelled_cells; labelled_cells.show("cells.vtu", array="label")`.
"""

import argparse
import sys

from paraview.simple import (
    Clip,
    ColorBy,
    GetActiveSource,
    GetActiveViewOrCreate,
    GetColorTransferFunction,
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

SOLID = (0.867, 0.478, 0.235)
PALE = (0.925, 0.937, 0.953)
MARKED = (0.722, 0.118, 0.290)
ANCHORED = (0.235, 0.471, 0.690)
# The palette of `cellocut section` for arrays whose values have no names (Okabe and Ito, 2008).
DISTINCT = ((0.902, 0.624, 0.000), (0.337, 0.706, 0.914), (0.000, 0.620, 0.451),
            (0.941, 0.894, 0.259), (0.000, 0.447, 0.698), (0.835, 0.369, 0.000),
            (0.800, 0.475, 0.655))
MOST_CATEGORIES = 64


def categories(array, low, high):
    """(value, name, colour) of each category of the array."""
    if array == "label" or array.startswith("label_"):
        return [(0, "interior", SOLID), (1, "exterior", PALE)]
    if array == "ambiguous":
        return [(0, "decided", PALE), (1, "ambiguous", MARKED)]
    if array == "anchored":
        return [(0, "free", PALE), (1, "anchored", ANCHORED)]
    values = range(int(low), min(int(high), int(low) + MOST_CATEGORIES - 1) + 1)
    return [(v, f"{array} {v}", DISTINCT[v % len(DISTINCT)]) for v in values]


def is_categorical(array):
    return array not in ("phi", "volume", "lp_value")


def colour_categories(array, low, high):
    """Gives the array's transfer function one colour and one name per value."""
    table = GetColorTransferFunction(array)
    table.InterpretValuesAsCategories = 1
    table.AnnotationsInitialized = 1
    annotations, colours = [], []
    for value, name, colour in categories(array, low, high):
        annotations += [str(value), name]
        colours += colour
    table.Annotations = annotations
    table.IndexedColors = colours
    table.IndexedOpacities = [1.0] * (len(annotations) // 2)


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
    ColorBy(display, ("CELLS", array))
    if is_categorical(array):
        low, high = info.GetRange()
        colour_categories(array, low, high)
    display.SetScalarBarVisibility(view, True)
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


def vector(text):
    values = [float(part) for part in text.split(",")]
    if len(values) != 3:
        raise argparse.ArgumentTypeError(f"'{text}': give three numbers, separated by commas")
    return values


def main(arguments):
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("vtu", help="labelled cells")
    parser.add_argument("--array", default="label", help="the cell array that colours (label)")
    parser.add_argument("--mode", choices=["clip", "section"], default="clip")
    parser.add_argument("--origin", type=vector, help="a point on the plane (middle of the box)")
    parser.add_argument("--normal", type=vector, default=[0.0, 1.0, 0.0], help="(0,1,0)")
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

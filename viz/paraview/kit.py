"""What the ParaView scripts of CelloCut share: colours, files, planes, cameras, the command line.

For ParaView 5.11. A script has `build(options, view)`, which makes its scene, and hands it to run().
"""

import argparse
import os
import shlex
import sys

from paraview import simple

# The colours of `cellocut section`.
SOLID = (0.867, 0.478, 0.235)
PALE = (0.925, 0.937, 0.953)
MARKED = (0.722, 0.118, 0.290)
ANCHORED = (0.235, 0.471, 0.690)
CONTEXT = (0.80, 0.82, 0.85)
OUTLINE = (0.10, 0.12, 0.16)
EDGES = (0.45, 0.47, 0.52)
# For arrays whose values have no names (Okabe and Ito, 2008).
DISTINCT = ((0.902, 0.624, 0.000), (0.337, 0.706, 0.914), (0.000, 0.620, 0.451),
            (0.941, 0.894, 0.259), (0.000, 0.447, 0.698), (0.835, 0.369, 0.000),
            (0.800, 0.475, 0.655))
MOST_CATEGORIES = 64
FRONT = {"z": [0.0, -1.0, 0.0], "y": [0.0, 0.0, 1.0]}  # by the axis that points up
LEGEND_SHARE = 0.24  # of the width of a picture
CONTINUOUS = ("phi", "volume", "lp_value", "saturation", "area", "weight", "flow", "supported")

READERS = {
    ".vtu": simple.XMLUnstructuredGridReader,
    ".vtp": simple.XMLPolyDataReader,
    ".obj": simple.WavefrontOBJReader,
    ".ply": simple.PLYReader,
    ".stl": simple.STLReader,
}
PALETTE = "WhiteBackground"
STAGES = "cellocut remesh IN -o OUT --save-stages DIR"
COMPARE = "cellocut compare IN... -o DIR"


class KitError(Exception):
    """What the user can put right, in one line."""


# Files

def stage_folder(path):
    """The folder that --save-stages wrote, given by its name or by its run.vtm; else None."""
    if os.path.isdir(path):
        return path
    return os.path.dirname(path) or "." if path.endswith(".vtm") else None


def property_of(source, name):
    """None if there is no such property. (getattr() fails where an older ParaView had it.)"""
    return getattr(source, name) if name in source.ListProperties() else None


def file_of(source):
    """The file that a reader reads; None for filters."""
    for name in ("FileName", "FileNames"):
        value = property_of(source, name)
        if value:
            return value if isinstance(value, str) else value[0]
    return None


def files_of_active_source():
    """What is selected in the pipeline browser, or what that was made from."""
    source = simple.GetActiveSource()
    while source is not None:
        file = file_of(source)
        if file:
            return [file]
        source = property_of(source, "Input")
    raise KitError("name a file, or open one first and select it in the pipeline browser")


def find(files, stage, kinds):
    """Paths among the files: `stage` in a folder of stages, or a file of one of the kinds. May be empty."""
    found = []
    for path in files:
        folder = stage_folder(path)
        if folder is not None:
            path = os.path.join(folder, stage)
            if os.path.exists(path):
                found.append(path)
        elif path.lower().endswith(kinds):
            found.append(path)
    return found


def open_file(path):
    """A reader of the file: the one that is open in the pipeline browser, or a new one."""
    if not os.path.exists(path):
        raise KitError(f"{path}: no such file")
    for source in simple.GetSources().values():
        if os.path.abspath(file_of(source) or "") == os.path.abspath(path):
            simple.UpdatePipeline(proxy=source)
            return source
    kind = os.path.splitext(path)[1].lower()
    if kind not in READERS:
        raise KitError(f"{path}: not one of {' '.join(READERS)}")
    key, value = ("FileNames", [path]) if kind in (".ply", ".stl") else ("FileName", path)
    reader = READERS[kind](registrationName=os.path.basename(path), **{key: value})
    simple.UpdatePipeline(proxy=reader)
    if reader.GetDataInformation().GetNumberOfPoints() == 0:
        raise KitError(f"{path}: empty, or not to be read")
    return reader


def open_cells(files, *arrays):
    paths = find(files, "cells.vtu", (".vtu",))
    if not paths:
        raise KitError(f"no labelled cells (a .vtu) among {' '.join(files)}; '{STAGES}' writes them")
    cells = open_file(paths[0])
    for array in arrays:
        require(cells, array, paths[0])
    return cells


def open_outline(files):
    """The input: as a file of its own, or input.vtp beside the cells; None if there is none."""
    paths = find(files, "input.vtp", (".vtp", ".obj", ".ply", ".stl"))
    paths += [os.path.join(os.path.dirname(path), "input.vtp") for path in find(files, "", (".vtu",))]
    paths = [path for path in paths if os.path.isfile(path)]
    return open_file(paths[0]) if paths else None


def require(source, array, path, writer=STAGES):
    """The array's information, or an error that says what there is and what writes it."""
    info = source.CellData.GetArray(array)
    if info is None:
        names = ", ".join(source.CellData.keys()) or "none"
        if array.startswith(("disagree", "label_")) and array != "label_initial":
            writer = COMPARE
        raise KitError(f"{path}: there is no cell array '{array}'; there are: {names}; '{writer}' writes it")
    return info


# Colours

def categories(array, low, high):
    """(value, name, colour) of each category of the array."""
    if array == "label" or array.startswith("label_"):
        return [(0, "interior", SOLID), (1, "exterior", PALE)]
    if array == "ambiguous":
        return [(0, "decided", PALE), (1, "ambiguous", MARKED)]
    if array == "anchored":
        return [(0, "free", PALE), (1, "anchored", ANCHORED)]
    if array == "disagree":
        return [(0, "agreed", PALE), (1, "disagree", MARKED)]
    values = range(int(low), min(int(high), int(low) + MOST_CATEGORIES - 1) + 1)
    return [(v, f"{array} {v}", DISTINCT[v % len(DISTINCT)]) for v in values]


def colour_by(display, array, entries=None, view=None):
    """Colours by categories, as (value, name, colour); with none by a ramp from 0 to 1 or its range."""
    simple.ColorBy(display, ("CELLS", array))
    table = simple.GetColorTransferFunction(array)
    if entries:
        table.InterpretValuesAsCategories = 1
        table.AnnotationsInitialized = 1
        table.Annotations = [text for value, name, _ in entries for text in (str(value), name)]
        table.IndexedColors = [part for _, _, colour in entries for part in colour]
        table.IndexedOpacities = [1.0] * len(entries)
    elif array == "saturation":
        table.ApplyPreset("Viridis (matplotlib)", True)
        table.RescaleTransferFunction(0.0, 1.0)
    view = view or simple.GetActiveViewOrCreate("RenderView")
    display.SetScalarBarVisibility(view, True)
    bar = simple.GetScalarBar(table, view)
    bar.Title = "" if entries else array
    bar.ComponentTitle = ""
    bar.WindowLocation = "Upper Right Corner"
    bar.TitleFontSize = bar.LabelFontSize = 14
    bar.ScalarBarLength = min(0.5, 0.07 * len(entries)) if entries else 0.3
    bar.AutomaticLabelFormat = 0
    bar.LabelFormat = bar.RangeLabelFormat = "%.3g"
    return table


def plain(display, colour):
    display.ColorArrayName = ["POINTS", ""]
    display.AmbientColor = display.DiffuseColor = list(colour)


def flat(display):
    """No light, so that a colour in the picture is the colour of the legend."""
    display.Ambient, display.Diffuse, display.Specular = 1.0, 0.0, 0.0


def edges(display, colour=EDGES):
    display.Representation = "Surface With Edges"
    display.EdgeColor = list(colour)
    display.LineWidth = 0.5


# Geometry

def bounds(source):
    simple.UpdatePipeline(proxy=source)
    return source.GetDataInformation().GetBounds()


def middle(box):
    return [0.5 * (box[2 * k] + box[2 * k + 1]) for k in range(3)]


def diagonal(box):
    return sum((box[2 * k + 1] - box[2 * k]) ** 2 for k in range(3)) ** 0.5


def count(source):
    simple.UpdatePipeline(proxy=source)
    return source.GetDataInformation().GetNumberOfCells()


def select(source, array, low, high, name):
    """The cells whose value lies between low and high."""
    part = simple.Threshold(registrationName=name, Input=source)
    part.Scalars = ["CELLS", array]
    part.LowerThreshold, part.UpperThreshold, part.ThresholdMethod = low, high, "Between"
    return part


def calculate(source, result, formula, attribute="Cell Data"):
    """An array from others; a name in the formula has double quotes."""
    made = simple.Calculator(registrationName=result, Input=source)
    made.AttributeType = attribute
    made.ResultArrayName = result
    made.Function = formula
    simple.UpdatePipeline(proxy=made)
    return made


def cut_plane(source, origin, normal, name="section"):
    cut = simple.Slice(registrationName=name, Input=source)
    cut.SliceType = "Plane"
    cut.SliceType.Origin, cut.SliceType.Normal = list(origin), list(normal)
    cut.Triangulatetheslice = 0
    return cut


def cut_away(source, origin, normal, name="clip", whole_cells=False):
    """What lies behind the plane, seen from where the normal points to."""
    cut = simple.Clip(registrationName=name, Input=source)
    cut.ClipType = "Plane"
    cut.ClipType.Origin, cut.ClipType.Normal = list(origin), list(normal)
    cut.Crinkleclip = int(whole_cells)
    return cut


def plane_over(box, origin, normal, steps):
    """A grid of squares on the plane that covers the box."""
    axis = max(range(3), key=lambda k: abs(normal[k]))
    first, second = [k for k in range(3) if k != axis]
    margin = 0.05 * diagonal(box)

    def point(u, v):
        # Onto the plane along its steepest axis.
        where = [0.0, 0.0, 0.0]
        where[first], where[second] = u, v
        rest = sum(normal[k] * (where[k] - origin[k]) for k in (first, second))
        where[axis] = origin[axis] - rest / normal[axis]
        return where

    low = [box[2 * k] - margin for k in (first, second)]
    high = [box[2 * k + 1] + margin for k in (first, second)]
    plane = simple.Plane(registrationName="plane")
    plane.Origin, plane.Point1, plane.Point2 = point(*low), point(high[0], low[1]), point(low[0], high[1])
    step = max(h - l for h, l in zip(high, low)) / steps
    plane.XResolution, plane.YResolution = (max(1, round((h - l) / step)) for h, l in zip(high, low))
    return plane


def show_marked(cells, array, entries, view, options, what, otherwise):
    """The cells with array = 1, before the far walls of the solid: nothing hides them or tints them."""
    marked = select(cells, array, 1, 1, "marked")
    number = count(marked)
    print(f"{number} {what}" + ("" if number else f": {otherwise}"))
    walls = simple.ExtractSurface(registrationName="walls", Input=select(cells, "label", 0, 0, "solid"))
    box = bounds(walls if count(walls) else cells)
    if count(walls):
        display = simple.Show(walls, view)
        plain(display, CONTEXT)
        display.BackfaceRepresentation = "Cull Frontface"
    if number:
        display = simple.Show(marked, view)
        colour_by(display, array, entries)
        flat(display)
        edges(display)
    look(view, box, oblique(options.normal, options.up), options.up)


# Camera

def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def unit(a):
    length = sum(x * x for x in a) ** 0.5
    return [x / length for x in a]


def screen_axes(towards, upward):
    """What points right and up in a picture that is seen from `towards`, `upward` up where that can be."""
    if abs(towards["xyz".index(upward)]) > 0.9:
        upward = "y" if upward == "z" else "z"
    right = unit(cross([float(axis == upward) for axis in "xyz"], towards))
    return right, cross(towards, right)


def look(view, box, direction, upward="z"):
    """From the direction onto the middle of the box. Parallel, and as close as the box allows."""
    centre, towards = middle(box), unit(direction)
    right, up = screen_axes(towards, upward)

    def half_extent(axis):
        return 0.5 * sum((box[2 * k + 1] - box[2 * k]) * abs(axis[k]) for k in range(3))

    view.CameraParallelProjection = 1
    view.CameraFocalPoint = centre
    view.CameraPosition = [c + 2.0 * diagonal(box) * x for c, x in zip(centre, towards)]
    view.CameraViewUp = up
    width, height = view.ViewSize
    free = width if graphical() else width * (1.0 - LEGEND_SHARE)
    view.CameraParallelScale = 1.05 * max(half_extent(up), half_extent(right) * height / free)
    if not graphical():  # there nobody turns the scene, and the legend can have the right of the picture
        view.GetActiveCamera().SetWindowCenter(LEGEND_SHARE, 0.0)


def oblique(direction, upward="z"):
    """Off the direction, to the right and up, so that depth is seen."""
    towards = unit(direction)
    return [t + 0.45 * r + 0.4 * u for t, r, u in zip(towards, *screen_axes(towards, upward))]


# The command line

def vector(text):
    try:
        values = [float(part) for part in text.split(",")]
    except ValueError:
        values = []
    if len(values) != 3:
        raise argparse.ArgumentTypeError(f"'{text}': give three numbers, separated by commas")
    return values


def pixels(text):
    parts = text.split("x")
    if len(parts) != 2 or not all(part.isdigit() and int(part) > 0 for part in parts):
        raise argparse.ArgumentTypeError(f"'{text}': give width x height, as 800x600")
    return [int(part) for part in parts]


def add_plane(parser):
    parser.add_argument("--origin", type=vector, help="a point on the plane: x,y,z (the middle)")
    parser.add_argument("--normal", type=vector, help="of the plane, towards the viewer: x,y,z (the front)")


def written(path):
    if not os.path.exists(path):
        raise KitError(f"{path}: not written")


def graphical():
    """Whether this is ParaView's graphical program, where a script has no arguments and must not exit."""
    return not sys.argv or not sys.argv[0]


def start(name):
    """Whether a script runs: as program, as ParaView state or by --script, but not when it is imported."""
    return name in ("__main__", "__vtkconsole__")


def complete(options):
    if getattr(options, "normal", None) is None:
        options.normal = FRONT[options.up]
    return options


def defaults(add_arguments, options):
    """The options of a script that another one uses: what is common to both, and defaults."""
    parser = argparse.ArgumentParser()
    add_arguments(parser)
    return complete(parser.parse_args([], argparse.Namespace(**vars(options))))


def clear(view):
    for source in simple.GetSources().values():
        simple.Hide(source, view)


def settle(selected):
    """For who works on in the graphical program: no handles of planes over the scene, and what was selected
    before (or the first file) selected again, for the next macro."""
    sources = list(simple.GetSources().values())
    for source in sources:
        simple.HideInteractiveWidgets(source)
    files = [source for source in sources if file_of(source)]
    if selected or files:
        simple.SetActiveSource(selected or files[0])


def run(script, text, build, add_arguments, arguments=None, scene=True):
    """Parses, builds, saves. In the graphical program what is selected takes the place of files.

    scene: the script makes a scene, and may save a picture of it.
    """
    if arguments is None:
        arguments = sys.argv[1:] or shlex.split(os.environ.get("CELLOCUT_ARGUMENTS", ""))
    parser = argparse.ArgumentParser(prog=script, description=text,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="*", help="a folder of --save-stages or its run.vtm, or single files")
    parser.add_argument("--size", type=pixels, default=[800, 600], help="of the picture (800x600)")
    parser.add_argument("--up", choices=["y", "z"], default="z", help="axis that points up (z)")
    if scene:
        parser.add_argument("--screenshot", help="a PNG to write")
    add_arguments(parser)
    options = complete(parser.parse_args(arguments))
    try:
        view = simple.GetActiveViewOrCreate("RenderView")
        if not graphical():
            view.ViewSize = options.size
            view.OrientationAxesVisibility = 0
        if scene:
            options.files = options.files or files_of_active_source()
            clear(view)
        selected = simple.GetActiveSource()
        build(options, view)
        if graphical():
            settle(selected)
        simple.Render(view)
        if scene and options.screenshot:
            simple.SaveScreenshot(options.screenshot, view, ImageResolution=options.size,
                                  OverrideColorPalette=PALETTE)
            written(options.screenshot)
    except KitError as error:
        print(f"{script}: {error}", file=sys.stderr)
        if not graphical():
            sys.exit(2)

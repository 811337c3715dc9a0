#!/usr/bin/python3
"""Clay views of one or several meshes, side by side, as one PNG.

    xvfb-run -a python3 viz/clay.py --out picture.png --direction 1,-1,0.6 \
        before.obj after.obj --labels "input" "output"

A flat neutral material under soft lights on white. Sides of faces that look away from their normal get
another colour, so that a single-layer or inconsistently oriented surface shows its inside. All panels
share one camera and one scale. Reads OBJ, PLY, STL and VTP. Needs VTK's Python modules (Debian:
python3-vtk9) and a display; `xvfb-run` gives one where there is none.
"""

import argparse
import os
import sys

import vtkmodules.vtkRenderingFreeType  # noqa: F401  (text)
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401  (the renderer itself)
from vtkmodules.vtkCommonCore import vtkCommand, vtkLogger
from vtkmodules.vtkCommonDataModel import vtkBoundingBox, vtkPlane
from vtkmodules.vtkFiltersCore import vtkClipPolyData, vtkPolyDataNormals, vtkTriangleFilter
from vtkmodules.vtkIOGeometry import vtkOBJReader, vtkSTLReader
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkIOPLY import vtkPLYReader
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader
from vtkmodules.vtkRenderingCore import (
    vtkActor,
    vtkLight,
    vtkPolyDataMapper,
    vtkProperty,
    vtkRenderer,
    vtkRenderWindow,
    vtkTextActor,
    vtkWindowToImageFilter,
)

READERS = {
    ".obj": vtkOBJReader,
    ".ply": vtkPLYReader,
    ".stl": vtkSTLReader,
    ".vtp": vtkXMLPolyDataReader,
}
CLAY = (0.88, 0.85, 0.80)
INSIDE = (0.86, 0.40, 0.28)


class ClayError(Exception):
    """What the user did wrong, in one line."""


def numbers(count):
    """A parser of `count` comma-separated numbers for argparse."""

    def parse(text):
        try:
            values = tuple(float(part) for part in text.split(","))
        except ValueError:
            values = ()
        if len(values) != count:
            raise argparse.ArgumentTypeError(f"'{text}': give {count} numbers, separated by commas")
        return values

    return parse


def direction(text):
    values = numbers(3)(text)
    if not any(values):
        raise argparse.ArgumentTypeError("a direction must not be zero")
    return values


def parse_arguments(arguments):
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("meshes", nargs="+", help="OBJ, PLY, STL or VTP files")
    parser.add_argument("--out", required=True, help="the PNG to write")
    parser.add_argument("--direction", type=direction, default=(1.0, -1.0, 0.6),
                        help="from the mesh towards the camera (default 1,-1,0.6; write "
                             "--direction=-1,0,0 where it begins with a minus)")
    parser.add_argument("--up", type=direction, default=(0.0, 0.0, 1.0),
                        help="upwards in the picture (default 0,0,1)")
    parser.add_argument("--labels", nargs="*", default=[], help="one text per panel")
    parser.add_argument("--size", type=int, default=800,
                        help="pixels of the edge of a panel (default 800)")
    parser.add_argument("--inside", type=numbers(3), default=INSIDE,
                        help="red,green,blue (0 to 1) of the back of faces")
    parser.add_argument("--one-colour", action="store_true",
                        help="the back of faces like their front")
    parser.add_argument("--clip", type=numbers(4), metavar="NX,NY,NZ,OFFSET",
                        help="keep only where dot(n, x) <= offset, to show the inside")
    parser.add_argument("--smooth", type=float, metavar="DEGREES",
                        help="shade smoothly across edges below this angle (default: flat)")
    parser.add_argument("--zoom", type=float, default=1.0, help="above 1 is closer (default 1)")
    parser.add_argument("--fit", choices=["all", "each"], default="all",
                        help="one camera for all panels (default), or each panel fits its mesh")
    options = parser.parse_args(arguments)
    if options.labels and len(options.labels) != len(options.meshes):
        parser.error(f"{len(options.labels)} labels for {len(options.meshes)} meshes")
    if not 16 <= options.size <= 8192:
        parser.error("--size is 16 to 8192 pixels")
    if options.zoom <= 0:
        parser.error("--zoom is above 0")
    return options


def read_mesh(path):
    """All triangles of the file, unmerged."""
    ending = os.path.splitext(path)[1].lower()
    if ending not in READERS:
        raise ClayError(f"{path}: reads {', '.join(READERS)}, not '{ending}'")
    if not os.path.isfile(path):
        raise ClayError(f"{path}: no such file")
    reader = READERS[ending]()
    errors = []
    reader.AddObserver(vtkCommand.ErrorEvent, lambda *_: errors.append(1))
    reader.SetFileName(path)
    triangles = vtkTriangleFilter()
    triangles.PassVertsOff()
    triangles.PassLinesOff()
    triangles.SetInputConnection(reader.GetOutputPort())
    triangles.Update()
    mesh = triangles.GetOutput()
    if errors or mesh.GetNumberOfCells() == 0:
        raise ClayError(f"{path}: no triangles could be read")
    # Normals and colours of the file would override the material.
    mesh.GetPointData().Initialize()
    mesh.GetCellData().Initialize()
    return mesh


def clipped(mesh, clip):
    plane = vtkPlane()
    normal, offset = clip[:3], clip[3]
    squared = sum(n * n for n in normal)
    if squared == 0:
        raise ClayError("--clip: the normal must not be zero")
    plane.SetNormal(*normal)
    plane.SetOrigin(*(n * offset / squared for n in normal))
    clipper = vtkClipPolyData()
    clipper.SetInputData(mesh)
    clipper.SetClipFunction(plane)
    clipper.InsideOutOn()
    clipper.Update()
    return clipper.GetOutput()


def smoothed(mesh, degrees):
    normals = vtkPolyDataNormals()
    normals.SetInputData(mesh)
    normals.SetFeatureAngle(degrees)
    normals.ConsistencyOff()  # orientation is shown as it is
    normals.AutoOrientNormalsOff()
    normals.Update()
    return normals.GetOutput()


def clay(colour):
    material = vtkProperty()
    material.SetColor(*colour)
    material.SetAmbient(0.24)
    material.SetDiffuse(0.80)
    material.SetSpecular(0.04)
    material.SetSpecularPower(10)
    return material


def make_actor(mesh, options):
    if options.clip:
        mesh = clipped(mesh, options.clip)
    if options.smooth is not None:
        mesh = smoothed(mesh, options.smooth)
    mapper = vtkPolyDataMapper()
    mapper.SetInputData(mesh)
    mapper.ScalarVisibilityOff()
    actor = vtkActor()
    actor.SetMapper(mapper)
    actor.SetProperty(clay(CLAY))
    actor.SetBackfaceProperty(clay(CLAY if options.one_colour else options.inside))
    if options.smooth is None:
        actor.GetProperty().SetInterpolationToFlat()
        actor.GetBackfaceProperty().SetInterpolationToFlat()
    return actor


def add_lights(renderer):
    """A key from the upper left, a fill from the right, a faint one from behind the top; they follow
    the camera, so that every direction is lit alike."""
    renderer.AutomaticLightCreationOff()
    for position, strength in (((-0.7, 0.9, 1.0), 0.70), ((0.9, 0.1, 0.8), 0.42),
                               ((0.0, 1.0, -0.6), 0.15)):
        light = vtkLight()
        light.SetLightTypeToCameraLight()
        light.SetPosition(*position)
        light.SetFocalPoint(0, 0, 0)
        light.SetIntensity(strength)
        renderer.AddLight(light)


def add_label(renderer, text, size):
    label = vtkTextActor()
    label.SetInput(text)
    style = label.GetTextProperty()
    style.SetFontSize(max(10, size // 28))
    style.SetColor(0.1, 0.1, 0.1)
    style.SetJustificationToCentered()
    label.GetPositionCoordinate().SetCoordinateSystemToNormalizedViewport()
    label.SetPosition(0.5, 0.025)
    renderer.AddActor2D(label)


def aim(renderer, box, options):
    camera = renderer.GetActiveCamera()
    centre = [0.0] * 3
    box.GetCenter(centre)
    length = sum(d * d for d in options.direction) ** 0.5
    away = [d / length for d in options.direction]
    up = list(options.up)
    cosine = sum(a * u for a, u in zip(away, up)) / sum(u * u for u in up) ** 0.5
    if abs(cosine) > 0.999:  # seen along `up`
        up = [0.0, 1.0, 0.0] if abs(away[1]) < 0.9 else [1.0, 0.0, 0.0]
    camera.SetFocalPoint(*centre)
    camera.SetPosition(*(c + a for c, a in zip(centre, away)))
    camera.SetViewUp(*up)
    camera.SetViewAngle(25)
    bounds = [0.0] * 6
    box.GetBounds(bounds)
    renderer.ResetCamera(bounds)
    camera.Zoom(1.25 * options.zoom)
    renderer.ResetCameraClippingRange()


def render(options):
    meshes = [read_mesh(path) for path in options.meshes]
    together = vtkBoundingBox()
    for mesh in meshes:
        together.AddBounds(mesh.GetBounds())
    window = vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(8)
    window.SetSize(options.size * len(meshes), options.size)
    for i, mesh in enumerate(meshes):
        renderer = vtkRenderer()
        renderer.SetViewport(i / len(meshes), 0, (i + 1) / len(meshes), 1)
        renderer.SetBackground(1, 1, 1)
        renderer.AddActor(make_actor(mesh, options))
        add_lights(renderer)
        if options.labels:
            add_label(renderer, options.labels[i], options.size)
        window.AddRenderer(renderer)
        aim(renderer, together if options.fit == "all" else vtkBoundingBox(mesh.GetBounds()),
            options)
    window.Render()
    return window


def save(window, path):
    image = vtkWindowToImageFilter()
    image.SetInput(window)
    image.ReadFrontBufferOff()
    image.SetInputBufferTypeToRGB()
    writer = vtkPNGWriter()
    # The target appears whole or not at all.
    temporary = f"{path}.{os.getpid()}.tmp"
    writer.SetFileName(temporary)
    writer.SetInputConnection(image.GetOutputPort())
    writer.Write()
    if writer.GetErrorCode() != 0 or not os.path.isfile(temporary):
        if os.path.isfile(temporary):
            os.remove(temporary)
        raise ClayError(f"{path}: cannot be written")
    os.replace(temporary, path)


def main():
    options = parse_arguments(sys.argv[1:])
    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)
    try:
        save(render(options), options.out)
    except ClayError as error:
        print(f"clay: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())

"""An orbit around a scene, as frames or as a film. In the graphical program: around what is shown, by Play.

    pvbatch viz/paraview/orbit.py stages --scene absorbed --frames 72 --output orbit.png
    pvbatch viz/paraview/orbit.py stages --scene saturation --output orbit.avi

A PNG gives a picture for each frame (orbit.0000.png and so on); .avi and .ogv are films.
"""

import importlib
import math
import os
import sys

# ParaView does not look for modules beside a script that it runs as state, and names no file for --script.
sys.path[:0] = [os.path.dirname(os.path.abspath(globals()["__file__"])) if "__file__" in globals()
                else os.environ.get("CELLOCUT_PARAVIEW", "")]

import kit  # noqa: E402
from paraview import simple  # noqa: E402


SCENES = ("section", "absorbed", "ambiguous", "disagreement", "saturation")


def circle(view, frames):
    """Positions around the focal point about the axis that points up."""
    centre = list(view.CameraFocalPoint)
    axis = kit.unit(view.CameraViewUp)
    start = [p - c for p, c in zip(view.CameraPosition, centre)]
    rise = sum(s * x for s, x in zip(start, axis))
    flat = [s - rise * x for s, x in zip(start, axis)]
    side = kit.cross(axis, flat)
    points = []
    for turn in (2.0 * math.pi * k / frames for k in range(frames)):
        points += [c + rise * x + math.cos(turn) * f + math.sin(turn) * s
                   for c, x, f, s in zip(centre, axis, flat, side)]
    return points


def build(options, view):
    if options.files:
        kit.clear(view)
        scene = importlib.import_module(options.scene)
        scene.build(kit.defaults(scene.add_arguments, options), view)
        # Upright all the way round.
        view.CameraViewUp = [0.0, float(options.up == "y"), float(options.up == "z")]
    elif not kit.graphical():
        raise kit.KitError("name the files of the scene")
    first, last = simple.CameraKeyFrame(KeyTime=0.0), simple.CameraKeyFrame(KeyTime=1.0)
    first.PositionPathPoints = circle(view, max(4, options.frames))
    first.FocalPathPoints = list(view.CameraFocalPoint)
    first.ClosedPositionPath = 1
    first.ParallelScale = last.ParallelScale = view.CameraParallelScale
    first.ViewUp = last.ViewUp = list(view.CameraViewUp)
    track = simple.GetCameraTrack(view=view)
    track.Mode = "Path-based"
    track.KeyFrames = [first, last]
    animation = simple.GetAnimationScene()
    animation.PlayMode = "Sequence"
    # The last frame would be the first one again.
    animation.NumberOfFrames = options.frames + 1
    if options.output:
        simple.SaveAnimation(options.output, view, ImageResolution=options.size,
                             FrameWindow=[0, options.frames - 1], OverrideColorPalette=kit.PALETTE)
        stem, kind = os.path.splitext(options.output)
        kit.written(f"{stem}.0000{kind}" if kind == ".png" else options.output)


def add_arguments(parser):
    parser.add_argument("--scene", choices=SCENES, default="absorbed", help="what is shown (absorbed)")
    parser.add_argument("--frames", type=int, default=72, help="of one turn (72)")
    parser.add_argument("--output", help=".png for frames, .avi or .ogv for a film")


def main(arguments=None):
    kit.run("orbit", __doc__, build, add_arguments, arguments, scene=False)


if kit.start(__name__):
    main()

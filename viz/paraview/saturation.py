"""The facets of the cut, coloured by how much of their capacity the flow uses. Cut open.

    pvbatch viz/paraview/saturation.py stages --screenshot saturation.png

Facets of the cut are saturated (1). The others lie in the initial interface alone: they were given up,
and the less flow they carry the further they were from being cut.
"""

import os
import sys

# ParaView does not look for modules beside a script that it runs as state, and names no file for --script.
sys.path[:0] = [os.path.dirname(os.path.abspath(globals()["__file__"])) if "__file__" in globals()
                else os.environ.get("CELLOCUT_PARAVIEW", "")]

import kit  # noqa: E402
from paraview import simple  # noqa: E402


def build(options, view):
    paths = kit.find(options.files, "cut_facets.vtp", (".vtp",))
    if not paths:
        raise kit.KitError(f"no cut_facets.vtp among {' '.join(options.files)}; '{kit.STAGES}' writes it")
    facets = kit.open_file(paths[0])
    kit.require(facets, "saturation", paths[0])
    box = kit.bounds(facets)
    origin = options.origin or kit.middle(box)
    half = kit.cut_away(facets, origin, options.normal, whole_cells=True)
    display = simple.Show(half, view)
    kit.colour_by(display, "saturation")
    display.Ambient, display.Diffuse, display.Specular = 0.45, 0.5, 0.0
    kit.look(view, box, kit.oblique(options.normal, options.up), options.up)


add_arguments = kit.add_plane


def main(arguments=None):
    kit.run("saturation", __doc__, build, add_arguments, arguments)


if kit.start(__name__):
    main()

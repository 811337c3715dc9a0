#!/usr/bin/env python3
"""Puts a macro for each script of the kit into ParaView's menu Macros.

    python3 viz/paraview/install_macros.py [FOLDER]

A macro is three lines that run the script where it lies, so it follows the scripts when they change. Run
this again when they have moved. FOLDER: ~/.config/ParaView/Macros, where ParaView looks.
"""

import os
import sys

SCRIPTS = ("section", "absorbed", "ambiguous", "disagreement", "saturation", "orbit")


def main():
    config = os.environ.get("XDG_CONFIG_HOME") or os.path.expanduser("~/.config")
    folder = sys.argv[1] if len(sys.argv) > 1 else os.path.join(config, "ParaView", "Macros")
    here = os.path.dirname(os.path.abspath(__file__))
    os.makedirs(folder, exist_ok=True)
    for script in SCRIPTS:
        with open(os.path.join(folder, f"CelloCut_{script}.py"), "w", encoding="utf-8") as macro:
            macro.write(f"import sys\nsys.path[:0] = [{here!r}]\nimport {script}\n{script}.main([])\n")
    print(f"{len(SCRIPTS)} macros in {folder}")


if __name__ == "__main__":
    main()

"""SVG plots of a suite: times of the methods, and measures against the parameter that a suite varies."""
import os
import statistics

os.environ.setdefault("MPLCONFIGDIR", os.path.abspath(".cache/matplotlib"))  # nothing outside the output folder
import matplotlib  # pylint: disable=wrong-import-position

matplotlib.use("svg")
matplotlib.rcParams["svg.hashsalt"] = "cellocut"  # the same file for the same numbers
from matplotlib import pyplot  # pylint: disable=wrong-import-position

MEASURES = {"cd": "Chamfer distance", "hd": "Hausdorff distance", "anc": "normal consistency", "f1_0.01": "F1 at 0.01",
            "volume_relative": "volume / edge^3"}


def save(figure, path):
    figure.tight_layout()
    figure.savefig(path, metadata={"Date": None})
    pyplot.close(figure)


def draw_times(suite, rows):
    """Sorted times: how many meshes are done within so many seconds."""
    figure, axes = pyplot.subplots(figsize=(6, 4))
    drawn = False
    for name in suite.methods:
        done = sorted(rows[name, mesh]["seconds"] for mesh in suite.meshes if rows[name, mesh]["status"] == "ok")
        if done:
            drawn = True
            axes.step(done, range(1, len(done) + 1), where="post", label=name)
    if drawn:
        axes.set_xscale("log")
        axes.set_xlabel("seconds")
        axes.set_ylabel(f"meshes done, of {len(suite.meshes)}")
        axes.legend(fontsize="small")
    save(figure, "times.svg")


def draw_parameter(suite, rows, plot):
    """Means over meshes against one parameter, a panel for each measure, a line for each method."""
    key = plot["parameter"]
    measures = [name for name in plot.get("measures", MEASURES) if name in MEASURES]
    figure, panels = pyplot.subplots(1, len(measures), figsize=(3.2 * len(measures), 3.2), squeeze=False)
    bases = list(dict.fromkeys(method.base for method in suite.methods.values() if key in method.values))
    for axes, measure in zip(panels[0], measures):
        for base in bases:
            places, means = [], []
            for name, method in suite.methods.items():
                found = [rows[name, mesh][measure] for mesh in suite.meshes if rows[name, mesh][measure] is not None]
                if method.base == base and key in method.values and found:
                    places.append(float(method.values[key][1]))
                    means.append(statistics.fmean(found))
            axes.plot(places, means, marker="o", label=base)
        if plot.get("log", True):
            axes.set_xscale("log")
        axes.set_xlabel(key)
        axes.set_title(MEASURES[measure], fontsize="small")
        axes.tick_params(labelsize="x-small")
    if len(bases) > 1:
        panels[0][0].legend(fontsize="x-small")
    save(figure, f"{key}.svg")


def draw(suite, rows):
    draw_times(suite, rows)
    if suite.plot:
        draw_parameter(suite, rows, suite.plot)

"""Opens the stages of a run by VTK and holds them against its report.

    /usr/bin/python3 read_stages.py run.vtm report.json

Ends with 77 where VTK is not installed.
"""
import json
import pathlib
import sys

try:
    import numpy
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkCommonDataModel import vtkCompositeDataSet
    from vtkmodules.vtkIOXML import vtkXMLMultiBlockDataReader
except ImportError as missing:
    print(missing)
    sys.exit(77)


def main(collection, report):
    reader = vtkXMLMultiBlockDataReader()
    reader.SetFileName(collection)
    reader.Update()
    data = reader.GetOutput()
    blocks = {data.GetMetaData(i).Get(vtkCompositeDataSet.NAME()): data.GetBlock(i)
              for i in range(data.GetNumberOfBlocks())}

    def array(block, name):
        return vtk_to_numpy(blocks[block].GetCellData().GetArray(name))

    assert blocks["input"].GetNumberOfCells() == report["input"]["triangles"]
    assert blocks["output"].GetNumberOfCells() == report["output"]["triangles"]
    assert blocks["cells"].GetNumberOfCells() == report["counts"]["cells"]
    # The holed ball has a border and nothing else that is wrong.
    assert set(array("input", "defect")) == {0, 1}
    assert numpy.array_equal(array("input", "defect"), array("input", "boundary"))
    # What is cut is saturated and costs the energy; no facet carries more than it can.
    cut = array("cut_facets", "cut") == 1
    area, weight, flow = (array("cut_facets", name) for name in ("area", "weight", "flow"))
    saturation = array("cut_facets", "saturation")
    assert cut.any() and (saturation[cut] == 1).all() and (saturation >= 0).all() and (saturation <= 1).all()
    energy = report["cut"]["energy"]
    assert abs((area * weight)[cut].sum() - energy) < 1e-9 * energy
    assert numpy.allclose(flow, saturation * area * weight)
    supported = array("cut_facets", "supported")
    assert set(supported) <= {0, 1} and numpy.array_equal(weight == 1, supported == 1)


main(sys.argv[1], json.loads(pathlib.Path(sys.argv[2]).read_text()))

"""Reads a .vtu by VTK and by meshio, and compares them array for array.

    /usr/bin/python3 compare_readers.py cells.vtu

Ends with 77 where one of the two is not installed.
"""
import pathlib
import sys
import tempfile

try:
    import meshio
    import numpy
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
except ImportError as missing:
    print(missing)
    sys.exit(77)


def read_by_meshio(path):
    # meshio looks for `DataArray` alone where data are appended, and VTK names texts `Array`: in a copy
    # they are called bytes, so that it finds its way past them. Nothing else is touched.
    with tempfile.TemporaryDirectory() as folder:
        copy = pathlib.Path(folder) / "cells.vtu"
        copy.write_bytes(path.read_bytes().replace(b'<Array type="String"', b'<DataArray type="Int8"'))
        return meshio.read(copy)


def read_by_vtk(path):
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


def same(a, b):
    return a.dtype == b.dtype and numpy.array_equal(a, b, equal_nan=a.dtype.kind == "f")


def main(path):
    ours, theirs = read_by_vtk(path), read_by_meshio(path)
    assert same(vtk_to_numpy(ours.GetPoints().GetData()), theirs.points), "points"
    tetrahedra, = theirs.cells
    assert tetrahedra.type == "tetra"
    corners = vtk_to_numpy(ours.GetCells().GetConnectivityArray()).reshape(-1, 4)
    assert same(corners, tetrahedra.data), "cells"
    data = ours.GetCellData()
    names = [data.GetArrayName(k) for k in range(data.GetNumberOfArrays())]
    assert sorted(names) == sorted(theirs.cell_data), names
    for name in names:
        assert same(vtk_to_numpy(data.GetArray(name)), theirs.cell_data[name][0]), name
    print(f"{len(corners)} cells, {len(names)} arrays: {' '.join(names)}")


main(pathlib.Path(sys.argv[1]))

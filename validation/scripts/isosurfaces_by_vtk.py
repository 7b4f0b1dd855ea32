"""Isosurfaces of Q that wakemix wrote, beside those that the Visualization Toolkit draws of the same averages by phase.

    python3 -m venv .venv && .venv/bin/pip install vtk netCDF4 numpy
    wakemix run validation/cases/isosurfaces.toml -o runs/isosurfaces
    wakemix analyse vortices runs/isosurfaces/helix --surfaces surfaces --level 0.2
    .venv/bin/python validation/scripts/isosurfaces_by_vtk.py runs/isosurfaces/helix/averages-wake-volume.nc surfaces 0.2

Each file is opened by VTK's own reader. VTK makes gradients and Q of the velocities by vtkGradientFilter and its surface by
vtkFlyingEdges3D (cubes, where wakemix cuts tetrahedra). Printed are, for some bins: triangles and area of both, the share of
edges that do not belong to two triangles (a surface is closed but where it leaves the volume), and the distance of wakemix's
points from VTK's surface, and of VTK's from wakemix's, over the spacing: median, of 99 % of the points, greatest.
"""

import sys
from pathlib import Path

import netCDF4
import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

N_BINS = 4


def image_of(data, index):
    axes = [np.asarray(data[name][:]) for name in "xyz"]
    image = vtk.vtkImageData()
    image.SetDimensions(*(len(axis) for axis in axes))
    image.SetOrigin(*(axis[0] for axis in axes))
    image.SetSpacing(*(axis[1] - axis[0] for axis in axes))
    velocity = np.stack([np.asarray(data[name][index], dtype=float).ravel() for name in "uvw"], axis=1)
    values = numpy_to_vtk(velocity, deep=True)
    values.SetName("velocity")
    image.GetPointData().SetVectors(values)
    return image


def surface_by_vtk(image, level):
    gradient = vtk.vtkGradientFilter()
    gradient.SetInputData(image)
    gradient.SetInputScalars(vtk.vtkDataObject.FIELD_ASSOCIATION_POINTS, "velocity")
    gradient.ComputeQCriterionOn()
    gradient.SetQCriterionArrayName("q")
    gradient.Update()
    found = gradient.GetOutput()
    found.GetPointData().SetActiveScalars("q")
    edges = vtk.vtkFlyingEdges3D()
    edges.SetInputData(found)
    edges.SetValue(0, level)
    edges.Update()
    return edges.GetOutput()


def area(surface):
    measure = vtk.vtkMassProperties()
    measure.SetInputData(surface)
    measure.Update()
    return measure.GetSurfaceArea()


def share_of_open_edges(surface):
    triangles = vtk_to_numpy(surface.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    edges = np.sort(np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]), axis=1)
    _, counts = np.unique(edges, axis=0, return_counts=True)
    return np.mean(counts != 2)


def distances(surface, other):
    locator = vtk.vtkCellLocator()
    locator.SetDataSet(other)
    locator.BuildLocator()
    points = vtk_to_numpy(surface.GetPoints().GetData())
    cell, part, square, nearest = vtk.vtkGenericCell(), vtk.reference(0), vtk.reference(0.0), [0.0] * 3
    number = vtk.reference(0)
    found = np.empty(len(points))
    for index, point in enumerate(points):
        locator.FindClosestPoint(point.astype(float), nearest, cell, number, part, square)
        found[index] = square.get() ** 0.5
    return found


def main(averages, folder, level):
    data = netCDF4.Dataset(averages)
    level *= (data.wind_speed_m_s / data.rotor_diameter_m) ** 2
    files = sorted(Path(folder).glob("q-*.vtp"))
    for index in range(0, len(files), max(1, len(files) // N_BINS)):
        reader = vtk.vtkXMLPolyDataReader()
        reader.SetFileName(str(files[index]))
        reader.Update()
        own, image = reader.GetOutput(), image_of(data, index)
        other = surface_by_vtk(image, level)
        if own.GetNumberOfPolys() == 0 or other.GetNumberOfPolys() == 0:
            print(f"{files[index].name}: triangles {own.GetNumberOfPolys()} and {other.GetNumberOfPolys()}")
            continue
        both = [distances(*pair) / image.GetSpacing()[0] for pair in [(own, other), (other, own)]]
        apart = [f"{np.median(one):.4f}, {np.quantile(one, 0.99):.3f}, {one.max():.3f}" for one in both]
        arrays = [own.GetPointData().GetArrayName(k) for k in range(own.GetPointData().GetNumberOfArrays())]
        print(
            f"{files[index].name} ({', '.join(arrays)}): triangles {own.GetNumberOfPolys()} and {other.GetNumberOfPolys()}; "
            f"area {area(own):.1f} and {area(other):.1f} m2, {100 * (area(own) / area(other) - 1):+.2f} %; "
            f"open edges {100 * share_of_open_edges(own):.2f} and {100 * share_of_open_edges(other):.2f} %; apart "
            f"{apart[0]} and {apart[1]} cells"
        )


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2], float(sys.argv[3]))

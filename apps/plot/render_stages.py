#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Renders the equilibrium states of a 3D run that removes particles in stages, cut open along two planes through the hole
and coloured by the equivalent plastic deviatoric strain, as Figure 19.

    /usr/bin/python3 apps/plot/render_stages.py results/wellbore         NAME_cut_open.png

Every particle is a cube of the lattice, drawn by VTK without a window. Debian's VTK draws through an X server: where none is
at hand (a server, a container) the script starts a virtual one, which needs the package xvfb.
"""
import argparse
import os
import shutil
import sys

try:
    import h5py  # noqa: F401
    import numpy as np
    import vtk
    from vtk.util.numpy_support import numpy_to_vtk
except ImportError as error:
    sys.exit(f"render_stages.py: {error}; on Debian: apt-get install python3-h5py python3-vtk9, and use /usr/bin/python3")

from particle_boxes import whole_particles
from stage_frames import StagedRun, State


def be_seen():
    """Goes on under a virtual X server where there is none: VTK would abort the program."""
    if os.environ.get("DISPLAY") or vtk.vtkRenderWindow().GetClassName() != "vtkXOpenGLRenderWindow":
        return
    if not shutil.which("xvfb-run"):
        sys.exit("render_stages.py: there is no X server (DISPLAY is not set), and no xvfb-run to start a virtual one; on Debian: "
                 "apt-get install xvfb xauth. The slices of plot_stages.py need neither.")
    os.execvp("xvfb-run", ["xvfb-run", "-a", "-s", "-screen 0 1600x1200x24", sys.executable, *sys.argv])


def outer_particles(state):
    """Those in a box of the lattice with a free one beside it: nothing else can be seen."""
    whole = whole_particles(state.mass)
    at = np.round((state.start - state.start[whole][0]) / state.sizes[whole][0]).astype(int)
    at -= at.min(axis=0)
    box = np.zeros(at.max(axis=0) + 3, dtype=bool)
    box[tuple((at + 1).T)] = True
    inside = np.ones(len(at), dtype=bool)
    for axis in range(3):
        for side in (0, 2):
            neighbour = at + 1
            neighbour[:, axis] += side - 1
            inside &= box[tuple(neighbour.T)]
    return ~inside


def cubes(state, seen, colours):
    points = vtk.vtkPoints()
    points.SetData(numpy_to_vtk(1e3 * state.x[seen], deep=True))
    cloud = vtk.vtkPolyData()
    cloud.SetPoints(points)
    values = numpy_to_vtk(state.strain[seen], deep=True)
    values.SetName("strain")
    cloud.GetPointData().SetScalars(values)
    edges = numpy_to_vtk(1.02e3 * state.sizes[seen], deep=True)
    edges.SetName("edges")
    cloud.GetPointData().AddArray(edges)
    mapper = vtk.vtkGlyph3DMapper()
    mapper.SetInputData(cloud)
    mapper.SetSourceConnection(vtk.vtkCubeSource().GetOutputPort())
    mapper.SetScaleArray("edges")
    mapper.SetScaleModeToScaleByVectorComponents()
    mapper.SetLookupTable(colours)
    mapper.SetScalarRange(*colours.GetRange())
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetAmbient(0.4)
    actor.GetProperty().SetDiffuse(0.65)
    return actor


def colour_table(highest):
    """Light yellow to black, as in the slices."""
    function = vtk.vtkColorTransferFunction()
    for at, rgb in ((0, (0.99, 0.98, 0.80)), (0.25, (0.98, 0.65, 0.10)), (0.5, (0.80, 0.22, 0.30)), (0.75, (0.42, 0.09, 0.43)),
                    (1, (0.05, 0.02, 0.12))):
        function.AddRGBPoint(at, *rgb)
    table = vtk.vtkLookupTable()
    table.SetNumberOfTableValues(256)
    for i in range(256):
        table.SetTableValue(i, *function.GetColor(i / 255), 1)
    table.SetRange(0, highest)
    return table


def caption(words, height, size):
    text = vtk.vtkTextActor()
    text.SetInput(words)
    text.GetTextProperty().SetFontSize(size)
    text.GetTextProperty().SetColor(0, 0, 0)
    text.GetTextProperty().SetJustificationToCentered()
    text.GetPositionCoordinate().SetCoordinateSystemToNormalizedViewport()
    text.SetPosition(0.5, height)
    return text


def panel(window, viewport, title, actor, colours):
    renderer = vtk.vtkRenderer()
    renderer.SetViewport(*viewport)
    renderer.SetBackground(1, 1, 1)
    renderer.AddActor(actor)
    renderer.AddActor2D(caption(title, 0.94, 22))
    if colours:
        bar = vtk.vtkScalarBarActor()
        bar.SetLookupTable(colours)
        bar.UnconstrainedFontSizeOn()
        labels = bar.GetLabelTextProperty()
        labels.SetColor(0, 0, 0)
        labels.SetFontSize(16)
        labels.BoldOff()
        labels.ItalicOff()
        labels.ShadowOff()
        bar.SetOrientationToHorizontal()
        bar.SetLabelFormat("%.4f")
        bar.SetNumberOfLabels(4)
        bar.SetPosition(0.1, 0.02)
        bar.SetWidth(0.8)
        bar.SetHeight(0.07)
        renderer.AddActor2D(bar)
        renderer.AddActor2D(caption("equivalent plastic strain", 0.1, 16))
    camera = renderer.GetActiveCamera()
    camera.SetFocalPoint(0, 0, 0)
    camera.SetPosition(1, 1, 0.9)
    camera.SetViewUp(0, 0, 1)
    renderer.ResetCamera()
    camera.Zoom(1.12)
    window.AddRenderer(renderer)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("directory")
    parser.add_argument("--highest", type=float, default=0.006, help="strain at the end of the colours (default: %(default)s)")
    options = parser.parse_args()
    run = StagedRun(options.directory, "render_stages.py")
    if run.dimension != 3:
        run.fail("is of a plane scene; plot_stages.py draws it")
    be_seen()
    colours = colour_table(options.highest)
    stages = run.stages_with_frames()
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(4)
    window.SetSize(520 * len(stages), 640)
    for column, (number, stage) in enumerate(stages):
        state = run.read(stage["last_step"])
        kept = ~((state.start[:, 0] > 0) & (state.start[:, 1] > 0))  # the quarter towards the eye is cut out
        state = State(*(field[kept] for field in state))
        last = number == len(run.stages) and run.outcome == "collapse"
        title = f"{number}: total failure" if last else f"{number}: {stage['rows']:.1f} rows beyond the threshold"
        panel(window, (column / len(stages), 0, (column + 1) / len(stages), 1), title,
              cubes(state, outer_particles(state), colours), colours if column == 0 else None)
    window.Render()
    picture = vtk.vtkWindowToImageFilter()
    picture.SetInput(window)
    writer = vtk.vtkPNGWriter()
    name = run.directory / f"{run.name}_cut_open.png"
    writer.SetFileName(str(name))
    writer.SetInputConnection(picture.GetOutputPort())
    writer.Write()
    print(name)


if __name__ == "__main__":
    main()

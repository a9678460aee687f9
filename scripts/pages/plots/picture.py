"""Pictures of deformed bodies, drawn by VTK."""
import vtk

STOPS = ("#f4f1e6", "#fde3a2", "#fdb366", "#f0704a", "#c5305a", "#7a1a6c", "#2d1150")


def colours(largest):
    """From 0 on, light to dark, so that the mesh and the shading stay visible where nothing happens."""
    function = vtk.vtkColorTransferFunction()
    function.SetColorSpaceToLab()
    for i, stop in enumerate(STOPS):
        function.AddRGBPoint(largest * i / (len(STOPS) - 1), *(int(stop[k:k + 2], 16) / 255 for k in (1, 3, 5)))
    return function


def body(surface, array, table, edges=(0.25, 0.25, 0.25), width=1.0):
    """Coloured by an array of its points, with the edges of its facets."""
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputData(surface)
    mapper.SetScalarModeToUsePointFieldData()
    mapper.SelectColorArray(array)
    mapper.SetLookupTable(table)
    mapper.SetUseLookupTableScalarRange(True)
    mapper.InterpolateScalarsBeforeMappingOn()
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    look = actor.GetProperty()
    look.EdgeVisibilityOn()
    look.SetEdgeColor(*edges)
    look.SetLineWidth(width)
    look.SetAmbient(0.5)
    look.SetDiffuse(0.6)
    return actor


def bar(table, title, position, size, labels, form, font, gap):
    """@param position, size  of the window"""
    actor = vtk.vtkScalarBarActor()
    actor.SetLookupTable(table)
    actor.SetTitle(title)
    actor.SetNumberOfLabels(labels)
    actor.SetMaximumNumberOfColors(256)
    actor.SetLabelFormat(form)
    actor.SetOrientationToHorizontal()
    actor.SetPosition(*position)
    actor.SetWidth(size[0])
    actor.SetHeight(size[1])
    actor.SetVerticalTitleSeparation(gap)
    actor.UnconstrainedFontSizeOn()
    for text in (actor.GetTitleTextProperty(), actor.GetLabelTextProperty()):
        text.SetColor(0.1, 0.1, 0.1)
        text.ItalicOff()
        text.BoldOff()
        text.ShadowOff()
        text.SetFontSize(font)
    return actor


def save(renderer, size, file):
    """@param size  pixels"""
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(8)
    window.SetSize(*size)
    window.AddRenderer(renderer)
    window.Render()
    grab = vtk.vtkWindowToImageFilter()
    grab.SetInput(window)
    grab.ReadFrontBufferOff()
    writer = vtk.vtkPNGWriter()
    writer.SetFileName(str(file))
    writer.SetCompressionLevel(9)
    writer.SetInputConnection(grab.GetOutputPort())
    writer.Write()

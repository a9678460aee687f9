#include "osculate/core/error.hpp"
#include "osculate/output/vtk_file.hpp"
#include "output/temporary_folder.hpp"

#include <gmock/gmock.h>
#include <limits>
#include <vtkCell.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLUnstructuredGridReader.h>

namespace osculate::output::OSCULATE_THIS_FILE {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class VtkFile : public InTemporaryFolder {};

/// A hexahedron with a wedge and two tetrahedra on top of it, and ten nodes in no order.
const std::vector<Vec3> points{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},      {0, 0, 1},   {1, 0, 1},
                               {1, 1, 1}, {0, 1, 1}, {0, 0, 2}, {0, 1, 1 / 3.}, {1, 1, 1e-9}};
const std::vector<mesh::ElementBlock> blocks{{mesh::CellType::hex8, {0, 1, 2, 3, 4, 5, 6, 7}},
                                             {mesh::CellType::wedge6, {4, 5, 8, 7, 6, 9}},
                                             {mesh::CellType::tet4, {8, 9, 10, 4, 4, 5, 6, 8}},
                                             {mesh::CellType::tet10, {10, 9, 8, 7, 6, 5, 4, 3, 2, 1}},
                                             {mesh::CellType::wedge15, {4, 5, 8, 7, 6, 9, 0, 1, 2, 3, 10, 4, 5, 6, 7}}};

mesh::Facet facet(std::array<Index, 4> nodes) {
    return {nodes, nodes[3] < 0 ? 3 : 4, -1, -1};
}

std::vector<Array> awkward_arrays(std::size_t count) {
    Array scalar{"von_mises", 1, {}}, vector{"displacement", 3, {}}, tensor{"stress", 6, {}},
        status{"status", 1, {}, true};
    for (std::size_t i = 0; i < count; ++i) {
        const auto x = static_cast<double>(i);
        scalar.values.push_back(i == 0 ? std::numeric_limits<double>::denorm_min() : 1e300 / (x + 3));
        for (int c = 0; c < 3; ++c) vector.values.push_back((x + c) / 7);
        for (int c = 0; c < 6; ++c) tensor.values.push_back(-0.1 * x - c);
        status.values.push_back(static_cast<double>(i % 3));
    }
    return {scalar, vector, tensor, status};
}

void expect_same_arrays(vtkDataSet& data, const std::vector<Array>& arrays) {
    ASSERT_EQ(data.GetPointData()->GetNumberOfArrays(), static_cast<int>(arrays.size()));
    for (const Array& array : arrays) {
        vtkDataArray* read = data.GetPointData()->GetArray(array.name.c_str());
        ASSERT_NE(read, nullptr) << array.name;
        ASSERT_EQ(read->GetNumberOfComponents(), array.components) << array.name;
        EXPECT_EQ(vtkIntArray::SafeDownCast(read) != nullptr, array.integer) << array.name;
        EXPECT_EQ(vtkDoubleArray::SafeDownCast(read) != nullptr, !array.integer) << array.name;
        ASSERT_EQ(read->GetNumberOfValues(), static_cast<vtkIdType>(array.values.size())) << array.name;
        for (std::size_t i = 0; i < array.values.size(); ++i) {
            const int n = array.components, k = static_cast<int>(i);
            EXPECT_EQ(read->GetComponent(k / n, k % n), array.values[i]) << array.name << " " << i;
        }
    }
}

void expect_same_points(vtkDataSet& data) {
    ASSERT_EQ(data.GetNumberOfPoints(), static_cast<vtkIdType>(points.size()));
    for (std::size_t i = 0; i < points.size(); ++i)
        for (int c = 0; c < 3; ++c) EXPECT_EQ(data.GetPoint(static_cast<vtkIdType>(i))[c], points[i][c]);
}

void expect_cell(vtkDataSet& data, vtkIdType number, int type, const std::vector<Index>& nodes) {
    vtkCell* cell = data.GetCell(number);
    ASSERT_EQ(cell->GetCellType(), type);
    ASSERT_EQ(cell->GetNumberOfPoints(), static_cast<vtkIdType>(nodes.size()));
    for (std::size_t k = 0; k < nodes.size(); ++k) EXPECT_EQ(cell->GetPointId(static_cast<vtkIdType>(k)), nodes[k]);
}

template <class Reader> vtkNew<Reader> read(const std::filesystem::path& path) {
    vtkNew<Reader> reader;
    reader->SetFileName(path.c_str());
    reader->Update();
    return reader;
}

TEST_F(VtkFile, VolumeReadsBackAsItWas) {
    const std::vector<Array> arrays = awkward_arrays(points.size());
    write_vtu(folder / "body.vtu", points, blocks, arrays, 0.1);
    const auto reader = read<vtkXMLUnstructuredGridReader>(folder / "body.vtu");
    vtkUnstructuredGrid& grid = *reader->GetOutput();
    expect_same_points(grid);
    ASSERT_EQ(grid.GetNumberOfCells(), 6);
    expect_cell(grid, 0, VTK_HEXAHEDRON, blocks[0].connectivity);
    expect_cell(grid, 1, VTK_WEDGE, blocks[1].connectivity);
    expect_cell(grid, 2, VTK_TETRA, {8, 9, 10, 4});
    expect_cell(grid, 3, VTK_TETRA, {4, 5, 6, 8});
    expect_cell(grid, 4, VTK_QUADRATIC_TETRA, blocks[3].connectivity);
    expect_cell(grid, 5, VTK_QUADRATIC_WEDGE, blocks[4].connectivity);
    expect_same_arrays(grid, arrays);
    EXPECT_EQ(grid.GetFieldData()->GetArray("TimeValue")->GetComponent(0, 0), 0.1);
}

TEST_F(VtkFile, SurfaceReadsBackAsItWas) {
    const std::vector<Array> arrays = awkward_arrays(points.size());
    write_vtp(folder / "surface.vtp", points, {facet({0, 1, 2, 3}), facet({4, 5, 8, -1})}, arrays, -2.5);
    const auto reader = read<vtkXMLPolyDataReader>(folder / "surface.vtp");
    vtkPolyData& surface = *reader->GetOutput();
    expect_same_points(surface);
    ASSERT_EQ(surface.GetNumberOfCells(), 2);
    expect_cell(surface, 0, VTK_QUAD, {0, 1, 2, 3});
    expect_cell(surface, 1, VTK_TRIANGLE, {4, 5, 8});
    expect_same_arrays(surface, arrays);
    EXPECT_EQ(surface.GetFieldData()->GetArray("TimeValue")->GetComponent(0, 0), -2.5);
}

TEST_F(VtkFile, NamesTensorComponentsInVoigtOrder) {
    write_vtu(folder / "body.vtu", points, blocks, awkward_arrays(points.size()), 0);
    const auto reader = read<vtkXMLUnstructuredGridReader>(folder / "body.vtu");
    vtkDataArray* stress = reader->GetOutput()->GetPointData()->GetArray("stress");
    const std::vector<std::string> names{"XX", "YY", "ZZ", "XY", "YZ", "XZ"};
    for (int c = 0; c < 6; ++c) {
        ASSERT_NE(stress->GetComponentName(c), nullptr);
        EXPECT_EQ(stress->GetComponentName(c), names[static_cast<std::size_t>(c)]);
    }
}

TEST_F(VtkFile, IsAppendedAndCompressedWithLz4) {
    write_vtu(folder / "body.vtu", points, blocks, {}, 0);
    const std::string text = content(folder / "body.vtu");
    EXPECT_THAT(text, AllOf(HasSubstr("vtkLZ4DataCompressor"), HasSubstr("<AppendedData encoding=\"raw\">"),
                            HasSubstr("header_type=\"UInt64\"")));
}

TEST_F(VtkFile, EmptySurfaceIsAValidFile) {
    write_vtp(folder / "empty.vtp", {}, {}, {{"gap", 1, {}}}, 0);
    EXPECT_EQ(read<vtkXMLPolyDataReader>(folder / "empty.vtp")->GetOutput()->GetNumberOfPoints(), 0);
}

TEST_F(VtkFile, MakesTheFolderItLiesIn) {
    write_vtp(folder / "a" / "b" / "surface.vtp", points, {}, {}, 0);
    EXPECT_TRUE(std::filesystem::is_regular_file(folder / "a" / "b" / "surface.vtp"));
}

TEST_F(VtkFile, RejectsArraysThatDoNotFitThePoints) {
    EXPECT_THROW(write_vtu(folder / "a.vtu", points, blocks, {{"gap", 1, {1.0, 2.0}}}, 0), InternalError);
    EXPECT_THROW(write_vtp(folder / "a.vtp", points, {}, {{"uv", 2, std::vector<double>(2 * points.size())}}, 0),
                 InternalError);
    EXPECT_EQ(files_in(folder), 0U);
}

TEST_F(VtkFile, ErrorNamesPathAndReason) {
    std::ofstream(folder / "file") << "in the way";
    const auto path = folder / "file" / "body.vtu";
    EXPECT_THAT(runtime_error_of([&] { write_vtu(path, points, blocks, {}, 0); }),
                AllOf(HasSubstr(path.string()), HasSubstr("Not a directory")));
    std::filesystem::create_directory(folder / "taken.vtp");
    EXPECT_THAT(runtime_error_of([&] { write_vtp(folder / "taken.vtp", points, {}, {}, 0); }),
                AllOf(HasSubstr("taken.vtp"), HasSubstr("Is a directory")));
    EXPECT_EQ(files_in(folder), 2U) << "a part file was left behind";
}

TEST_F(VtkFile, FullDiskLeavesTheFileOfBefore) {
    const auto path = folder / "body.vtu";
    write_vtu(path, points, blocks, {}, 1);
    const std::string before = content(path);
    std::string message;
    {
        const FullDisk full(before.size() / 2);
        message = runtime_error_of([&] { write_vtu(path, points, blocks, awkward_arrays(points.size()), 2); });
    }
    EXPECT_THAT(message, AllOf(HasSubstr(path.string()), HasSubstr("File too large")));
    EXPECT_EQ(content(path), before);
    EXPECT_EQ(files_in(folder), 1U) << "a part file was left behind";
}

TEST_F(VtkFile, ReaderOfTheFileOfBeforeKeepsIt) {
    const auto path = folder / "body.vtu";
    write_vtu(path, points, blocks, {}, 1);
    const std::string before = content(path);
    std::ifstream reader(path, std::ios::binary); // opened before, read after: a rename leaves it the old file
    write_vtu(path, points, blocks, awkward_arrays(points.size()), 2);
    std::ostringstream seen;
    seen << reader.rdbuf();
    EXPECT_EQ(seen.str(), before);
    EXPECT_NE(content(path), before);
}

} // namespace
} // namespace osculate::output::OSCULATE_THIS_FILE

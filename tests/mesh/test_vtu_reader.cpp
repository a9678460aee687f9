#include "mesh/shapes.hpp"
#include "osculate/mesh/quality.hpp"
#include "osculate/mesh/vtu_reader.hpp"

#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>
#include <set>
#include <stdexcept>
#include <vtkCell.h>
#include <vtkCellType.h>
#include <vtkGenericCell.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridWriter.h>

namespace osculate::mesh::OSCULATE_THIS_FILE {
namespace {

using fixtures::all_shapes;
using fixtures::Shape;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

void add_cell(vtkUnstructuredGrid* grid, int type, const std::vector<vtkIdType>& points) {
    grid->InsertNextCell(type, static_cast<vtkIdType>(points.size()), points.data());
}

vtkNew<vtkUnstructuredGrid> make_grid(const Mesh& mesh) {
    vtkNew<vtkUnstructuredGrid> grid;
    const vtkNew<vtkPoints> points;
    points->SetDataTypeToDouble();
    for (const Vec3& node : mesh.nodes) points->InsertNextPoint(node.data());
    grid->SetPoints(points);
    grid->Allocate(mesh.element_count());
    for (const ElementBlock& block : mesh.blocks) {
        const int stride = nodes_per_cell(block.type);
        for (Index e = 0; e < block.size(); ++e) {
            const auto first = block.connectivity.begin() + e * stride;
            add_cell(grid, cell_info(block.type).vtk, {first, first + stride});
        }
    }
    return grid;
}

template <class Array>
void add_array(vtkUnstructuredGrid* grid, const char* name, const std::vector<Index>& nodes, int value = 1) {
    const vtkNew<Array> array;
    array->SetName(name);
    array->SetNumberOfTuples(grid->GetNumberOfPoints());
    array->Fill(0);
    for (const Index node : nodes) array->SetComponent(node, 0, value);
    grid->GetPointData()->AddArray(array);
}

TEST(CellTypes, AreVtksWithTheSameFacesAndEdges) {
    for (const CellInfo& info : cell_types()) {
        SCOPED_TRACE(info.name);
        const vtkSmartPointer<vtkCell> cell = vtkSmartPointer<vtkCell>::Take(vtkGenericCell::InstantiateCell(info.vtk));
        ASSERT_EQ(cell->GetNumberOfPoints(), info.nodes);
        for (int i = 0; i < info.nodes; ++i) cell->GetPointIds()->SetId(i, i);
        const auto points_of = [](vtkCell* part) {
            std::set<vtkIdType> points;
            for (vtkIdType i = 0; i < part->GetNumberOfPoints(); ++i) points.insert(part->GetPointId(i));
            return points;
        };
        std::set<std::set<vtkIdType>> faces, vtks_faces, vtks_edges;
        for (const LocalFace& face : info.faces) {
            const auto local = info.face_nodes(face);
            faces.emplace(local.nodes.begin(), local.nodes.begin() + local.count);
        }
        for (int f = 0; f < cell->GetNumberOfFaces(); ++f) vtks_faces.insert(points_of(cell->GetFace(f)));
        EXPECT_EQ(faces, vtks_faces);
        for (int e = 0; e < cell->GetNumberOfEdges(); ++e) vtks_edges.insert(points_of(cell->GetEdge(e)));
        for (const auto& [a, b] : info.edges) EXPECT_TRUE(vtks_edges.contains({a, b, info.midway(a, b)}));
    }
}

class VtuReader : public ::testing::Test {
protected:
    std::filesystem::path path =
        std::filesystem::path(::testing::TempDir()) /
        (std::string("osculate_") + ::testing::UnitTest::GetInstance()->current_test_info()->name() + ".vtu");

    void SetUp() override { std::filesystem::remove(path); }
    void TearDown() override { std::filesystem::remove(path); }

    void write(vtkUnstructuredGrid* grid) const {
        const vtkNew<vtkXMLUnstructuredGridWriter> writer;
        writer->SetFileName(path.c_str());
        writer->SetInputData(grid);
        ASSERT_EQ(writer->Write(), 1);
    }

    void write(const std::string& text) const { std::ofstream(path) << text; }

    /// The message of the error, which alone may speak: nothing goes to the terminal.
    [[nodiscard]] std::string error() const {
        ::testing::internal::CaptureStderr();
        std::string message;
        try {
            (void)read_vtu(path);
        } catch (const std::runtime_error& caught) {
            message = caught.what();
        }
        EXPECT_THAT(::testing::internal::GetCapturedStderr(), IsEmpty());
        return message;
    }
};

TEST_F(VtuReader, ReadsBackEveryShape) {
    for (const Shape& shape : all_shapes()) {
        write(make_grid(shape.mesh));
        const Mesh mesh = read_vtu(path);
        EXPECT_EQ(mesh.nodes, shape.mesh.nodes) << shape.name;
        ASSERT_EQ(mesh.blocks.size(), shape.mesh.blocks.size()) << shape.name;
        for (std::size_t b = 0; b < mesh.blocks.size(); ++b) {
            EXPECT_EQ(mesh.blocks[b].type, shape.mesh.blocks[b].type) << shape.name;
            EXPECT_EQ(mesh.blocks[b].connectivity, shape.mesh.blocks[b].connectivity) << shape.name;
        }
        EXPECT_THAT(faults(mesh), IsEmpty()) << shape.name;
    }
}

TEST_F(VtuReader, TurnsMembershipArraysIntoSetsAndSurfaces) {
    const Mesh block = make_block({0, 0, 0}, {1, 1, 1}, {2, 2, 2});
    auto grid = make_grid(block);
    std::vector<Index> top;
    for (Index n = 0; n < block.node_count(); ++n)
        if (block.nodes[n].z() == 1) top.push_back(n);
    add_array<vtkIntArray>(grid, "lid", top);
    add_array<vtkIntArray>(grid, "pin", {4});
    add_array<vtkIntArray>(grid, "material", {3, 4}, 7);
    write(grid);
    const Mesh mesh = read_vtu(path);
    EXPECT_EQ(mesh.node_sets.size(), 2u) << "a value that is neither 0 nor 1 makes no set";
    EXPECT_EQ(mesh.node_sets.at("lid"), top);
    EXPECT_THAT(mesh.node_sets.at("pin"), ElementsAre(4));
    EXPECT_EQ(mesh.surfaces.size(), 1u);
    ASSERT_EQ(mesh.surfaces.at("lid").size(), 4u);
    for (std::size_t f = 0; f < 4; ++f)
        EXPECT_EQ(mesh.surfaces.at("lid")[f].nodes, block.surfaces.at("z_max")[f].nodes);
}

TEST_F(VtuReader, IgnoresSurfaceCellsAndTheirPoints) {
    const Mesh block = make_block({0, 0, 0}, {1, 1, 1}, {1, 1, 1});
    Mesh padded = block;
    padded.nodes.insert(padded.nodes.begin(), Vec3(9, 9, 9));
    for (Index& node : padded.blocks[0].connectivity) ++node;
    auto grid = make_grid(padded);
    add_cell(grid, VTK_TRIANGLE, {0, 1, 2});
    add_cell(grid, VTK_QUAD, {1, 2, 3, 4});
    add_cell(grid, VTK_LINE, {0, 1});
    add_cell(grid, VTK_VERTEX, {0});
    add_array<vtkIntArray>(grid, "pair", {0, 3});
    write(grid);
    const Mesh mesh = read_vtu(path);
    EXPECT_EQ(mesh.nodes, block.nodes);
    EXPECT_EQ(mesh.blocks[0].connectivity, block.blocks[0].connectivity);
    EXPECT_THAT(mesh.node_sets.at("pair"), ElementsAre(2));
}

TEST_F(VtuReader, ReadsVoxelsAsHexahedra) {
    const Mesh block = make_block({0, 0, 0}, {1, 1, 1}, {1, 1, 1});
    vtkNew<vtkUnstructuredGrid> grid;
    const vtkNew<vtkPoints> points;
    for (const Vec3& node : block.nodes) points->InsertNextPoint(node.data());
    grid->SetPoints(points);
    add_cell(grid, VTK_VOXEL, {0, 1, 2, 3, 4, 5, 6, 7});
    write(grid);
    EXPECT_EQ(read_vtu(path).blocks[0].connectivity, block.blocks[0].connectivity);
}

TEST_F(VtuReader, TakesWedgesOfEitherOrientation) {
    const Mesh block = make_block({0, 0, 0}, {1, 1, 1}, {2, 2, 1}, CellType::wedge6);
    Mesh mirrored = block;
    for (std::size_t c = 0; c < mirrored.blocks[0].connectivity.size(); c += 3)
        std::swap(mirrored.blocks[0].connectivity[c + 1], mirrored.blocks[0].connectivity[c + 2]);
    ASSERT_NE(mirrored.blocks[0].connectivity, block.blocks[0].connectivity);
    write(make_grid(mirrored));
    EXPECT_EQ(read_vtu(path).blocks[0].connectivity, block.blocks[0].connectivity);
}

TEST_F(VtuReader, NamesAnInvertedCell) {
    for (const auto& [name, type] : {std::pair("hex8", CellType::hex8), std::pair("tet4", CellType::tet4)}) {
        Mesh mesh = make_block({0, 0, 0}, {1, 1, 1}, {3, 1, 1}, type);
        const int stride = nodes_per_cell(type);
        auto second = mesh.blocks[0].connectivity.begin() + stride;
        if (type == CellType::hex8)
            std::rotate(second, second + 4, second + 8);
        else
            std::swap(second[0], second[1]);
        write(make_grid(mesh));
        EXPECT_THAT(error(), AllOf(HasSubstr(path.filename().string()), HasSubstr("cell 1 is inverted"))) << name;
    }
}

TEST_F(VtuReader, NamesAVolumeCellItCannotRead) {
    auto grid = make_grid(make_block({0, 0, 0}, {1, 1, 1}, {1, 1, 1}));
    add_cell(grid, VTK_PYRAMID, {0, 1, 2, 3, 7});
    write(grid);
    EXPECT_THAT(error(), AllOf(HasSubstr("cell 1"), HasSubstr("vtkPyramid"), HasSubstr("type 14"),
                               HasSubstr("only hex8, wedge6, tet4")));
}

TEST_F(VtuReader, SaysWhyAFileIsBad) {
    EXPECT_THAT(error(), HasSubstr("no such file"));
    write("this is no XML\n");
    EXPECT_THAT(error(), AllOf(HasSubstr(path.filename().string()), HasSubstr("Error parsing XML")));
    write("");
    EXPECT_NE(error(), "");
    write("<VTKFile type=\"PolyData\" version=\"1.0\"><PolyData/></VTKFile>");
    EXPECT_NE(error(), "");
    auto grid = make_grid(make_block({0, 0, 0}, {1, 1, 1}, {4, 4, 4}));
    write(grid);
    std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
    EXPECT_NE(error(), "");
    const vtkNew<vtkUnstructuredGrid> empty;
    write(empty);
    EXPECT_NE(error(), "");
    write(make_grid({{Vec3(0, 0, 0)}, {}, {}, {}, {}}));
    EXPECT_THAT(error(), HasSubstr("no cells"));
    auto flat = make_grid({{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}, {}, {}, {}, {}});
    add_cell(flat, VTK_TRIANGLE, {0, 1, 2});
    write(flat);
    EXPECT_THAT(error(), HasSubstr("no volume cells"));
    std::filesystem::remove(path);
    std::filesystem::create_directory(path);
    EXPECT_THAT(error(), HasSubstr("not a file"));
}

TEST_F(VtuReader, RefusesPointNumbersAndOffsetsThatDoNotExist) {
    const auto file = [](const std::string& connectivity, const std::string& offsets, int cells = 1) {
        std::string types;
        for (int c = 0; c < cells; ++c) types += "10 ";
        return "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\"><UnstructuredGrid>"
               "<Piece NumberOfPoints=\"4\" NumberOfCells=\"" +
               std::to_string(cells) +
               "\"><Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">"
               "0 0 0 1 0 0 0 1 0 0 0 1</DataArray></Points><Cells>"
               "<DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">" +
               connectivity + "</DataArray><DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">" + offsets +
               "</DataArray><DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">" + types +
               "</DataArray></Cells></Piece></UnstructuredGrid></VTKFile>";
    };
    write(file("0 1 2 3", "4"));
    EXPECT_EQ(error(), "");
    write(file("0 1 2 4", "4"));
    EXPECT_THAT(error(), HasSubstr("cell 0 has a point that does not exist"));
    write(file("0 1 2 -1", "4"));
    EXPECT_THAT(error(), HasSubstr("cell 0 has a point that does not exist"));
    write(file("0 1 2 3", "3"));
    EXPECT_NE(error(), "");
    write(file("0 1 2 3", "400"));
    EXPECT_NE(error(), "");
    write(file("0 1 2 3 0 1 2 3 0 1 2 3", "400 404 12", 3));
    EXPECT_THAT(error(), HasSubstr("offsets"));
}

} // namespace
} // namespace osculate::mesh::OSCULATE_THIS_FILE

#pragma once
/// Bodies of a scene: their meshes, materials and how they move at the start.

#include "osculate/core/choices.hpp"
#include "osculate/core/types.hpp"
#include "osculate/mesh/block_pattern.hpp"
#include "osculate/mesh/focus.hpp"
#include "osculate/mesh/gmsh.hpp"
#include "osculate/mesh/mesh.hpp"
#include "osculate/mesh/portion.hpp"
#include "osculate/scene/course.hpp"
#include "osculate/scene/named.hpp"
#include "osculate/scene/rigid_surface.hpp"

#include <array>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace osculate::scene {

// ---- meshes --------------------------------------------------------------------------------------------------------

using mesh::BlockPattern;

struct BlockMesh {
    Vec3 origin = Vec3::Zero(); ///< lower corner, m
    Vec3 size = Vec3::Ones();   ///< m
    std::array<int, 3> divisions{1, 1, 1};
    mesh::CellType element = mesh::CellType::hex8;
    BlockPattern pattern = BlockPattern::quad; ///< triangle: wedge6; hybrid: hex8 and wedge6 side by side
    mesh::Focus focus;
    mesh::Crown crown;
    bool operator==(const BlockMesh&) const = default;
};

using mesh::Portion;

/// Lower half of a tube with its axis along y, open towards +z; z = -(inner_radius + thickness) is its lowest line.
struct HalfTubeMesh {
    double inner_radius = 3, thickness = 1, length = 12; ///< m
    std::array<int, 3> divisions{13, 12, 3};             ///< around, along, through the thickness
    mesh::CellType element = mesh::CellType::hex8;
    bool operator==(const HalfTubeMesh&) const = default;
};

/// Block with a cylindrical underside (axis along y through the origin's x, radius `radius`) and a flat top.
struct ContactorMesh {
    double radius = 3, width = 4, length = 4, height = 1; ///< m; height is measured at the centre line
    double rear = 0.5;                                    ///< y of the rear face, m
    std::array<int, 3> divisions{12, 16, 3};              ///< across, along, through the height
    mesh::CellType element = mesh::CellType::hex8;
    bool operator==(const ContactorMesh&) const = default;
};

/// Solid ball about the origin.
struct BallMesh {
    double radius = 1;                     ///< m
    std::array<int, 3> divisions{8, 4, 8}; ///< around a quarter of the equator, radial, inner cube along z
    Portion portion = Portion::full;
    double grading = 1;
    double pole_refinement = 1; ///< factor by which elements at the lowest point are smaller
    bool operator==(const BallMesh&) const = default;
};

/// Solid cylinder about the z axis, from z = 0 up.
struct CylinderMesh {
    double radius = 1, length = 1;         ///< m
    std::array<int, 3> divisions{8, 4, 8}; ///< around a quarter, radial, along z
    Portion portion = Portion::full;
    double grading = 1; ///< of the layers along z
    bool operator==(const CylinderMesh&) const = default;
};

/// Tube about the z axis, from z = 0 up.
struct TubeMesh {
    double inner_radius = 1, thickness = 0.1, length = 1; ///< m
    std::array<int, 3> divisions{24, 2, 1};               ///< around the whole circle, along, through the thickness
    Portion portion = Portion::full;
    bool operator==(const TubeMesh&) const = default;
};

struct FileMesh {
    std::string path;                ///< in a format of mesh::read_mesh_file; the reader makes it absolute
    std::string part;                ///< element set, block, physical volume; empty: all of the file
    int piece = 0;                   ///< connected piece of the part, from 1; 0: all
    std::vector<std::string> repair; ///< mesh::repair_words() or `all`
    bool operator==(const FileMesh&) const = default;
};

/// Geometry meshed by Gmsh.
struct CadMesh {
    std::string path;       ///< STEP, IGES or BREP file; the reader makes it absolute
    double size = 0;        ///< largest edge length, m; 0: a tenth of the diagonal of the geometry's box
    double smallest = 0;    ///< smallest edge length, m
    int per_circle = 0;     ///< elements around a full circle; 0: ignores curvature
    bool quadratic = false; ///< tet10; false: tet4
    mesh::CadFocus focus;
    mesh::CadContact contact;
    std::string part;
    int piece = 0;
    bool operator==(const CadMesh&) const = default;
};

/// Rigid placement applied after generation: x = scale * (rotation * X) + translation.
struct Placement {
    Vec3 axis = Vec3::UnitZ();
    double angle = 0; ///< rad
    Vec3 translation = Vec3::Zero();
    double scale = 1;
    bool operator==(const Placement&) const = default;
};

struct MeshSpec {
    std::variant<BlockMesh, HalfTubeMesh, ContactorMesh, BallMesh, CylinderMesh, TubeMesh, FileMesh, CadMesh> source;
    Placement placement;
    bool operator==(const MeshSpec&) const = default;
};

// ---- bodies --------------------------------------------------------------------------------------------------------

struct ElasticConstants {
    double E = 0;         ///< Young's modulus, Pa
    double nu = 0;        ///< Poisson's ratio
    double density = 0;   ///< kg/m^3; 0: none, sufficient for statics
    double expansion = 0; ///< thermal, 1/K
    bool operator==(const ElasticConstants&) const = default;
};
struct LinearElastic : ElasticConstants { ///< small strain
    bool operator==(const LinearElastic&) const = default;
};
struct SaintVenantKirchhoff : ElasticConstants { ///< finite strain
    bool operator==(const SaintVenantKirchhoff&) const = default;
};
struct NeoHookean : ElasticConstants { ///< finite strain
    bool operator==(const NeoHookean&) const = default;
};
/// Small strain. E and nu of ElasticConstants stand for those along the axes: the largest modulus, and 0.3.
struct Orthotropic : ElasticConstants {
    Vec3 moduli = Vec3::Zero(); ///< Young's moduli along the axes, Pa
    Vec3 ratios = Vec3::Zero(); ///< nu_12, nu_13, nu_23
    Vec3 shear = Vec3::Zero();  ///< G_12, G_13, G_23, Pa
    Mat3 axes = Mat3::Identity();
    bool operator==(const Orthotropic&) const = default;
};
struct ElasticPlastic : ElasticConstants { ///< finite strain
    Course yield_stress;                   ///< Pa, a value, or a table over the equivalent plastic strain
    bool operator==(const ElasticPlastic&) const = default;
};
using Material = std::variant<LinearElastic, SaintVenantKirchhoff, NeoHookean, ElasticPlastic, Orthotropic>;

[[nodiscard]] inline const ElasticConstants& elastic(const Material& material) {
    return std::visit([](const auto& m) -> const ElasticConstants& { return m; }, material);
}

/// A body that does not deform.
struct Rigid {
    double density = 0;                    ///< kg/m^3; 0: that of the material, if there is one
    std::optional<double> mass;            ///< kg; none: of volume and density
    std::optional<Vec3> centre;            ///< of mass, m; none: that of the volume
    std::optional<Vec3> inertia, products; ///< J_xx, J_yy, J_zz and J_xy, J_yz, J_xz about the centre, kg m^2
    std::optional<Vec3> reference_point;   ///< m; none: the centre of mass
    std::array<bool, 6> fixed{};           ///< displacement and rotation components held at zero
    bool operator==(const Rigid&) const = default;
};

enum class SliceKind { plane_strain, plane_stress, axisymmetric };

/// A body of one layer of elements that stands for one without thickness, or for a body of revolution.
struct Slice {
    SliceKind kind = SliceKind::plane_strain;
    Vec3 point = Vec3::Zero(); ///< of the axis of revolution, m
    Vec3 axis = Vec3::UnitZ(); ///< normal of the plane, or the axis of revolution
    bool operator==(const Slice&) const = default;
};

struct SelectBox {
    Vec3 min = Vec3::Zero(), max = Vec3::Ones();
    bool operator==(const SelectBox&) const = default;
};

/// Elements of a body that are of another material than its others.
struct Section {
    std::variant<std::string, SelectBox>
        elements; ///< a part that the mesh file names, or those whose centre is in a box
    Material material;
    bool operator==(const Section&) const = default;
};

struct Body {
    MeshSpec mesh;
    std::optional<RigidSurface> rigid_surface; ///< in place of the mesh
    bool has_mesh = true;                      ///< as a scene is written
    Material material;
    Named<Section> sections; ///< the last that has an element counts
    std::optional<Rigid> rigid;
    std::optional<Slice> slice;
    bool has_material = true; ///< a rigid body needs none
    HexFormulation hex_formulation = HexFormulation::full;
    std::string finish; ///< name of its surface, for pairs of general contact; empty: none
    Vec3 initial_velocity = Vec3::Zero(), initial_spin = Vec3::Zero(); ///< m/s; rad/s about the centre of mass
    bool operator==(const Body&) const = default;
};

} // namespace osculate::scene

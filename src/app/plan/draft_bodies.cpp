/// Bodies of a plan.

#include "app/fault.hpp"
#include "app/overloaded.hpp"
#include "app/plan/body_materials.hpp"
#include "app/plan/draft.hpp"
#include "app/plan/rigid_surface.hpp"
#include "osculate/core/error.hpp"
#include "osculate/fe/bad_jacobians.hpp"
#include "osculate/mesh/quality.hpp"

#include <fmt/format.h>
#include <numeric>

namespace osculate::app {

namespace {

/// Far from the scene's origin positions have few digits left for gaps: they are taken from the middle of all bodies.
void move_origin(Draft& draft, std::vector<mesh::Mesh>& meshes) {
    constexpr double far = 8; // half diagonals: three of 53 bits
    Eigen::AlignedBox3d box;
    for (const mesh::Mesh& m : meshes)
        for (const Vec3& X : m.nodes) box.extend(X);
    if (!(box.center().norm() > far * 0.5 * box.diagonal().norm())) return;
    draft.plan.model.origin = box.center();
    for (mesh::Mesh& m : meshes)
        for (Vec3& X : m.nodes) X -= draft.plan.model.origin;
}

/// What asks for the stiffness of a body finds a rigid one much stiffer than all that deform.
void give_rigid_bodies_materials(scene::Scene& scene) {
    constexpr double stiffer = 1e3;
    double stiffest = 0;
    for (const auto& [name, body] : scene.bodies)
        if (!body.rigid)
            for (int s = 0; s <= static_cast<int>(body.sections.size()); ++s)
                stiffest = std::max(stiffest, scene::elastic(material_of(body, s)).E);
    for (auto& [name, body] : scene.bodies) {
        if (!body.rigid) continue;
        scene::LinearElastic stand_in;
        stand_in.E = stiffest > 0 ? stiffer * stiffest : 1;
        stand_in.density = body.rigid->density > 0 ? body.rigid->density : scene::elastic(body.material).density;
        body.material = stand_in;
        body.hex_formulation = HexFormulation::full;
    }
}

/// Mass and centre of a rigid body, as given or those of its volume; faults where inertia would be missing.
void set_mass(Draft& draft, const std::string& name, const scene::Body& spec, model::RigidBody& rigid) {
    const model::Body& body = draft.plan.model.bodies[static_cast<std::size_t>(rigid.body)];
    const scene::Rigid& given = *spec.rigid;
    const Vec3& origin = draft.plan.model.origin;
    model::MassProperties own; // a shell on an exact surface is there to be seen
    if (spec.rigid_surface) {
        rigid.shape = exact_shape(*spec.rigid_surface, origin);
        own.centre = given.reference_point.value_or(usual_reference_point(*spec.rigid_surface)) - origin;
    } else {
        own = model::mass_properties(body, 1);
        if (!(own.mass > 0) && !given.mass)
            draft.faults.push_back(fault("bodies." + name + ".rigid", "a volume, or mass, centre and inertia",
                                         fmt::format("a volume of {:.3g} m^3", own.mass)));
    }
    rigid.centre = given.centre ? *given.centre - origin : own.centre;
    const double density = body.density.empty() ? 0 : body.density.front();
    rigid.mass = given.mass ? *given.mass : density * own.mass;
    rigid.inertia = density * own.inertia;
    if (!given.inertia) return;
    const Vec3 &J = *given.inertia, P = given.products.value_or(Vec3::Zero());
    rigid.inertia << J.x(), P.x(), P.z(), P.x(), J.y(), P.y(), P.z(), P.y(), J.z();
}

/// The two nodes of each rigid body, behind those of all meshes.
void add_rigid_bodies(Draft& draft) {
    model::Model& m = draft.plan.model;
    for (std::size_t b = 0; b < m.bodies.size(); ++b) {
        const auto& [name, spec] = draft.scene.bodies[b];
        if (!spec.rigid) continue;
        model::RigidBody& rigid = m.rigid.emplace_back();
        rigid.body = static_cast<Index>(b);
        rigid.name = name;
        rigid.nodes.resize(static_cast<std::size_t>(m.bodies[b].nodes()));
        std::iota(rigid.nodes.begin(), rigid.nodes.end(), m.bodies[b].first_node);
        set_mass(draft, name, spec, rigid);
        rigid.velocity = spec.initial_velocity;
        rigid.spin = spec.initial_spin;
        const Vec3 point = spec.rigid->reference_point ? *spec.rigid->reference_point - m.origin : rigid.centre;
        rigid.radius = 0;
        for (const Vec3& X : m.bodies[b].mesh.nodes) rigid.radius = std::max(rigid.radius, (X - point).norm());
        if (!(rigid.radius > 0)) rigid.radius = 1;
        rigid.reference = m.nodes();
        auto& X = m.X.values();
        X.insert(X.end(), 2, point);
    }
}

struct Unfit {
    std::string expected, found;
};

/// What is wrong with a formulation if elements of the mesh do not have it.
std::optional<Unfit> unfit_formulation(const mesh::Mesh& mesh, HexFormulation formulation) {
    const auto has = [&](mesh::CellType type) {
        return std::ranges::any_of(mesh.blocks, [&](const mesh::ElementBlock& block) { return block.type == type; });
    };
    if (formulation == HexFormulation::reduced && has(mesh::CellType::hex8))
        return Unfit{
            "full, b_bar or incompatible_modes for hex8 elements, which by one point alone resist no hourglass modes",
            "reduced"};
    if (has(mesh::CellType::hex20) && formulation != HexFormulation::full && formulation != HexFormulation::reduced)
        return Unfit{"full or reduced for hex20 elements",
                     formulation == HexFormulation::b_bar ? "b_bar" : "incompatible_modes"};
    return {};
}

/// Whether every section has elements, and a material that stores energy; faults otherwise.
bool sound_materials(Draft& draft, const std::string& name, const scene::Body& spec, const mesh::Mesh& mesh) {
    const std::size_t before = draft.faults.size();
    for (int s = 0; s <= static_cast<int>(spec.sections.size()); ++s) {
        const std::string key =
            "bodies." + name + (s == 0 ? "" : ".sections." + spec.sections[static_cast<std::size_t>(s) - 1].first);
        if (s > 0 && std::ranges::none_of(mesh.blocks, [&](const auto& block) { return block.section == s; }))
            draft.faults.push_back(fault(key, "at least one element that no later section has", "none"));
        const auto* o = std::get_if<scene::Orthotropic>(&material_of(spec, s));
        if (o == nullptr || material::Orthotropic{o->moduli, o->ratios, o->shear, o->axes}.stable()) continue;
        draft.faults.push_back(fault(
            key + ".material.orthotropic.nu", "ratios with which every strain stores energy, as nu_12^2 < E_1/E_2",
            fmt::format("[{:.4g}, {:.4g}, {:.4g}]", o->ratios[0], o->ratios[1], o->ratios[2])));
    }
    return draft.faults.size() == before;
}

std::unique_ptr<fe::ElementKernel> kernel(mesh::CellType type, HexFormulation formulation, const scene::Material& spec,
                                          bool heated) {
    const material::LinearElastic elastic{scene::elastic(spec).E, scene::elastic(spec).nu};
    return std::visit(
        Overloaded{
            [&](const scene::LinearElastic&) { return fe::make_kernel(type, formulation, elastic, heated); },
            [&](const scene::SaintVenantKirchhoff&) {
                return fe::make_kernel(type, formulation, material::SaintVenantKirchhoff(elastic), heated);
            },
            [&](const scene::NeoHookean&) {
                return fe::make_kernel(type, formulation, material::NeoHookean(elastic), heated);
            },
            [&](const scene::Orthotropic& o) {
                return fe::make_kernel(type, formulation, material::Orthotropic{o.moduli, o.ratios, o.shear, o.axes},
                                       heated);
            },
            [&](const scene::ElasticPlastic& plastic) {
                material::Hardening hardening;
                if (const auto* table = std::get_if<scene::Table>(&plastic.yield_stress.form))
                    hardening.rows = table->rows;
                else
                    hardening.rows = {{0, plastic.yield_stress.value()}};
                return fe::make_kernel(type, formulation, material::J2Plasticity(elastic, std::move(hardening)),
                                       heated);
            },
        },
        spec);
}

/// Elements that are folded over where only their shape functions show it.
std::vector<std::string> folded_elements(const mesh::Mesh& m, const Vec3& origin) {
    constexpr std::size_t listed = 20;
    std::vector<std::string> faults;
    std::size_t count = 0;
    for (std::size_t b = 0; b < m.blocks.size(); ++b)
        for (const fe::BadJacobian& bad : fe::bad_jacobians(m.blocks[b], m.nodes)) {
            if (++count > listed) continue;
            const Vec3 place = bad.place + origin;
            faults.push_back(
                fmt::format("{} element {} of block {}: Jacobian is not positive at [{:.6g}, {:.6g}, {:.6g}] m",
                            mesh::cell_info(m.blocks[b].type).name, bad.element, b, place[0], place[1], place[2]));
        }
    if (count > listed) faults.push_back(fmt::format("and {} more", count - listed));
    return faults;
}

} // namespace

std::vector<std::string> mesh_faults(const mesh::Mesh& m, const Vec3& origin) {
    std::vector<std::string> faults = mesh::faults(m);
    return faults.empty() ? folded_elements(m, origin) : faults;
}

Index Draft::body_index(const std::string& name) const {
    for (std::size_t b = 0; b < scene.bodies.size(); ++b)
        if (scene.bodies[b].first == name) return static_cast<Index>(b);
    throw InternalError("the scene names a body it does not have");
}

const model::RigidBody& Draft::rigid(const std::string& name) const {
    for (const model::RigidBody& one : plan.model.rigid)
        if (one.name == name) return one;
    throw InternalError("the scene asks for the motion of what does not move as one");
}

const model::Set& Draft::set(const std::string& name) const {
    for (const model::Set& s : plan.model.sets)
        if (s.name == name) return s;
    throw InternalError("the scene names a set it does not have");
}

std::vector<mesh::SurfaceFace> Draft::faces(const model::Set& set) const {
    const model::Body& body = plan.model.bodies[static_cast<std::size_t>(set.body)];
    return mesh::surface_faces(body.mesh, set.facets, body.first_node);
}

bool Draft::audited() const {
    return scene.solver.audit && (scene.bodies.size() > 1 ||
                                  any_kernel([](const fe::ElementKernel& kernel) { return kernel.finite_strain(); }));
}

void add_bodies(Draft& draft, std::vector<mesh::Mesh> meshes) {
    move_origin(draft, meshes);
    give_rigid_bodies_materials(draft.scene);
    for (std::size_t b = 0; b < meshes.size(); ++b) {
        const auto& [name, spec] = draft.scene.bodies[b];
        for (const std::string& what : mesh_faults(meshes[b], draft.plan.model.origin))
            draft.faults.push_back(fault("bodies." + name + ".mesh", "a sound mesh", what));
        model::Body body;
        body.name = name;
        body.rigid = spec.rigid.has_value();
        body.mesh = std::move(meshes[b]);
        body.first_node = draft.plan.model.nodes();
        if (!body.rigid && !sound_materials(draft, name, spec, body.mesh)) return;
        if (const auto unfit = unfit_formulation(body.mesh, spec.hex_formulation)) {
            draft.faults.push_back(fault("bodies." + name + ".hex_formulation", unfit->expected, unfit->found));
            return;
        }
        const bool heated = !body.rigid && std::ranges::any_of(draft.scene.stages, [](const auto& stage) {
            return stage.second.temperature.size() > 0;
        });
        for (const mesh::ElementBlock& block : body.mesh.blocks) {
            const scene::Material& material = material_of(spec, block.section);
            const auto& [E, nu, density, expansion] = scene::elastic(material);
            body.density.push_back(density);
            body.expansion.push_back(expansion);
            body.kernels.push_back(kernel(block.type, spec.hex_formulation, material, heated && expansion != 0));
        }
        auto& X = draft.plan.model.X.values();
        X.insert(X.end(), body.mesh.nodes.begin(), body.mesh.nodes.end());
        body.exterior = mesh::exterior_facets(body.mesh);
        draft.plan.model.bodies.push_back(std::move(body));
    }
    if (draft.faults.empty()) add_rigid_bodies(draft);
}

} // namespace osculate::app

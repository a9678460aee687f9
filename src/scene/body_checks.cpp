/// Rules that join several keys of a body.

#include "osculate/scene/units.hpp"
#include "scene/rules.hpp"

#include <cmath>
#include <filesystem>

namespace osculate::scene {

namespace {

class BodyRules : public Rules {
public:
    using Rules::Rules;

    void check_mesh(const std::string& body, const BlockMesh& m) {
        const std::vector<std::string> path{"bodies", body, "mesh", "block", "pattern"};
        if (m.pattern == BlockPattern::hybrid && m.element != mesh::CellType::hex8)
            fault(path, "pattern hybrid with element hex8", "another element");
        else if (m.pattern == BlockPattern::hybrid && m.divisions[0] * m.divisions[1] < 2)
            fault(path, "at least two columns of elements for pattern hybrid", "one");
        else if (m.pattern != BlockPattern::quad && !mesh::has_patterns(m.element))
            fault(path, "pattern quad with element " + std::string(mesh::cell_info(m.element).name), "another pattern");
    }
    void check_mesh(const std::string& /*body*/, const HalfTubeMesh& /*m*/) {}
    void check_mesh(const std::string& body, const ContactorMesh& m) {
        const double half = m.width / 2;
        if (half > m.radius) {
            fault({"bodies", body, "mesh", "contactor", "width"},
                  "at most twice the radius, " + number_text(2 * m.radius) + " m", number_text(m.width) + " m");
            return;
        }
        const double least = m.radius - std::sqrt((m.radius - half) * (m.radius + half));
        if (m.height <= least)
            fault({"bodies", body, "mesh", "contactor", "height"},
                  "more than " + number_text(least) + " m, where the flat top meets the underside's edges",
                  number_text(m.height) + " m");
    }
    void check_mesh(const std::string& body, const BallMesh& m) { check_around(body, "ball", m.divisions[0]); }
    void check_mesh(const std::string& body, const CylinderMesh& m) { check_around(body, "cylinder", m.divisions[0]); }
    void check_around(const std::string& body, const char* tag, int around) {
        if (around % 2 != 0)
            fault({"bodies", body, "mesh", tag, "divisions"}, "an even number of elements around a quarter",
                  std::to_string(around));
    }
    void check_mesh(const std::string& body, const TubeMesh& m) {
        if (m.divisions[0] < 3)
            fault({"bodies", body, "mesh", "tube", "divisions"}, "3 or more elements around",
                  std::to_string(m.divisions[0]));
    }
    void check_mesh(const std::string& body, const FileMesh& m) { check_path(body, "file", m.path); }
    void check_mesh(const std::string& body, const CadMesh& m) {
        check_path(body, "cad", m.path);
        if (m.size > 0 && m.smallest > m.size)
            fault({"bodies", body, "mesh", "cad", "smallest"}, "at most size, " + number_text(m.size) + " m",
                  number_text(m.smallest) + " m");
        const std::vector<std::string> focus{"bodies", body, "mesh", "cad", "focus"},
            size{"bodies", body, "mesh", "cad", "focus", "size"};
        // a scene that was written out has the defaults of a focus that there is none of
        if (m.focus.size <= 0 && (m.focus != mesh::CadFocus{} || (has(focus) && !has(size))))
            fault(size, "the size of the elements there", "none");
        if (m.size > 0 && m.focus.size >= m.size)
            fault(size, "less than the size of all elements, " + number_text(m.size) + " m",
                  number_text(m.focus.size) + " m");
        const std::vector<std::string> contact{"bodies", body, "mesh", "cad", "contact", "size"};
        if (m.size > 0 && m.contact.size >= m.size)
            fault(contact, "less than the size of all elements, " + number_text(m.size) + " m",
                  number_text(m.contact.size) + " m");
        if (m.contact.size > 0 && m.smallest > m.contact.size)
            fault({"bodies", body, "mesh", "cad", "smallest"},
                  "at most the size at contact, " + number_text(m.contact.size) + " m", number_text(m.smallest) + " m");
        if (m.focus.size > 0 && m.smallest > m.focus.size)
            fault({"bodies", body, "mesh", "cad", "smallest"},
                  "at most the size of focus, " + number_text(m.focus.size) + " m", number_text(m.smallest) + " m");
    }
    /// @param at  the key of a body or section
    void check_hardening(std::vector<std::string> at, const Material& material) {
        const auto* plastic = std::get_if<ElasticPlastic>(&material);
        if (plastic == nullptr || plastic->yield_stress.is_value()) return;
        std::vector<std::string>& key = at;
        key.insert(key.end(), {"material", "elastic_plastic", "yield_stress"});
        if (std::holds_alternative<Expression>(plastic->yield_stress.form))
            fault(key, "a value, or a table over the equivalent plastic strain", "an expression");
        else if (const double first = std::get<Table>(plastic->yield_stress.form).rows.front()[0]; first != 0)
            fault(key, "a table that begins at a plastic strain of 0", number_text(first));
    }

    void check_box(const std::string& body, const std::string& part, const Section& section) {
        const auto* box = std::get_if<SelectBox>(&section.elements);
        if (box != nullptr && !(box->min.array() < box->max.array()).all())
            fault({"bodies", body, "sections", part, "box"}, "a min below its max in every component",
                  "one that is not");
    }

    void check_path(const std::string& body, const char* tag, const std::string& path) {
        std::error_code ignored;
        if (!path.empty() && !std::filesystem::is_regular_file(path, ignored))
            fault({"bodies", body, "mesh", tag, "path"}, "a file that exists", "'" + path + "'");
    }

    void check_formulation(const std::string& name, const Body& body) {
        const auto finite_strain = [](const Material& material) {
            return !std::holds_alternative<LinearElastic>(material) && !std::holds_alternative<Orthotropic>(material);
        };
        if (body.hex_formulation == HexFormulation::incompatible_modes &&
            ((body.has_material && finite_strain(body.material)) ||
             std::ranges::any_of(body.sections, [&](const auto& one) { return finite_strain(one.second.material); })))
            fault({"bodies", name, "hex_formulation"}, "full or b_bar with a material at finite strain",
                  "incompatible_modes");
    }

    void check_rigid(const std::string& name, const Body& body) {
        if (!body.has_mesh && !body.rigid_surface) fault({"bodies", name}, "a mesh, or a rigid_surface", "neither");
        if (body.rigid_surface) {
            if (body.has_mesh) fault({"bodies", name, "mesh"}, "a mesh, or a rigid_surface", "both");
            if (body.has_material)
                fault({"bodies", name, "material"}, "none: a rigid_surface does not deform", "a material");
            if (body.rigid->density > 0)
                fault({"bodies", name, "rigid", "density"}, "mass and inertia: a rigid_surface has no volume",
                      "a density");
        }
        if (!body.has_material && !body.rigid) fault({"bodies", name}, "a material, or rigid: true", "neither");
        if (!body.rigid) return;
        if (body.slice) fault({"bodies", name, "slice"}, "a body that deforms", "a rigid one");
        if (!body.sections.empty()) fault({"bodies", name, "sections"}, "a body that deforms", "a rigid one");
        const Rigid& rigid = *body.rigid;
        const std::vector<std::string> path{"bodies", name, "rigid"};
        const auto key = [&](const char* last) { return std::vector<std::string>{"bodies", name, "rigid", last}; };
        if (rigid.mass && rigid.density > 0) fault(key("mass"), "a density or a mass", "both");
        if (rigid.mass && !rigid.inertia) fault(key("mass"), "inertia beside a mass", "none");
        if (rigid.inertia && !rigid.mass) fault(key("inertia"), "a mass beside inertia", "none");
        if (rigid.products && !rigid.inertia) fault(key("products"), "inertia beside products", "none");
        if (rigid.centre && !rigid.mass) fault(key("centre"), "a mass beside a centre of mass", "none");
        if (body.has_material && rigid.density > 0 && elastic(body.material).density > 0 &&
            elastic(body.material).density != rigid.density)
            fault(key("density"), "the density of the material, or none", number_text(rigid.density) + " kg/m^3");
        if (!rigid.inertia) return;
        const Vec3 J = *rigid.inertia, P = rigid.products.value_or(Vec3::Zero());
        // positive definite, by the leading minors
        const double second = J[0] * J[1] - P[0] * P[0];
        const double third = J[0] * (J[1] * J[2] - P[1] * P[1]) - P[0] * (P[0] * J[2] - P[1] * P[2]) +
                             P[2] * (P[0] * P[1] - J[1] * P[2]);
        if (!(second > 0) || !(third > 0))
            fault(key("inertia"), "a positive definite tensor of inertia", "one that is not");
    }
};

} // namespace

void check_bodies(const Scene& scene, const Tree& tree, std::vector<Fault>& faults) {
    BodyRules rules(tree, faults);
    for (const auto& [name, body] : scene.bodies)
        std::visit([&, &n = name](const auto& source) { rules.check_mesh(n, source); }, body.mesh.source);
    for (const auto& [name, body] : scene.bodies) rules.check_formulation(name, body);
    for (const auto& [name, body] : scene.bodies) {
        rules.check_hardening({"bodies", name}, body.material);
        for (const auto& [part, section] : body.sections) {
            rules.check_hardening({"bodies", name, "sections", part}, section.material);
            rules.check_box(name, part, section);
        }
    }
    for (const auto& [name, body] : scene.bodies) rules.check_rigid(name, body);
}

} // namespace osculate::scene

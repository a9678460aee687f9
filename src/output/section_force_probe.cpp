/// Force and moment through a plane cut of a body.

#include "osculate/output/probe.hpp"
#include "output/elements.hpp"

#include <stdexcept>

namespace osculate::output {

namespace {

class SectionForceProbe final : public Probe {
public:
    struct Part {
        ElementOf element;
        std::vector<int> shared; ///< which of its nodes both sides share
    };
    SectionForceProbe(Index body, const Vec3& point, std::vector<Part> parts)
        : body_(body), point_(point), parts_(std::move(parts)) {}

    [[nodiscard]] std::vector<ProbeColumn> columns() const override {
        return {{"force_x", "N"},    {"force_y", "N"},    {"force_z", "N"},
                {"moment_x", "N m"}, {"moment_y", "N m"}, {"moment_z", "N m"}};
    }
    [[nodiscard]] std::vector<std::vector<double>> rows(const Snapshot& snapshot) const override {
        const model::Body& body = snapshot.model().bodies[static_cast<std::size_t>(body_)];
        Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
        for (const Part& part : parts_) {
            const fe::ElementKernel& kernel = *body.kernels[static_cast<std::size_t>(part.element.block)];
            const std::vector<Index> nodes = nodes_of(body, part.element);
            const Eigen::Matrix3Xd X = positions_of(body, nodes), u = displacements_of(body, nodes, snapshot.state().u);
            Eigen::Matrix3Xd f(3, kernel.nodes());
            (void)kernel.internal_force({X, u, history_of(snapshot.model(), body_, part.element, snapshot.state())}, f);
            for (const int i : part.shared) { // what the element holds of the node, it exerts on the rest the other way
                force -= f.col(i);
                moment -= (X.col(i) + u.col(i) - point_).cross(f.col(i));
            }
        }
        return {{force.x(), force.y(), force.z(), moment.x(), moment.y(), moment.z()}};
    }
    [[nodiscard]] bool reads(const std::string& /*field*/) const override { return false; }
    [[nodiscard]] double places() const override { return static_cast<double>(parts_.size()); }

private:
    Index body_;
    Vec3 point_; ///< from the model's origin
    std::vector<Part> parts_;
};

} // namespace

std::unique_ptr<Probe> make_section_force_probe(const model::Model& model, Index body_index, const Vec3& point,
                                                const Vec3& normal) {
    const model::Body& body = model.bodies[static_cast<std::size_t>(body_index)];
    const Vec3 P = point - model.origin;
    std::vector<char> ahead(body.mesh.nodes.size(), 0), behind = ahead; // nodes of either side
    const auto is_ahead = [&](const std::vector<Index>& nodes) {
        return (positions_of(body, nodes).rowwise().mean() - P).dot(normal) > 0;
    };
    for_each_element(body, [&](const ElementOf& element) {
        const std::vector<Index> nodes = nodes_of(body, element);
        for (const Index node : nodes) (is_ahead(nodes) ? ahead : behind)[static_cast<std::size_t>(node)] = 1;
    });
    std::vector<SectionForceProbe::Part> parts;
    for_each_element(body, [&](const ElementOf& element) {
        const std::vector<Index> nodes = nodes_of(body, element);
        if (!is_ahead(nodes)) return;
        SectionForceProbe::Part part{element, {}};
        for (std::size_t i = 0; i < nodes.size(); ++i)
            if (behind[static_cast<std::size_t>(nodes[i])] != 0) part.shared.push_back(static_cast<int>(i));
        if (!part.shared.empty()) parts.push_back(std::move(part));
    });
    if (parts.empty()) throw std::invalid_argument("a plane that leaves all elements on one side");
    return std::make_unique<SectionForceProbe>(body_index, P, std::move(parts));
}

} // namespace osculate::output

/// What contact does to the nodes of a set.

#include "osculate/output/probe.hpp"
#include "output/set_areas.hpp"

#include <algorithm>
#include <limits>

namespace osculate::output {

namespace {

class ContactForceProbe final : public Probe {
public:
    /// @param point  from the model's origin
    ContactForceProbe(std::vector<Index> nodes, std::vector<double> areas, const Vec3& point)
        : nodes_(std::move(nodes)), areas_(std::move(areas)), point_(point) {}

    [[nodiscard]] std::vector<ProbeColumn> columns() const override {
        return {{"force_x", "N"},      {"force_y", "N"},    {"force_z", "N"},       {"moment_x", "N m"},
                {"moment_y", "N m"},   {"moment_z", "N m"}, {"centre_x", "m"},      {"centre_y", "m"},
                {"centre_z", "m"},     {"pressing", "N"},   {"loaded_area", "m^2"}, {"mean_pressure", "Pa"},
                {"max_pressure", "Pa"}};
    }
    [[nodiscard]] std::vector<std::vector<double>> rows(const Snapshot& snapshot) const override {
        const NodalContact& contact = snapshot.nodal_contact();
        Vec3 force = Vec3::Zero(), moment = Vec3::Zero(), weighted = Vec3::Zero();
        double pressing = 0, area = 0, largest = 0;
        for (std::size_t i = 0; i < nodes_.size(); ++i) {
            const auto node = static_cast<std::size_t>(nodes_[i]);
            const Vec3 &f = contact[node].force, x = snapshot.x(nodes_[i]);
            force += f;
            moment += (x - point_).cross(f);
            if (f.isZero(0)) continue;
            const double pressure = contact[node].pressure, load = pressure * areas_[i];
            area += areas_[i];
            largest = std::max(largest, pressure);
            pressing += load;
            weighted += load * x;
        }
        constexpr double none = std::numeric_limits<double>::quiet_NaN();
        const Vec3 centre =
            pressing > 0 ? Vec3(weighted / pressing + snapshot.model().origin) : Vec3(Vec3::Constant(none));
        const double mean = area > 0 ? pressing / area : none;
        return {{force.x(), force.y(), force.z(), moment.x(), moment.y(), moment.z(), centre.x(), centre.y(),
                 centre.z(), pressing, area, mean, largest}};
    }
    [[nodiscard]] bool reads(const std::string& /*field*/) const override { return false; }
    [[nodiscard]] double places() const override { return static_cast<double>(nodes_.size()); }

private:
    std::vector<Index> nodes_;
    std::vector<double> areas_; ///< of the set's facets that belong to each, undeformed, m^2
    Vec3 point_;
};

} // namespace

std::unique_ptr<Probe> make_contact_force_probe(const model::Model& model, const model::Set& set, const Vec3& point) {
    if (set.facets.empty()) throw std::invalid_argument("a set of nodes that cover no facet");
    return std::make_unique<ContactForceProbe>(set.nodes, areas_of(model, set), point - model.origin);
}

} // namespace osculate::output

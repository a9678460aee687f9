#pragma once
/// Values at places of the model, over time.

#include "osculate/output/fields.hpp"

#include <memory>
#include <string>
#include <vector>

namespace osculate::output {

/// A column of a probe's table.
struct ProbeColumn {
    std::string name; ///< in formulas
    std::string unit; ///< SI; empty for numbers without one

    /// "displacement_x [m]"
    [[nodiscard]] std::string header() const { return unit.empty() ? name : name + " [" + unit + "]"; }
};

/// The name in a header, without its unit.
[[nodiscard]] std::string name_of_column(const std::string& header);

/// Finds its places once, when it is made, and holds no reference to the model.
class Probe {
public:
    Probe() = default;
    Probe(const Probe&) = delete;
    Probe& operator=(const Probe&) = delete;
    virtual ~Probe() = default;

    /// Columns beside the time.
    [[nodiscard]] virtual std::vector<ProbeColumn> columns() const = 0;
    /// Rows of one state: a line has one for each sample, others have one. NaN: no value there.
    [[nodiscard]] virtual std::vector<std::vector<double>> rows(const Snapshot& snapshot) const = 0;
    /// Whether it looks at this field of bodies, which somebody has to make first.
    [[nodiscard]] virtual bool reads(const std::string& field) const = 0;
    /// What it takes, for the plan: "elements a row" and the like.
    [[nodiscard]] virtual double places() const = 0;
};

using FieldNames = std::vector<std::string>;

/// Fields at the material point X, m, by the shape functions of its element.
/// @throws std::invalid_argument where the body has no such point, saying how far off it is
[[nodiscard]] std::unique_ptr<Probe> make_point_probe(const model::Model& model, Index body, const Vec3& X,
                                                      const FieldNames& fields);

/// Fields at samples of the straight line from `from` to `to`, m, both ends among them; s is the distance from `from`.
/// Samples outside of the body have no values. @throws std::invalid_argument where all are
[[nodiscard]] std::unique_ptr<Probe> make_line_probe(const model::Model& model, Index body, const Vec3& from,
                                                     const Vec3& to, int samples, const FieldNames& fields);

/// The same on a pair's slave surface: every sample of the line is taken at the closest point of the undeformed surface.
/// s is measured along the line, X, Y and Z on the surface. Whole numbers, as statuses, are those of the nearest node.
/// @throws std::invalid_argument where the line is further from the surface than it is long
[[nodiscard]] std::unique_ptr<Probe> make_contact_line_probe(const model::Model& model, Index pair, const Vec3& from,
                                                             const Vec3& to, int samples, const FieldNames& fields);

/// Fields of nodes reduced to one number per component: mean, max, min or sum, of nodes that have a value, or area_mean: the
/// mean over the set's facets, undeformed, as the elements' shape functions have the field between nodes.
/// @throws std::invalid_argument where area_mean is asked for and the set has no facets
[[nodiscard]] std::unique_ptr<Probe> make_nodes_probe(const model::Model& model, const model::Set& set,
                                                      const FieldNames& fields,
                                                      const std::vector<std::string>& reductions);
/// The same of all slave nodes of a pair.
[[nodiscard]] std::unique_ptr<Probe> make_slave_nodes_probe(const model::Model& model, Index pair,
                                                            const FieldNames& fields,
                                                            const std::vector<std::string>& reductions);

/// Force and moment that the part of a body on the side of `normal` exerts on the rest through a plane: elements belong
/// to the side that their centre lies on, and what counts are their internal forces on the nodes that both sides share. So
/// it is in balance to round-off with what acts on the part (loads on the shared nodes count to the rest), and > 0 along
/// `normal` in tension. The moment is about `point`, m, at current positions.
/// @throws std::invalid_argument where the plane leaves all elements on one side
[[nodiscard]] std::unique_ptr<Probe> make_section_force_probe(const model::Model& model, Index body, const Vec3& point,
                                                              const Vec3& normal);

} // namespace osculate::output

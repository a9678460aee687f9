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

/// The name in a header, without unit.
[[nodiscard]] std::string name_of_column(const std::string& header);

/// A probe finds its places once, in its constructor, and keeps no reference to the model.
class Probe {
public:
    Probe() = default;
    Probe(const Probe&) = delete;
    Probe& operator=(const Probe&) = delete;
    virtual ~Probe() = default;

    /// Columns besides the time.
    [[nodiscard]] virtual std::vector<ProbeColumn> columns() const = 0;
    /// Rows of one state: one per sample for a line, one for other probes. NaN: no value there.
    [[nodiscard]] virtual std::vector<std::vector<double>> rows(const Snapshot& snapshot) const = 0;
    /// Whether it uses this field of bodies, which must then be computed first.
    [[nodiscard]] virtual bool reads(const std::string& field) const = 0;
    /// Its cost, for the plan: "elements a row" and the like.
    [[nodiscard]] virtual double places() const = 0;
};

using FieldNames = std::vector<std::string>;

/// Fields at the material point X, m, from the shape functions of its element.
/// @throws std::invalid_argument if the body has no such point, with the distance
[[nodiscard]] std::unique_ptr<Probe> make_point_probe(const model::Model& model, Index body, const Vec3& X,
                                                      const FieldNames& fields);

/// Fields at samples of the straight line from `from` to `to`, m, both ends included; s is the distance from `from`.
/// Samples outside of the body have no values. @throws std::invalid_argument if all are outside
[[nodiscard]] std::unique_ptr<Probe> make_line_probe(const model::Model& model, Index body, const Vec3& from,
                                                     const Vec3& to, int samples, const FieldNames& fields);

/// The same on a pair's slave surface: every sample of the line uses the closest point of the undeformed surface. s is
/// measured along the line, X, Y and Z on the surface. Integers, such as statuses, are those of the nearest node.
/// @throws std::invalid_argument if the line is farther from the surface than it is long
[[nodiscard]] std::unique_ptr<Probe> make_contact_line_probe(const model::Model& model, Index pair, const Vec3& from,
                                                             const Vec3& to, int samples, const FieldNames& fields);

/// The same along the arc that begins at `from` and turns by `angle`, rad, about the axis through `centre`; with a column `angle`.
/// @throws std::invalid_argument if a sample is farther from the surface than from the axis
[[nodiscard]] std::unique_ptr<Probe> make_contact_arc_probe(const model::Model& model, Index pair, const Vec3& centre,
                                                            const Vec3& axis, const Vec3& from, double angle,
                                                            int samples, const FieldNames& fields);

/// What all contact does to the nodes of a set: sum of forces, and of moments about `point`, m, at current positions; integral
/// `pressing` of the pressure over the set's undeformed facets, its centre in current positions, the area of the nodes that
/// carry force, and mean and largest pressure there. NaN where nothing presses.
/// @throws std::invalid_argument if the set has no facets
[[nodiscard]] std::unique_ptr<Probe> make_contact_force_probe(const model::Model& model, const model::Set& set,
                                                              const Vec3& point);

/// Fields of nodes reduced to one number per component: mean, max, min or sum over the nodes that have a value; or
/// area_mean: the mean over the set's undeformed facets, with the field between nodes from the elements' shape
/// functions.
/// @throws std::invalid_argument for area_mean if the set has no facets
[[nodiscard]] std::unique_ptr<Probe> make_nodes_probe(const model::Model& model, const model::Set& set,
                                                      const FieldNames& fields,
                                                      const std::vector<std::string>& reductions);
/// The same for all slave nodes of a pair.
[[nodiscard]] std::unique_ptr<Probe> make_slave_nodes_probe(const model::Model& model, Index pair,
                                                            const FieldNames& fields,
                                                            const std::vector<std::string>& reductions);

/// Force and moment that the part of a body on the side of `normal` exerts on the rest through a plane. Elements belong
/// to the side on which their centre is; the result sums the internal forces of the part's elements on the nodes that
/// both sides share. So it is in balance to round-off with the forces on the part (loads on the shared nodes count for
/// the rest), and > 0 along `normal` in tension. The moment is about `point`, m, at current positions.
/// @throws std::invalid_argument if the plane leaves all elements on one side
[[nodiscard]] std::unique_ptr<Probe> make_section_force_probe(const model::Model& model, Index body, const Vec3& point,
                                                              const Vec3& normal);

} // namespace osculate::output

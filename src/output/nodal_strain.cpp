#include "output/nodal_strain.hpp"

#include "osculate/fe/extrapolation.hpp"
#include "output/elements.hpp"

#include <Eigen/LU>

namespace osculate::output {

namespace {

/// Adds up values times volumes of the elements around each node.
class NodalMean {
public:
    NodalMean(const model::Body& body, const std::optional<model::BodyPart>& part, int components) : part_(part) {
        const Index points = part ? part->points : body.nodes();
        sum_.setZero(components, points);
        volume_.setZero(points);
    }

    /// Of a node of the body.
    template <class Value> void add(Index node, const Value& value, double volume) {
        const Index point = part_ ? part_->point[static_cast<std::size_t>(node)] : node;
        if (point < 0) return;
        sum_.col(point) += volume * value;
        volume_(point) += volume;
    }
    [[nodiscard]] std::vector<double> values() {
        for (Index i = 0; i < volume_.size(); ++i)
            if (volume_(i) > 0) sum_.col(i) /= volume_(i);
        return {sum_.data(), sum_.data() + sum_.size()};
    }

private:
    const std::optional<model::BodyPart>& part_;
    Matrix sum_;
    Vector volume_;
};

std::span<const char> elements_of(const std::optional<model::BodyPart>& part) {
    return part ? part->elements : std::span<const char>{};
}

/// Of an element type: natural gradients of its shape functions at the points of its quadrature rule, and the extrapolation from
/// there to its nodes (nodes x points).
struct StrainPoints {
    std::vector<Eigen::MatrixX3d> dN;
    Matrix to_nodes;
};

const StrainPoints& strain_points(mesh::CellType type) {
    return fe::with_element(type, []<class E>() -> const StrainPoints& {
        static const StrainPoints points = [] {
            StrainPoints all;
            for (const fe::QuadraturePoint& point : E::quadrature()) all.dN.emplace_back(E::gradient(point.xi));
            all.to_nodes = fe::extrapolation<E>();
            return all;
        }();
        return points;
    });
}

/// (6 x nodes of the element)
Matrix element_strain(const StrainPoints& points, const Eigen::Matrix3Xd& X, const Eigen::Matrix3Xd& u, bool finite) {
    Matrix strain(6, static_cast<Index>(points.dN.size()));
    for (std::size_t q = 0; q < points.dN.size(); ++q) {
        const Mat3 J = X * points.dN[q], H = u * points.dN[q] * J.inverse();
        Mat3 e = (H + H.transpose()) / 2;
        if (finite) e += H.transpose() * H / 2;
        strain.col(static_cast<Index>(q)) << e(0, 0), e(1, 1), e(2, 2), e(0, 1), e(1, 2), e(2, 0);
    }
    return strain * points.to_nodes.transpose();
}

} // namespace

std::vector<double> nodal_strain(const model::Body& body, const Field& u, const std::optional<model::BodyPart>& part) {
    NodalMean mean(body, part, 6);
    for_each_element(body, elements_of(part), [&](const ElementOf& element) {
        const auto block = static_cast<std::size_t>(element.block);
        const fe::ElementKernel& kernel = *body.kernels[block];
        const std::vector<Index> nodes = nodes_of(body, element);
        const Eigen::Matrix3Xd X = positions_of(body, nodes), ue = displacements_of(body, nodes, u);
        const double volume = kernel.volume(X);
        const Matrix strain =
            element_strain(strain_points(body.mesh.blocks[block].type), X, ue, kernel.finite_strain());
        for (std::size_t i = 0; i < nodes.size(); ++i) mean.add(nodes[i], strain.col(static_cast<Index>(i)), volume);
    });
    return mean.values();
}

std::vector<double> nodal_plastic_strain(const model::Model& model, Index b, const model::State& state,
                                         const std::optional<model::BodyPart>& part) {
    const model::Body& body = model.bodies[static_cast<std::size_t>(b)];
    NodalMean mean(body, part, 1);
    for_each_element(body, elements_of(part), [&](const ElementOf& element) {
        const fe::ElementKernel& kernel = *body.kernels[static_cast<std::size_t>(element.block)];
        const std::vector<Index> nodes = nodes_of(body, element);
        const Eigen::Matrix3Xd X = positions_of(body, nodes), ue = displacements_of(body, nodes, state.u);
        Vector strain = Vector::Zero(kernel.nodes());
        (void)kernel.nodal_plastic_strain({X, ue, history_of(model, b, element, state)}, strain);
        const double volume = kernel.volume(X);
        for (std::size_t i = 0; i < nodes.size(); ++i)
            mean.add(nodes[i], Eigen::Matrix<double, 1, 1>(std::max(0.0, strain(static_cast<Index>(i)))), volume);
    });
    return mean.values();
}

std::vector<double> nodal_energy_density(const model::Model& model, Index b, const model::State& state,
                                         const std::optional<model::BodyPart>& part) {
    const model::Body& body = model.bodies[static_cast<std::size_t>(b)];
    NodalMean mean(body, part, 1);
    for_each_element(body, elements_of(part), [&](const ElementOf& element) {
        const fe::ElementKernel& kernel = *body.kernels[static_cast<std::size_t>(element.block)];
        const std::vector<Index> nodes = nodes_of(body, element);
        const Eigen::Matrix3Xd X = positions_of(body, nodes), ue = displacements_of(body, nodes, state.u);
        const double volume = kernel.volume(X);
        double energy = 0;
        (void)kernel.energy({X, ue, history_of(model, b, element, state)},
                            energy); // 0 where it is not admissible, as in an iterate that failed
        for (const Index node : nodes) mean.add(node, Eigen::Matrix<double, 1, 1>(energy / volume), volume);
    });
    return mean.values();
}

} // namespace osculate::output

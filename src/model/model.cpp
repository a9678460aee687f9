#include "osculate/model/model.hpp"

namespace osculate::model {

namespace {

/// Calls f(kernel, global nodes, X (3 x n)) for every element of a body.
template <class F> void for_each_element(const Body& body, F&& f) {
    for (std::size_t b = 0; b < body.mesh.blocks.size(); ++b) {
        const mesh::ElementBlock& block = body.mesh.blocks[b];
        const fe::ElementKernel& kernel = *body.kernels[b];
        const int n = kernel.nodes();
        std::vector<Index> nodes(static_cast<std::size_t>(n));
        Eigen::Matrix3Xd X(3, n);
        for (Index e = 0; e < block.size(); ++e) {
            for (int i = 0; i < n; ++i) {
                const Index local = block.connectivity[static_cast<std::size_t>(n) * e + i];
                nodes[static_cast<std::size_t>(i)] = body.first_node + local;
                X.col(i) = body.mesh.nodes[local];
            }
            f(kernel, nodes, X);
        }
    }
}

} // namespace

BlockMatrix assemble_stiffness(const std::vector<Body>& bodies, Index nodes) {
    std::vector<std::vector<Index>> elements;
    for (const Body& body : bodies)
        for_each_element(body, [&](const fe::ElementKernel&, const std::vector<Index>& element,
                                   const Eigen::Matrix3Xd&) { elements.push_back(element); });
    BlockMatrix K(nodes, elements);
    for (const Body& body : bodies) {
        Matrix Ke;
        for_each_element(
            body, [&](const fe::ElementKernel& kernel, const std::vector<Index>& element, const Eigen::Matrix3Xd& X) {
                Ke.resize(3 * kernel.nodes(), 3 * kernel.nodes());
                kernel.stiffness(X, Ke);
                K.add(element, Ke);
            });
    }
    return K;
}

void add_body_force(const Body& body, const Vec3& b, std::vector<Vec3>& f) {
    for_each_element(
        body, [&](const fe::ElementKernel& kernel, const std::vector<Index>& element, const Eigen::Matrix3Xd& X) {
            Eigen::Matrix3Xd fe(3, kernel.nodes());
            kernel.body_force(X, b, fe);
            for (int i = 0; i < kernel.nodes(); ++i) f[element[static_cast<std::size_t>(i)]] += fe.col(i);
        });
}

Eigen::Matrix<double, Eigen::Dynamic, 6> nodal_stress(const Body& body, const std::vector<Vec3>& u) {
    Eigen::Matrix<double, Eigen::Dynamic, 6> stress = decltype(stress)::Zero(body.nodes(), 6);
    Vector weight = Vector::Zero(body.nodes());
    Matrix element_stress;
    for_each_element(
        body, [&](const fe::ElementKernel& kernel, const std::vector<Index>& element, const Eigen::Matrix3Xd& X) {
            Eigen::Matrix3Xd ue(3, kernel.nodes());
            for (int i = 0; i < kernel.nodes(); ++i) ue.col(i) = u[element[static_cast<std::size_t>(i)]];
            element_stress.resize(6, kernel.nodes());
            kernel.nodal_stress(X, ue, element_stress);
            const double volume = kernel.volume(X);
            for (int i = 0; i < kernel.nodes(); ++i) {
                const Index local = element[static_cast<std::size_t>(i)] - body.first_node;
                stress.row(local) += volume * element_stress.col(i).transpose();
                weight(local) += volume;
            }
        });
    for (Index i = 0; i < body.nodes(); ++i)
        if (weight(i) > 0) stress.row(i) /= weight(i);
    return stress;
}

} // namespace osculate::model

#include "osculate/model/model.hpp"

#include "osculate/model/moment_factors.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <stdexcept>
#include <utility>

namespace osculate::model {

namespace {

struct Element {
    const fe::ElementKernel& kernel;
    double density;
    std::vector<Index> nodes; ///< global
    Eigen::Matrix3Xd X;
};

/// Calls f(element) for every element of a body.
template <class F> void for_each_element(const Body& body, F&& f) {
    for (std::size_t b = 0; b < body.mesh.blocks.size(); ++b) {
        const mesh::ElementBlock& block = body.mesh.blocks[b];
        const int n = body.kernels[b]->nodes();
        Element element{*body.kernels[b], body.density.empty() ? 0 : body.density[b],
                        std::vector<Index>(static_cast<std::size_t>(n)), Eigen::Matrix3Xd(3, n)};
        for (Index e = 0; e < block.size(); ++e) {
            for (int i = 0; i < n; ++i) {
                const Index local = block.connectivity[static_cast<std::size_t>(n) * e + i];
                element.nodes[static_cast<std::size_t>(i)] = body.first_node + local;
                element.X.col(i) = body.mesh.nodes[local];
            }
            f(element);
        }
    }
}

} // namespace

std::vector<mesh::Facet> exterior_facets(const Body& body) {
    if (body.exterior.empty() && body.mesh.element_count() > 0)
        throw std::logic_error("the exterior facets of body " + body.name + " are unknown");
    std::vector<mesh::Facet> facets = body.exterior;
    for (mesh::Facet& facet : facets)
        for (int c = 0; c < facet.count; ++c) facet.nodes[static_cast<std::size_t>(c)] += body.first_node;
    return facets;
}

Lists neighbours(const std::vector<Body>& bodies, Index nodes) {
    Lists elements;
    Index last = 0;
    std::vector<Index> element;
    for (const Body& body : bodies) {
        last = body.first_node + body.nodes();
        if (body.rigid) { // its nodes have no equations
            for (Index node = body.first_node; node < last; ++node) elements.add({&node, 1});
            continue;
        }
        for (std::size_t b = 0; b < body.mesh.blocks.size(); ++b) {
            const mesh::ElementBlock& block = body.mesh.blocks[b];
            const auto n = static_cast<std::size_t>(body.kernels[b]->nodes());
            for (std::size_t e = 0; e < static_cast<std::size_t>(block.size()); ++e) {
                const auto first = block.connectivity.begin() + static_cast<std::ptrdiff_t>(n * e);
                element.assign(first, first + static_cast<std::ptrdiff_t>(n));
                for (Index& node : element) node += body.first_node;
                elements.add(element);
            }
        }
    }
    for (Index r = last; r + 1 < nodes; r += 2) elements.add(std::array{r, r + 1}); // of rigid bodies and couplings
    return linear::neighbours(nodes, elements);
}

namespace {

/// @param mass  (n x n) of an element
void element_mass(const fe::ElementKernel& kernel, const Eigen::Matrix3Xd& X, double density, bool lumped,
                  Matrix& mass) {
    mass.setZero(kernel.nodes(), kernel.nodes());
    if (lumped) {
        Vector m(kernel.nodes());
        kernel.lumped_mass(X, density, m);
        mass.diagonal() = m;
    } else {
        kernel.mass(X, density, mass);
    }
}

/// Takes the mass off the nodes marked and scales what is left to the same total.
/// @returns  false where nothing is left
bool redistribute(const std::vector<Index>& element, const std::vector<char>& massless, Matrix& mass) {
    const double total = mass.sum();
    for (Index i = 0; i < mass.rows(); ++i)
        if (massless[element[static_cast<std::size_t>(i)]] != 0) {
            mass.row(i).setZero();
            mass.col(i).setZero();
        }
    const double rest = mass.sum();
    if (!(rest > 0)) return false;
    mass *= total / rest;
    return true;
}

/// Positions from the middle of a body's box in halves of its extents, so that every moment is of the size of the mass.
struct BodyFrame {
    Vec3 centre, half;
    explicit BodyFrame(const Body& body) {
        Eigen::AlignedBox3d box;
        for (const Vec3& X : body.mesh.nodes) box.extend(X);
        centre = box.center();
        half = 0.5 * box.sizes();
    }
    [[nodiscard]] Eigen::Matrix3Xd operator()(const Eigen::Matrix3Xd& X) const {
        return half.cwiseInverse().asDiagonal() * (X.colwise() - centre);
    }
};

/// (elements) factors on redistribute()'s masses of a body that give it the moments it had, 0 for elements of marked
/// nodes alone; none where there are no such factors.
std::optional<std::vector<double>> redistribution(const Body& body, bool lumped, const std::vector<char>& massless) {
    const BodyFrame frame(body);
    Moments target = Moments::Zero();
    std::vector<Moments> parts;
    std::vector<std::size_t> element_of;
    std::size_t elements = 0;
    Matrix mass;
    for_each_element(body, [&](const Element& one) {
        const auto& [kernel, density, element, X] = one;
        const Eigen::Matrix3Xd x = frame(X);
        element_mass(kernel, X, density, lumped, mass);
        target += moments(mass, x);
        if (redistribute(element, massless, mass)) {
            parts.push_back(moments(mass, x));
            element_of.push_back(elements);
        }
        ++elements;
    });
    Eigen::Matrix<double, 10, Eigen::Dynamic> columns(10, static_cast<Index>(parts.size()));
    for (std::size_t p = 0; p < parts.size(); ++p) columns.col(static_cast<Index>(p)) = parts[p];
    const std::optional<Vector> found = moment_factors(columns, target);
    if (!found) return std::nullopt;
    std::vector<double> factors(elements, 0.0);
    for (std::size_t p = 0; p < parts.size(); ++p) factors[element_of[p]] = (*found)(static_cast<Index>(p));
    return factors;
}

} // namespace

AssembledMass assemble_mass(const std::vector<Body>& bodies, Index nodes, bool lumped,
                            const std::vector<char>& massless, const std::shared_ptr<const Share>& share) {
    AssembledMass assembled{linear::BlockMatrix(neighbours(bodies, nodes), share), {}};
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        const Body& body = bodies[b];
        if (body.rigid) continue;
        const auto first = massless.begin() + (massless.empty() ? 0 : body.first_node);
        std::optional<std::vector<double>> factors;
        if (!massless.empty() && body.has_mass() &&
            std::any_of(first, first + body.nodes(), [](char m) { return m != 0; })) {
            factors = redistribution(body, lumped, massless);
            if (!factors) assembled.kept.push_back(static_cast<Index>(b));
        }
        std::size_t e = 0;
        Matrix scalar, Me;
        for_each_element(body, [&](const Element& one) {
            const auto& [kernel, density, element, X] = one;
            const Index n = kernel.nodes();
            const double factor = factors ? (*factors)[e++] : 1;
            if (std::ranges::none_of(element, [&](Index node) { return assembled.M.has_row(node); })) return;
            element_mass(kernel, X, density, lumped, scalar);
            if (factors) {
                (void)redistribute(element, massless, scalar);
                scalar *= factor;
            }
            Me.setZero(3 * n, 3 * n);
            for (Index i = 0; i < n; ++i)
                for (Index k = 0; k < n; ++k) Me.block<3, 3>(3 * i, 3 * k).diagonal().setConstant(scalar(i, k));
            assembled.M.add(element, Me);
        });
    }
    return assembled;
}

linear::BlockMatrix assemble_stiffness(const std::vector<Body>& bodies, Lists neighbours,
                                       const std::shared_ptr<const Share>& share) {
    linear::BlockMatrix K(std::move(neighbours), share);
    for (const Body& body : bodies) {
        if (body.rigid) continue;
        Matrix Ke;
        for_each_element(body, [&](const Element& one) {
            const auto& [kernel, density, element, X] = one;
            if (!kernel.linear()) return;
            if (std::ranges::none_of(element, [&](Index node) { return K.has_row(node); })) return;
            Ke.resize(3 * kernel.nodes(), 3 * kernel.nodes());
            kernel.stiffness(X, Ke);
            K.add(element, Ke);
        });
    }
    return K;
}

Index body_index(const Model& model, Index any) {
    const Index node = material_node(model, any);
    const auto owns = [&](const Body& b) { return node >= b.first_node && node < b.first_node + b.nodes(); };
    const auto at = std::ranges::find_if(model.bodies, owns);
    return at == model.bodies.end() ? -1 : static_cast<Index>(at - model.bodies.begin());
}

const Body* body_of(const Model& model, Index node) {
    const Index b = body_index(model, node);
    return b < 0 ? nullptr : &model.bodies[static_cast<std::size_t>(b)];
}

Field internal_force(const Model& model, const BodyStep& step, int threads) {
    Field f(step.u.size());
    model.K.multiply_add_relative(step.u, f, threads);
    if (model.nonlinear) (void)model.nonlinear->add_force(model.X, step, f, threads);
    return f;
}

MaterialHistory initial_history(const Model& model) {
    std::size_t size = 0;
    for (std::size_t b = 0; b < model.bodies.size(); ++b) size += history_place(model.bodies, b).size;
    return MaterialHistory(size, 0.0);
}

double largest_stiffness(const Model& model) {
    double largest = model.nonlinear ? model.nonlinear->largest_stiffness() : 0;
    for (Index i = 0; i < model.K.rows(); ++i) // nodes of skins have no elements, and empty rows
        if (model.K.row_begin(i) < model.K.row_end(i))
            largest = std::max(largest, model.K.block(model.K.slot(i, i)).diagonal().maxCoeff());
    if (model.share) largest = model.share->ranks().largest(largest);
    return largest;
}

linear::BlockMatrix undeformed_stiffness(const Model& model, int threads) {
    linear::BlockMatrix K = model.K;
    if (!model.nonlinear) return K;
    const Field none(model.X.size());
    const MaterialHistory history = initial_history(model);
    model.nonlinear->add_tangent(model.X, {none, none, history}, K, threads);
    return K;
}

double strain_energy(const Model& model, const Field& u, const MaterialHistory& history, int threads) {
    Field f(u.size());
    model.K.multiply_add_relative(u, f, threads);
    const double linear = dot(u, f) / 2;
    return linear + (model.nonlinear ? model.nonlinear->energy(model.X, u, history, threads) : 0);
}

std::vector<double> volume_shares(const Model& model) {
    std::vector<double> share(model.X.size(), 0.0);
    for (const RigidBody& body : model.rigid) {
        constexpr double turning = 0.4; // second moment of a ball, of its radius
        share[static_cast<std::size_t>(body.reference)] = 1;
        share[static_cast<std::size_t>(body.rotation())] = turning;
    }
    for (const Body& body : model.bodies) {
        if (body.rigid) continue;
        double volume = 0;
        Vector part;
        for_each_element(body, [&](const Element& one) {
            const auto& [kernel, density, element, X] = one;
            part.resize(kernel.nodes());
            kernel.lumped_mass(X, 1, part);
            for (int i = 0; i < kernel.nodes(); ++i) share[element[static_cast<std::size_t>(i)]] += part(i);
            volume += part.sum();
        });
        for (Index i = 0; i < body.nodes(); ++i) share[body.first_node + i] /= volume;
    }
    return share;
}

Vec3 centre_of_mass(const Body& body) {
    // nodal shares of the mass, or of the volume, are exact for the first moment, too
    Field share(static_cast<std::size_t>(body.first_node + body.nodes()));
    body.has_mass() ? add_gravity(body, Vec3::UnitX(), share) : add_body_force(body, Vec3::UnitX(), share);
    Vec3 moment = Vec3::Zero();
    double mass = 0;
    for (Index i = 0; i < body.nodes(); ++i) {
        const double m = share[static_cast<std::size_t>(body.first_node + i)].x();
        moment += m * body.mesh.nodes[i];
        mass += m;
    }
    return moment / mass;
}

MassProperties mass_properties(const Body& body, double density) {
    MassProperties total;
    Vec3 first = Vec3::Zero();
    Mat3 second = Mat3::Zero(); // about the first node, which is near
    const Vec3& origin = body.mesh.nodes.front();
    Matrix mass;
    for_each_element(body, [&](const Element& one) {
        element_mass(one.kernel, one.X, density, false, mass);
        const Eigen::Matrix3Xd x = one.X.colwise() - origin;
        total.mass += mass.sum();
        first += x * mass.rowwise().sum();
        second += x * mass * x.transpose();
    });
    if (!(total.mass > 0)) return total;
    const Vec3 centre = first / total.mass;
    second -= total.mass * centre * centre.transpose();
    total.centre = origin + centre;
    total.inertia = second.trace() * Mat3::Identity() - second;
    return total;
}

namespace {
/// @param force  f(element) of a volume, N/m^3
template <class Force> void add_volume_force(const Body& body, Field& f, const Force& force) {
    for_each_element(body, [&](const Element& one) {
        Eigen::Matrix3Xd fe(3, one.kernel.nodes());
        one.kernel.body_force(one.X, force(one), fe);
        for (int i = 0; i < one.kernel.nodes(); ++i) f[one.nodes[static_cast<std::size_t>(i)]] += fe.col(i);
    });
}
} // namespace

void add_body_force(const Body& body, const Vec3& b, Field& f) {
    add_volume_force(body, f, [&](const Element&) { return b; });
}

void add_gravity(const Body& body, const Vec3& g, Field& f) {
    add_volume_force(body, f, [&](const Element& one) -> Vec3 { return one.density * g; });
}

void add_centrifugal_force(const Body& body, const Vec3& point, const Vec3& axis, double speed, Field& f) {
    // positions are interpolated as displacements are: the integral of N_i x is a product with the mass matrix
    Matrix mass;
    for_each_element(body, [&](const Element& one) {
        const auto& [kernel, density, element, X] = one;
        mass.setZero(kernel.nodes(), kernel.nodes());
        kernel.mass(X, density * speed * speed, mass);
        const Eigen::Matrix3Xd arm = X.colwise() - point;
        const Eigen::Matrix3Xd across = arm - axis * (axis.transpose() * arm);
        const Eigen::Matrix3Xd fe = across * mass;
        for (int i = 0; i < kernel.nodes(); ++i) f[element[static_cast<std::size_t>(i)]] += fe.col(i);
    });
}

Eigen::Matrix<double, Eigen::Dynamic, 6> nodal_stress(const Model& model, Index b, const State& state,
                                                      const std::optional<BodyPart>& part) {
    const Body& body = model.bodies[static_cast<std::size_t>(b)];
    std::size_t history = history_place(model.bodies, static_cast<std::size_t>(b)).first;
    const Index points = part ? part->points : body.nodes();
    Eigen::Matrix<double, Eigen::Dynamic, 6> stress = decltype(stress)::Zero(points, 6);
    if (body.rigid) return stress;
    Vector weight = Vector::Zero(points);
    Matrix element_stress;
    std::size_t number = 0;
    for_each_element(body, [&](const Element& one) {
        const auto& [kernel, density, element, X] = one;
        if (part && part->elements[number++] == 0) {
            history += kernel.history_size();
            return;
        }
        Eigen::Matrix3Xd ue(3, kernel.nodes());
        for (int i = 0; i < kernel.nodes(); ++i) ue.col(i) = state.u[element[static_cast<std::size_t>(i)]];
        element_stress.resize(6, kernel.nodes());
        kernel.nodal_stress({X, ue, std::span(state.material).subspan(history, kernel.history_size())}, element_stress);
        history += kernel.history_size();
        const double volume = kernel.volume(X);
        for (int i = 0; i < kernel.nodes(); ++i) {
            const Index local = element[static_cast<std::size_t>(i)] - body.first_node;
            const Index point = part ? part->point[static_cast<std::size_t>(local)] : local;
            if (point < 0) continue;
            stress.row(point) += volume * element_stress.col(i).transpose();
            weight(point) += volume;
        }
    });
    for (Index i = 0; i < points; ++i)
        if (weight(i) > 0) stress.row(i) /= weight(i);
    return stress;
}

} // namespace osculate::model

/// On a manufactured solution of linear elasticity, errors fall at the orders of theory: k + 1 in L2 and k in energy, with k
/// the degree of the element. Stiffness, supports and factorisation are the program's; loads and errors are integrated
/// here, far beyond what the elements' own rules can.

#include "fe/element_cases.hpp"
#include "fe/exact_rule.hpp"
#include "osculate/linear/system_matrix.hpp"
#include "osculate/solve/direct_solver.hpp"
#include "support/small_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <numbers>
#include <span>
#include <vector>

namespace osculate::fe::fixtures::OSCULATE_THIS_FILE {
namespace {

const material::LinearElastic material{1.0, 0.3};

/// A solution at one point.
struct Exact {
    Vec3 u = Vec3::Zero();
    Mat3 H = Mat3::Zero(); ///< H_ij = du_i/dX_j
    Vec3 b = Vec3::Zero(); ///< body force that holds the balance, b = -div sigma
};
using Solution = std::function<Exact(const Vec3&)>;

/// u = sum of A g(k . X), with g a sine, a cosine and an exponential:
///     H = g' A k^T,   div sigma = g'' ((lambda + mu) (k . A) k + mu (k . k) A)
Exact waves(const Vec3& X) {
    Exact exact;
    const auto add = [&](const Vec3& A, const Vec3& k, const auto& derivatives) {
        const auto [g, dg, ddg] = derivatives(k.dot(X));
        exact.u += g * A;
        exact.H += dg * A * k.transpose();
        exact.b -= ddg * ((material.lambda() + material.mu()) * k.dot(A) * k + material.mu() * k.dot(k) * A);
    };
    using Derivatives = std::array<double, 3>;
    add({1, -0.6, 0.4}, {1.3, 2.1, -0.9}, [](double s) { return Derivatives{std::sin(s), std::cos(s), -std::sin(s)}; });
    add({0.3, 0.8, -0.7}, {-1.7, 0.8, 1.9}, [](double s) {
        return Derivatives{std::cos(s), -std::sin(s), -std::cos(s)};
    });
    add({0.2, 0.3, 0.25}, {0.9, -1.1, 1.2}, [](double s) {
        return Derivatives{std::exp(s), std::exp(s), std::exp(s)};
    });
    return exact;
}

/// u_i = X^T Q_i X / 2 with symmetric Q_i and no zero among their entries:
///     H_ij = (Q_i X)_j,   (div sigma)_i = (lambda + mu) sum_j (Q_j)_ij + mu tr Q_i
Exact quadratic_field(const Vec3& X) {
    Exact exact;
    for (int i = 0; i < 3; ++i) {
        Mat3 Q;
        for (int k = 0; k < 9; ++k) Q(k % 3, k / 3) = scatter(20 + 9 * i + k);
        Q = (Q + Q.transpose()).eval();
        exact.u[i] = X.dot(Q * X) / 2;
        exact.H.row(i) = (Q * X).transpose();
        exact.b -= (material.lambda() + material.mu()) * Q.col(i);
        exact.b[i] -= material.mu() * Q.trace();
    }
    return exact;
}

/// Where a node of the unit cube's even mesh goes.
using Place = std::function<Vec3(const Vec3&)>;

bool at_an_end(double x) {
    return std::min(x, 1 - x) < 1e-9;
}

/// A smooth map of the cube onto itself. It bends all lines but the edges of the cube, whose faces stay plane.
Vec3 bent(const Vec3& X) {
    Vec3 x = X;
    for (int d = 0; d < 3; ++d)
        x[d] += 0.1 * std::sin(std::numbers::pi * X[d]) * std::cos(2 * X[(d + 1) % 3] + X[(d + 2) % 3]);
    return x;
}

/// The same, and every component is moved by up to `amount` at random; faces stay plane.
Place shaken(double amount) {
    return [amount, count = 0](const Vec3& X) mutable {
        Vec3 x = bent(X);
        for (int d = 0; d < 3; ++d, ++count)
            if (!at_an_end(X[d])) x[d] += amount * scatter(count);
        return x;
    };
}

enum class Edges { curved, straight };

/// The unit cube in n cells each way, and the nodes on its surface.
struct Cube {
    mesh::Mesh mesh;
    std::vector<Index> outside;

    /// @param edges  curved: `place` also moves the midside nodes
    Cube(mesh::CellType type, int n, const Place& place, Edges edges)
        : mesh(mesh::make_block({0, 0, 0}, {1, 1, 1}, {n, n, n}, type)) {
        for (Index i = 0; i < mesh.node_count(); ++i) {
            Vec3& X = mesh.nodes[static_cast<std::size_t>(i)];
            if (at_an_end(X.x()) || at_an_end(X.y()) || at_an_end(X.z())) outside.push_back(i);
            X = place(X);
        }
        if (edges == Edges::curved) return;
        const std::vector<Index>& all = mesh.blocks.front().connectivity;
        Eigen::Matrix3Xd X(3, mesh::nodes_per_cell(type));
        for (auto first = all.begin(); first != all.end(); first += X.cols()) {
            for (Index a = 0; a < X.cols(); ++a) X.col(a) = mesh.nodes[static_cast<std::size_t>(first[a])];
            straighten(type, X);
            for (Index a = 0; a < X.cols(); ++a) mesh.nodes[static_cast<std::size_t>(first[a])] = X.col(a);
        }
    }
};

/// Calls f(nodes, x, N, dN/dX, dV) for the points of a rule with 125 of them in every element.
template <class F> void for_each_point(const mesh::Mesh& mesh, F&& f) {
    const mesh::ElementBlock& block = mesh.blocks.front();
    with_element(block.type, [&]<class E>() {
        const std::vector<QuadraturePoint> rule = exact_rule<E>();
        std::vector<typename E::Shape> N;
        std::vector<typename E::Gradient> dN;
        for (const QuadraturePoint& point : rule) {
            N.push_back(E::shape(point.xi));
            dN.push_back(E::gradient(point.xi));
        }
        typename E::Positions X;
        for (std::span<const Index> rest = block.connectivity; !rest.empty(); rest = rest.subspan(E::nodes)) {
            const auto nodes = rest.template first<E::nodes>();
            for (int a = 0; a < E::nodes; ++a) X.col(a) = mesh.nodes[static_cast<std::size_t>(nodes[a])];
            for (std::size_t q = 0; q < rule.size(); ++q) {
                const Mat3 J = X * dN[q];
                ASSERT_GT(J.determinant(), 0) << "the mesh of the test is not one";
                f(nodes, Vec3(X * N[q]), N[q], typename E::Gradient(dN[q] * J.inverse()),
                  rule[q].weight * J.determinant());
            }
        }
    });
}

/// Displacements with the exact ones prescribed on the whole surface.
Field solve(const ElementCase& element, const Cube& cube, const Solution& exact) {
    support::SmallModel small;
    small.add_body("cube", cube.mesh, [&](mesh::CellType) { return element.kernel(material); });
    small.finish();
    const model::Model& model = small.model;
    Field u(model.X.size()), f(model.X.size()), K_u(model.X.size());
    for (const Index node : cube.outside) {
        u[node] = exact(model.X[node]).u;
        for (int d = 0; d < 3; ++d) small.constraints.push_back({node, Vec3::Unit(d)});
    }
    for_each_point(cube.mesh, [&](auto nodes, const Vec3& x, const auto& N, const auto&, double dV) {
        const Vec3 b = exact(x).b;
        for (std::size_t a = 0; a < nodes.size(); ++a) f[nodes[a]] += N[static_cast<Index>(a)] * dV * b;
    });
    model.K.multiply_add(u, K_u, 1);
    f.add(-1, K_u);
    const linear::Constraints constraints(model.nodes(), small.constraints);
    const linear::SystemMatrix system(constraints, model.K, {});
    Vector right(constraints.equations()), free(constraints.equations());
    constraints.gather(f, right);
    const auto solver = solve::make_cholesky();
    EXPECT_EQ(solver->factorise(system.matrix()), solve::FactorStatus::ok);
    solver->solve(right.data(), free.data());
    const Field prescribed = u;
    constraints.scatter(free, prescribed, u);
    return u;
}

struct Errors {
    double L2 = 0;     ///< square root of the integral of |u_h - u|^2
    double energy = 0; ///< the same of e : D : e, where e is the strain of u_h - u
};

/// Strain is that of the displacements at the nodes, also where a formulation has another one of its own.
Errors errors(const ElementCase& element, const Cube& cube, const Solution& exact) {
    const Field u = solve(element, cube, exact);
    const Mat6 D = material.stiffness();
    Errors squares;
    for_each_point(cube.mesh, [&](auto nodes, const Vec3& x, const auto& N, const auto& dN, double dV) {
        const Exact there = exact(x);
        Vec3 du = -there.u;
        Mat3 H = -there.H;
        for (std::size_t a = 0; a < nodes.size(); ++a) {
            du += N[static_cast<Index>(a)] * u[nodes[a]];
            H += u[nodes[a]] * dN.row(static_cast<Index>(a));
        }
        Vec6 e;
        e << H(0, 0), H(1, 1), H(2, 2), H(0, 1) + H(1, 0), H(1, 2) + H(2, 1), H(2, 0) + H(0, 2);
        squares.L2 += dV * du.squaredNorm();
        squares.energy += dV * e.dot(D * e);
    });
    return {std::sqrt(squares.L2), std::sqrt(squares.energy)};
}

/// log(e_coarse / e_fine) / log(n_fine / n_coarse) of the two finest meshes. Errors fall in every refinement.
/// @param cells  each way, ascending
/// @param make   the mesh of n cells each way
Errors orders(const ElementCase& element, const std::vector<int>& cells, const Solution& exact,
              const std::function<Cube(int n)>& make) {
    Errors last, order;
    for (std::size_t k = 0; k < cells.size(); ++k) {
        const Errors now = errors(element, make(cells[k]), exact);
        if (k > 0) {
            EXPECT_LT(now.L2, last.L2) << cells[k] << " cells each way";
            EXPECT_LT(now.energy, last.energy) << cells[k] << " cells each way";
            const double refined = std::log(double(cells[k]) / cells[k - 1]);
            order = {std::log(last.L2 / now.L2) / refined, std::log(last.energy / now.energy) / refined};
        }
        last = now;
    }
    return order;
}

class Elements : public ::testing::TestWithParam<ElementCase> {
protected:
    const mesh::CellType type = GetParam().type;
    const int degree = with_element(type, []<class E>() { return E::degree; });
    const std::vector<int> cells = degree == 1 ? std::vector{2, 4, 8, 12} : std::vector{2, 4, 6, 9};
    const double coarse = 0.05 * degree; // as far off are orders on such meshes: tet4 by 0.045, tet10 by 0.07

    void expect_orders_of_theory(const std::function<Cube(int n)>& make) const {
        const Errors order = orders(GetParam(), cells, waves, make);
        EXPECT_NEAR(order.L2, degree + 1, coarse);
        EXPECT_NEAR(order.energy, degree, coarse);
    }
};

TEST_P(Elements, ConvergeAtTheOrdersOfTheoryOnBentMeshes) {
    expect_orders_of_theory([&](int n) { return Cube(type, n, bent, Edges::curved); });
}

TEST_P(Elements, ConvergeAtTheOrdersOfTheoryOnIrregularMeshes) {
    // in parts of a cell; for hex20 and wedge15 it has to fade as meshes are refined, see below
    const bool fades = type == mesh::CellType::hex20 || type == mesh::CellType::wedge15;
    const auto amount = [&](int n) { return fades ? 0.15 * cells.front() / n : 0.15; };
    expect_orders_of_theory([&](int n) { return Cube(type, n, shaken(amount(n) / n), Edges::straight); });
}

INSTANTIATE_TEST_SUITE_P(Every, Elements, ::testing::ValuesIn(all_cases), case_name);

class QuadraticElements : public ::testing::TestWithParam<ElementCase> {};

TEST_P(QuadraticElements, ReproduceEveryQuadraticFieldIfTheyAreAffine) {
    // tetrahedra with straight edges, and parallelepipeds of different sizes
    constexpr double round_off = 1e-12; // fields of order one; hex20_reduced has stiffnesses a factor 1e-4 apart
    Mat3 A;
    A << 1.1, 0.2, 0.0, -0.1, 0.9, 0.1, 0.05, 0.0, 1.3;
    const Place sheared = [&](const Vec3& X) { return Vec3(A * (X + 0.3 * X.cwiseAbs2())); };
    const Place place = GetParam().type == mesh::CellType::tet10 ? shaken(0.05) : sheared;
    const Errors error = errors(GetParam(), Cube(GetParam().type, 3, place, Edges::straight), quadratic_field);
    EXPECT_LT(error.L2, round_off);
    EXPECT_LT(error.energy, round_off);
}

std::vector<ElementCase> quadratic_cases() {
    std::vector<ElementCase> cases;
    for (const ElementCase& element : all_cases)
        if (!mesh::cell_info(element.type).edges.empty()) cases.push_back(element);
    return cases;
}

INSTANTIATE_TEST_SUITE_P(Every, QuadraticElements, ::testing::ValuesIn(quadratic_cases()), case_name);

TEST(IrregularHex20, LosesAnOrderOnMeshesThatStayIrregular) {
    // a limit of all serendipity elements: only in parallelepipeds do they contain every quadratic field; measured 1.98
    // and 0.89                                   [Arnold, Boffi, Falk 2002, Math. Comp. 71, 909, for quadrilaterals]
    for (const HexFormulation formulation : {HexFormulation::full, HexFormulation::reduced}) {
        const ElementCase hex20{"hex20", mesh::CellType::hex20, formulation};
        const Errors order = orders(hex20, {2, 4, 8}, quadratic_field,
                                    [&](int n) { return Cube(hex20.type, n, shaken(0.15 / n), Edges::straight); });
        EXPECT_NEAR(order.L2, 2, 0.2);
        EXPECT_NEAR(order.energy, 1, 0.2);
    }
}

} // namespace
} // namespace osculate::fe::fixtures::OSCULATE_THIS_FILE

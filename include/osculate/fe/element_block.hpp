#pragma once
/// Kernels of one block of volume elements of the same kind, with one virtual interface per block.

#include "osculate/core/choices.hpp"
#include "osculate/core/types.hpp"
#include "osculate/material/j2_plasticity.hpp"
#include "osculate/material/linear_elastic.hpp"
#include "osculate/material/neo_hookean.hpp"
#include "osculate/material/orthotropic.hpp"
#include "osculate/material/saint_venant_kirchhoff.hpp"
#include "osculate/mesh/mesh.hpp"

#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace osculate::fe {

/// Deformation of an element. If it is not admissible, the step was too large; results are then zero, never NaN. At
/// small strain every deformation is admissible, because volumes are not computed.
struct Deformation {
    /// Least det F at the quadrature points; 0 if it is positive but below 1e-6, -infinity on numerical overflow, 1 at
    /// small strain.
    double smallest_J = 1;

    [[nodiscard]] bool admissible() const { return smallest_J > 0; }
};

/// How the forces of a step are averaged over it.
struct StepMean {
    double end_weight = 0.5; ///< weight of the step's end, 1 - alpha_f
    double viscosity = 0;    ///< stiffness damping over dt: adds viscosity D : (E1 - E0) to the stress
};

/// A state of one element: reference positions X and displacements u, 3 x n, m, node order VTK's, and its history from
/// earlier steps, history_size() numbers.
struct ElementState {
    Eigen::Ref<const Eigen::Matrix3Xd> X, u;
    std::span<const double> history{};
};

/// A step of one element: displacements at both ends and the history at its start. Elements without history do not need
/// `u_start` if there is no mean.
struct ElementStep {
    Eigen::Ref<const Eigen::Matrix3Xd> X, u_start, u;
    std::span<const double> history_start{};
    std::optional<StepMean> mean{}; ///< dynamics; none: forces at the end of the step
};

/// Kernels of one block of elements of the same kind; strain, material and formulation are chosen once, at
/// construction. n = nodes(). Every kernel throws std::runtime_error if the Jacobian of the reference map is not
/// positive. No allocation.
class ElementKernel {
public:
    virtual ~ElementKernel() = default;

    [[nodiscard]] virtual int nodes() const = 0;

    /// Whether the tangent equals the stiffness and the forces are K u for every u. Such an element has no history.
    [[nodiscard]] virtual bool linear() const = 0;
    /// Whether strains are computed from F, so that a rotation of the element causes no strain.
    [[nodiscard]] virtual bool finite_strain() const = 0;
    /// Length of the history that an element keeps from step to step; all zeros in the undeformed initial state.
    [[nodiscard]] virtual std::size_t history_size() const { return 0; }

    /// Whether the history holds thermal strains, set by heat(). They act on a step from its start.
    [[nodiscard]] virtual bool heated() const { return false; }
    /// Writes thermal strains, those of the nodes (n), into a history. @pre heated()
    virtual void heat(std::span<const double> strain, std::span<double> history) const = 0;

    /// Stiffness (3n x 3n) of the undeformed element without history, N/m, exactly symmetric; degrees of freedom node
    /// by node, x y z.
    virtual void stiffness(const Eigen::Ref<const Eigen::Matrix3Xd>& X, Eigen::Ref<Matrix> Ke) const = 0;

    /// Stored energy, J: the potential W(u) of elements that have one, the recoverable energy of others.
    [[nodiscard]] virtual Deformation energy(const ElementState& state, double& W) const = 0;

    /// Work that the material has dissipated until a state, J.
    [[nodiscard]] virtual double dissipated(const ElementState&) const { return 0; }
    /// Equivalent plastic strain (n), extrapolated from the quadrature points to the nodes. False: the material has none.
    virtual bool nodal_plastic_strain(const ElementState&, Eigen::Ref<Vector>) const { return false; }

    /// Computes a step: internal forces f (3 x n), N, and the history at its end. Without a mean, f = dW/du at the end
    /// if there is a potential. With a mean of end_weight 1/2, without viscosity and without mean dilatation, the work
    /// of f over the step equals the difference of the energies. At finite strain a rigid motion by any angle causes no
    /// viscous stress. The step may be computed repeatedly from the same start.
    ///                                 [Simo, Tarnow 1992, Z. angew. Math. Phys. 43, 757; Gonzalez 2000]
    [[nodiscard]] virtual Deformation update(const ElementStep& step, std::span<double> history,
                                             Eigen::Ref<Eigen::Matrix3Xd> f) const = 0;

    /// df/du (3n x 3n) of update(), N/m; exactly symmetric without a mean. Separate from f, because most residuals do
    /// not need it.
    [[nodiscard]] virtual Deformation tangent(const ElementStep& step, Eigen::Ref<Matrix> Ke) const = 0;

    /// Internal forces f (3 x n), N, of a state: those of a step of zero length.
    [[nodiscard]] Deformation internal_force(const ElementState& state, Eigen::Ref<Eigen::Matrix3Xd> f) const {
        std::vector<double> unchanged(state.history.size());
        return update({state.X, state.u, state.u, state.history}, unchanged, f);
    }

    /// Cauchy stress (6 x n), Pa, Voigt xx yy zz xy yz zx, extrapolated from the quadrature points to the nodes.
    virtual Deformation nodal_stress(const ElementState& state, Eigen::Ref<Matrix> stress) const = 0;

    /// Consistent nodal forces (3 x n), N, of a constant body force b, N/m^3.
    virtual void body_force(const Eigen::Ref<const Eigen::Matrix3Xd>& X, const Vec3& b,
                            Eigen::Ref<Eigen::Matrix3Xd> f) const = 0;

    /// Consistent mass (n x n), kg, for a density rho, kg/m^3: the same for x, y and z. Its entries sum to the mass.
    virtual void mass(const Eigen::Ref<const Eigen::Matrix3Xd>& X, double rho, Eigen::Ref<Matrix> Me) const = 0;

    /// Lumped mass (n), kg, for a density rho, kg/m^3: every entry is positive, their sum is the mass. If no shape
    /// function is negative, these are the row sums of the consistent mass, which preserve the centre of mass;
    /// otherwise its scaled diagonal.
    /// [Hinton, Rock, Zienkiewicz 1976, Earthq. Engng Struct. Dyn. 4, 245]
    virtual void lumped_mass(const Eigen::Ref<const Eigen::Matrix3Xd>& X, double rho, Eigen::Ref<Vector> m) const = 0;

    /// Volume, m^3.
    [[nodiscard]] virtual double volume(const Eigen::Ref<const Eigen::Matrix3Xd>& X) const = 0;
};

/// The kernel of a cell type: small strain for LinearElastic and Orthotropic, finite strain for the others. The formulation affects
/// only hexahedra; std::invalid_argument for incompatible modes at finite strain.
/// @param heated  temperatures change
[[nodiscard]] std::unique_ptr<ElementKernel> make_kernel(mesh::CellType type, HexFormulation formulation,
                                                         const material::LinearElastic& material, bool heated = false);
[[nodiscard]] std::unique_ptr<ElementKernel> make_kernel(mesh::CellType type, HexFormulation formulation,
                                                         const material::Orthotropic& material, bool heated = false);
[[nodiscard]] std::unique_ptr<ElementKernel> make_kernel(mesh::CellType type, HexFormulation formulation,
                                                         const material::SaintVenantKirchhoff& material,
                                                         bool heated = false);
[[nodiscard]] std::unique_ptr<ElementKernel> make_kernel(mesh::CellType type, HexFormulation formulation,
                                                         const material::NeoHookean& material, bool heated = false);
[[nodiscard]] std::unique_ptr<ElementKernel> make_kernel(mesh::CellType type, HexFormulation formulation,
                                                         const material::J2Plasticity& material, bool heated = false);

} // namespace osculate::fe

#pragma once
/// Kernels of one block of equal volume elements, behind one virtual interface per block.

#include "osculate/core/types.hpp"
#include "osculate/material/linear_elastic.hpp"
#include "osculate/material/neo_hookean.hpp"
#include "osculate/material/saint_venant_kirchhoff.hpp"
#include "osculate/mesh/mesh.hpp"

#include <memory>

namespace osculate::fe {

/// How a hexahedron keeps from locking. `full`: not at all. `b_bar`: a mean dilatation, against near incompressibility;
/// too soft in bending with a single element through the thickness; F-bar at finite strain. `incompatible_modes`:
/// internal bending modes, against locking in bending, and in near incompressibility too as long as elements are not badly
/// distorted; small strain only.
enum class HexFormulation { full, b_bar, incompatible_modes };

/// What an element says of its deformation. Where it is not admissible, results are zero, never NaN: the step is too
/// large. Small strain does not know of volumes and calls every deformation admissible.
struct Deformation {
    /// Least det F at the quadrature points; 0 where positive but below 1e-6, -infinity where numbers overflow, 1 at
    /// small strain.
    double smallest_J = 1;

    [[nodiscard]] bool admissible() const { return smallest_J > 0; }
};

/// How the forces of a step are averaged over it.
struct StepMean {
    double end_weight = 0.5; ///< of the step's end, 1 - alpha_f
    double viscosity = 0;    ///< stiffness damping over dt: adds viscosity D : (E1 - E0) to the stress
};

/// Kernels of one block of equal elements; strain, material and formulation are chosen once, at construction.
/// X holds the reference positions (3 x n, metres), u the displacements (3 x n, metres), n = nodes(), node order VTK's.
/// Every kernel throws std::runtime_error where the Jacobian of the reference map is not positive. No allocation.
class ElementKernel {
public:
    virtual ~ElementKernel() = default;

    [[nodiscard]] virtual int nodes() const = 0;

    /// Whether the tangent is the stiffness whatever u.
    [[nodiscard]] virtual bool linear() const = 0;

    /// Stiffness (3n x 3n) of the undeformed element, N/m, exactly symmetric; degrees of freedom node by node, x y z.
    virtual void stiffness(const Eigen::Ref<const Eigen::Matrix3Xd>& X, Eigen::Ref<Matrix> Ke) const = 0;

    /// Strain energy W, J.
    [[nodiscard]] virtual Deformation energy(const Eigen::Ref<const Eigen::Matrix3Xd>& X,
                                             const Eigen::Ref<const Eigen::Matrix3Xd>& u, double& W) const = 0;

    /// Internal forces f = dW/du (3 x n), N.
    [[nodiscard]] virtual Deformation internal_force(const Eigen::Ref<const Eigen::Matrix3Xd>& X,
                                                     const Eigen::Ref<const Eigen::Matrix3Xd>& u,
                                                     Eigen::Ref<Eigen::Matrix3Xd> f) const = 0;

    /// Tangent df/du (3n x 3n), N/m, exactly symmetric.
    [[nodiscard]] virtual Deformation tangent(const Eigen::Ref<const Eigen::Matrix3Xd>& X,
                                              const Eigen::Ref<const Eigen::Matrix3Xd>& u,
                                              Eigen::Ref<Matrix> Ke) const = 0;

    /// Internal forces of a step from u0 to u1, f (3 x n), N, whose work over u1 - u0 is the difference of the energies,
    /// with end_weight 1/2, without viscosity and without mean dilatation; and which a rigid motion by any angle does not
    /// call up. Admissible where u1 is.            [Simo, Tarnow 1992, Z. angew. Math. Phys. 43, 757; Gonzalez 2000]
    [[nodiscard]] virtual Deformation step_force(const Eigen::Ref<const Eigen::Matrix3Xd>& X,
                                                 const Eigen::Ref<const Eigen::Matrix3Xd>& u0,
                                                 const Eigen::Ref<const Eigen::Matrix3Xd>& u1, const StepMean& mean,
                                                 Eigen::Ref<Eigen::Matrix3Xd> f) const = 0;

    /// df/du1 (3n x 3n) of step_force, N/m, not symmetric.
    [[nodiscard]] virtual Deformation step_tangent(const Eigen::Ref<const Eigen::Matrix3Xd>& X,
                                                   const Eigen::Ref<const Eigen::Matrix3Xd>& u0,
                                                   const Eigen::Ref<const Eigen::Matrix3Xd>& u1, const StepMean& mean,
                                                   Eigen::Ref<Matrix> Ke) const = 0;

    /// Cauchy stress (6 x n), Pa, Voigt xx yy zz xy yz zx, carried from the quadrature points to the nodes.
    virtual Deformation nodal_stress(const Eigen::Ref<const Eigen::Matrix3Xd>& X,
                                     const Eigen::Ref<const Eigen::Matrix3Xd>& u, Eigen::Ref<Matrix> stress) const = 0;

    /// Consistent nodal forces (3 x n), N, of a constant body force b, N/m^3.
    virtual void body_force(const Eigen::Ref<const Eigen::Matrix3Xd>& X, const Vec3& b,
                            Eigen::Ref<Eigen::Matrix3Xd> f) const = 0;

    /// Consistent mass (n x n), kg, of a density rho, kg/m^3: the same for x, y and z. Its entries sum to the mass.
    virtual void mass(const Eigen::Ref<const Eigen::Matrix3Xd>& X, double rho, Eigen::Ref<Matrix> Me) const = 0;

    /// Lumped mass (n), kg, of a density rho, kg/m^3: every entry positive, their sum the mass. Row sums of the consistent
    /// mass, which keep the centre of mass, where no shape function is negative; its scaled diagonal otherwise.
    /// [Hinton, Rock, Zienkiewicz 1976, Earthq. Engng Struct. Dyn. 4, 245]
    virtual void lumped_mass(const Eigen::Ref<const Eigen::Matrix3Xd>& X, double rho, Eigen::Ref<Vector> m) const = 0;

    /// Volume, m^3.
    [[nodiscard]] virtual double volume(const Eigen::Ref<const Eigen::Matrix3Xd>& X) const = 0;
};

/// The kernel of a cell type: small strain for LinearElastic, finite strain for the others. The formulation matters to
/// hexahedra only; std::invalid_argument for incompatible modes at finite strain.
[[nodiscard]] std::unique_ptr<ElementKernel> make_kernel(mesh::CellType type, HexFormulation formulation,
                                                         const material::LinearElastic& material);
[[nodiscard]] std::unique_ptr<ElementKernel> make_kernel(mesh::CellType type, HexFormulation formulation,
                                                         const material::SaintVenantKirchhoff& material);
[[nodiscard]] std::unique_ptr<ElementKernel> make_kernel(mesh::CellType type, HexFormulation formulation,
                                                         const material::NeoHookean& material);

} // namespace osculate::fe

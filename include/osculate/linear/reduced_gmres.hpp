#pragma once
/// GMRES with a factorised ContactPreconditioner, over the nodes and forces of contact alone.

#include "osculate/linear/bearing_contact.hpp"
#include "osculate/linear/contact_preconditioner.hpp"
#include "osculate/solve/gmres.hpp"

#include <memory>
#include <span>
#include <vector>

namespace osculate::linear {

/// The tangent J and the preconditioner P have the same stiffness of the bodies. So J P^-1 is the identity except in the rows of
/// nodes that contact reaches, and after one solution with P the residual is zero in all others. What GMRES then iterates on are
/// vectors over these rows, and a product needs no stiffness, and of the factors what lies between these nodes:
///     P x = y:   lambda = S (y_c - B C u),   K u = y_e + C^T mu,   mu = S y_c - S~ C u,
///     J x = y_e + C^T mu + E lambda + G u in the equilibrium,   A u + D lambda in the contact laws
/// with the symbols of ContactPreconditioner and CondensedTangent; S~ is the stiffness of the springs.
class ReducedGmres {
public:
    /// The arguments must outlive this object.
    ReducedGmres(const Constraints& constraints, const Unknowns& rows, ContactPreconditioner& preconditioner,
                 int threads)
        : constraints_(constraints), rows_(rows), preconditioner_(preconditioner), threads_(threads) {}
    /// Computes x with |b - J x| <= allowed, up to round-off of the factors.
    /// @param contacts  couplings in contact, in their order
    /// @param D         (couplings) derivatives of the laws of the others by the contact force
    [[nodiscard]] solve::Gmres::Result solve(const std::vector<BearingContact>& contacts, std::span<const Mat3> D,
                                             const ConstVectorRef& b, VectorRef x, double allowed);

private:
    /// Makes sure that the chosen nodes are those that contact and springs reach, and few more.
    void reach(const std::vector<BearingContact>& contacts);
    /// Chooses these of all nodes, and their equations.
    void choose(const std::vector<char>& needed);
    [[nodiscard]] Vec3 law(const double* laws, Index coupling) const {
        return Eigen::Map<const Vec3>(laws + 3 * coupling);
    }
    /// Motion of slave j relative to its facet in P, for displacements of the contact nodes.
    [[nodiscard]] Vec3 relative(std::size_t j, const std::vector<Vec3>& u) const;
    /// Adds C^T force of spring j.
    void add_force(std::size_t j, const Vec3& force, std::vector<Vec3>& f) const;
    /// Sets u_, lambda_ and mu_ from displacements (equations) of the contact nodes in P, and right sides of the laws.
    void complete(const double* displacements, const double* laws);
    /// J x - (y_e, 0) for the x of complete()
    void apply_contact(const std::vector<BearingContact>& contacts, std::span<const Mat3> D, double* z);
    /// S y_c on slaves and masters, added to the right side of the displacements.
    void add_law_forces(const double* laws, double* load);

    const Constraints& constraints_;
    const Unknowns& rows_;
    ContactPreconditioner& preconditioner_;
    int threads_;
    std::vector<Index> nodes_, place_;             ///< contact nodes, global; number of a node among them, -1: none
    std::vector<solve::SparseIndex> equations_;    ///< of the contact nodes
    std::vector<Index> reduced_;                   ///< (3 contact nodes) place among equations_, -1: held
    std::vector<Vec3> u_, f_, lambda_, mu_, laws_; ///< (contact nodes) twice, (couplings) three times, global
    std::vector<Vector> on_;
    std::unique_ptr<solve::Gmres> gmres_;
    Index size_ = -1;
};

} // namespace osculate::linear

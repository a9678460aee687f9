#pragma once
/// Solves linear systems with the tangent of a step with linear bodies, on the nodes of the contact pairs alone.

#include "osculate/core/timing.hpp"
#include "osculate/linear/bearing_contact.hpp"
#include "osculate/linear/body_compliance.hpp"
#include "osculate/linear/contact_laws.hpp"
#include "osculate/linear/unknowns.hpp"
#include "osculate/solve/dense_lu.hpp"
#include "osculate/solve/gmres.hpp"

#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace osculate::linear {

/// Data of one body for condensation.
struct CondensedBody {
    Index first_node = 0, nodes = 0;
    bool loose = false; ///< only contact holds it, neither supports nor inertia
};

/// Three of the nodes, as far from one line as can be had; fewer where two of them would be the same. Ascending.
[[nodiscard]] std::vector<Index> three_apart(const std::vector<Index>& nodes, const Field& X);

/// With the bodies' stiffness K, contact forces lambda and, with respect to the displacements u_c of the contact nodes,
/// the derivatives A, D of the contact laws and E, G of the forces, the tangent reads
///     K u + G u_c + E lambda = r_e,    A u_c + D lambda = r_c.
/// K is factorised once for all steps of one length; its inverse W on the contact nodes follows from the factors. An
/// approximation of the tangent is
///     K u - C^T lambda = r_e,          B C u_c + D lambda = r_c
/// with the relative motions C of slave nodes and nearest facets. The dense matrix T = D + B C W C^T, over the forces
/// alone, solves it. GMRES over contact nodes and forces solves the rest; the interior of the bodies needs one solve
/// before and one after. A body held only by contact rests on springs; the spring forces are additional unknowns beside
/// lambda and cancel.
class CondensedTangent {
public:
    /// @param X        (nodes) reference positions, m
    /// @param contact  nodes that contact may reach, global, ascending
    /// @param slaves   (couplings) global nodes
    /// @param before   its inverses of bodies serve where they are over the same nodes; null: there are none
    CondensedTangent(const Constraints& constraints, const BlockMatrix& K, const Field& X,
                     const std::vector<CondensedBody>& bodies, std::vector<Index> contact, std::vector<Index> slaves,
                     int threads, const CondensedTangent* before = nullptr);
    /// Opens an attempt with K with this share of M (0 in statics); changed: K has new values.
    void begin(double mass_factor, bool changed);
    /// Keeps the current T, or restores the T of the last keep(): a rejected attempt leaves no trace.
    void keep() { kept_ = schur_; }
    void restore() { schur_ = kept_; }
    /// Contact laws of the last kept T, null if T must be computed; and restore() sets T back to that of such laws.
    [[nodiscard]] const ContactLaws* kept() const { return kept_.get(); }
    void restore(const ContactLaws& laws) { schur_ = kept_ = std::make_shared<SchurComplement>(laws); }
    /// Nodes that contact may reach.
    [[nodiscard]] const std::vector<Index>& nodes() const { return nodes_; }
    /// Whether contacts reach no others.
    [[nodiscard]] bool covers(const std::vector<BearingContact>& contacts) const;
    /// Sets the contacts of the next solve(): every coupling in contact, in their order. They must outlive it. @pre covers()
    void set(const std::vector<BearingContact>& contacts);
    /// Number of factorisations so far: of all bodies together, and of T.
    [[nodiscard]] int factorisations() const { return factorisations_; }
    /// Computes x with |b - J x| <= allowed. False if K or T is singular, or GMRES fails.
    /// @param D  (couplings) derivatives by lambda for the couplings without contact
    [[nodiscard]] bool solve(const Unknowns& rows, std::span<const Mat3> D, const ConstVectorRef& b, VectorRef x,
                             double allowed, Timings& timings);
    /// Adds the products of the transposed derivatives of contact with weights of forces at nodes and of laws: weights of
    /// displacements and of contact forces. Global numbers and components.
    using TransposedContact = std::function<void(const Field& of_nodes, const std::vector<Vec3>& of_laws,
                                                 Field& by_nodes, std::vector<Vec3>& by_forces)>;
    /// Computes w, of rows, with |b - J^T w| <= tolerance |b|, b of unknowns; unknowns of forces count by the stiffness of contact.
    /// False as solve().
    [[nodiscard]] bool solve_transposed(const Unknowns& rows, std::span<const Mat3> D, const TransposedContact& contact,
                                        const ConstVectorRef& b, VectorRef w, double tolerance, Timings& timings);

private:
    using Nodal = std::vector<Vec3>; ///< one per contact node, global components
    using Term = ContactLaws::Term;
    /// T, and the C, B and D of the contacts and then springs for which it was made.
    struct SchurComplement : ContactLaws {
        SchurComplement() = default;
        explicit SchurComplement(const ContactLaws& laws) : ContactLaws(laws) {}
        solve::DenseLu T;
        bool factorised = false, usable = false;
    };
    void factorise_bodies();
    /// All that is factorised. False if it is singular.
    [[nodiscard]] bool prepare(Timings& timings);
    /// Calls work(body) for every body, in parallel.
    void each_body(const std::function<void(std::size_t)>& work) const;
    [[nodiscard]] std::shared_ptr<SchurComplement> schur_complement() const;
    void factorise(SchurComplement& schur) const;
    void spread(const double* reduced, Nodal& nodal) const;
    void collect(const Nodal& nodal, double* reduced) const;
    /// reduced += C^T lambda; w = C u; over contacts, then springs
    void add_forces(const Vector& lambda, double* reduced) const;
    void relative(const ContactLaws& laws, const double* reduced, Vector& w) const;
    /// u = W f
    void apply_compliance(const double* f, double* u) const;
    /// The forces of contacts and then springs in P, for displacements u without these forces and right sides r of the
    /// contact laws.
    [[nodiscard]] Vector contact_forces(const Vector& u, const double* r) const;
    /// The same in P^T: weights of laws, T^T w = r + C u.
    [[nodiscard]] Vector law_weights(const Vector& u, const double* r) const;
    /// reduced -= C^T B^T w
    void subtract_laws(const Vector& weights, double* reduced) const;
    /// P^-1 y on the contact nodes: forces, displacements, and f with K u = f.
    void precondition(const double* y, Vector& lambda, Vector& u, Vector& f) const;
    /// C^T lambda + E lambda + G u, and A u + D lambda
    void apply_contact(const Vector& lambda, const Vector& u, double* z) const;
    [[nodiscard]] Index forces() const { return 3 * static_cast<Index>(contacts_->size()); }

    const Constraints& constraints_;
    const BlockMatrix* K_;
    int threads_;
    std::vector<Index> slaves_; ///< by coupling
    std::vector<Index> nodes_;  ///< contact nodes, global, ascending
    std::vector<Index> place_;  ///< (nodes of the model) number among the contact nodes, -1: none
    std::vector<std::shared_ptr<BodyCompliance>> bodies_; ///< perhaps shared with those before or after
    std::vector<Index> body_of_;                          ///< (contact nodes)
    std::vector<Index> first_;                            ///< (bodies + 1) first reduced displacement
    std::vector<Index> reduced_; ///< (3 contact nodes) reduced displacement of a local component, -1: held
    std::vector<Index> sprung_;  ///< contact nodes on springs
    double spring_ = 0;
    double mass_factor_ = 0;
    bool factorised_ = false, usable_ = true;
    int factorisations_ = 0;
    const std::vector<BearingContact>* contacts_ = nullptr;
    mutable std::vector<Vector> on_;                ///< scratch of apply_contact()
    std::shared_ptr<SchurComplement> schur_, kept_; ///< null: must be computed
    std::unique_ptr<solve::Gmres> gmres_;
    Index gmres_size_ = -1;
};

} // namespace osculate::linear

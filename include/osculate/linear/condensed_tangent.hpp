#pragma once
/// Solves with the tangent of a step whose bodies are linear, on the nodes of the contact pairs alone.

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

/// One body as condensation sees it.
struct CondensedBody {
    Index first_node = 0, nodes = 0;
    bool loose = false; ///< contact alone holds it, neither supports nor inertia
};

/// With the bodies' stiffness K, contact forces lambda and, over the displacements u_c of the contact nodes, the contact
/// laws' derivatives A, D and the forces' E, G, the tangent reads
///     K u + G u_c + E lambda = r_e,    A u_c + D lambda = r_c.
/// K is factorised once for all steps of one length, and its inverse W on the contact nodes taken from the factors. What is
/// near the tangent is
///     K u - C^T lambda = r_e,          B C u_c + D lambda = r_c
/// with the relative motions C of slave nodes and nearest facets, so that T = D + B C W C^T, dense, over the forces alone
/// solves it. GMRES over contact nodes and forces does the rest; the bodies' inside takes one solve before and one after.
/// A body that nothing holds but contact stands on springs, whose forces are unknowns beside lambda and cancel.
class CondensedTangent {
public:
    /// @param X        (nodes) reference positions, m
    /// @param contact  nodes that contact may reach, global, ascending
    /// @param slaves   (couplings) global nodes
    CondensedTangent(const Constraints& constraints, const BlockMatrix& K, const Field& X,
                     const std::vector<CondensedBody>& bodies, std::vector<Index> contact, std::vector<Index> slaves,
                     int threads);
    /// Opens an attempt: K belongs to dt (0 in statics), and has changed since the last.
    void begin(double dt, bool changed) {
        dt_ = dt;
        if (changed) factorised_ = false;
        if (schur_ && schur_->dt != dt) schur_ = nullptr;
    }
    /// T stays as it is, or goes back to what it was at the last keep(): an attempt that is rejected leaves no trace.
    void keep() { kept_ = schur_; }
    void restore() { schur_ = kept_; }
    /// What T was last kept for, null where it is to be made; and T for such laws, as it was then.
    [[nodiscard]] const ContactLaws* kept() const { return kept_.get(); }
    void restore(const ContactLaws& laws) { schur_ = kept_ = std::make_shared<SchurComplement>(laws); }
    /// Contacts of the next solve(): every coupling that bears, in their order. They must outlive it.
    void set(const std::vector<BearingContact>& contacts);
    /// How many there have been: of all bodies together, and T's.
    [[nodiscard]] int factorisations() const { return factorisations_; }
    /// x with |b - J x| <= allowed. False where K or T is singular, or GMRES gets nowhere.
    /// @param D  (couplings) by lambda, of those that bear on nothing
    [[nodiscard]] bool solve(const Unknowns& rows, std::span<const Mat3> D, const ConstVectorRef& b, VectorRef x,
                             double allowed, Timings& timings);

private:
    using Nodal = std::vector<Vec3>; ///< by contact node, global components
    using Term = ContactLaws::Term;
    /// T, with C, B and D of contacts, then springs, that it is of.
    struct SchurComplement : ContactLaws {
        SchurComplement() = default;
        explicit SchurComplement(const ContactLaws& laws) : ContactLaws(laws) {}
        solve::DenseLu T;
        bool factorised = false, usable = false;
    };
    void factorise_bodies();
    /// Bodies side by side.
    void each_body(const std::function<void(std::size_t)>& work) const;
    [[nodiscard]] std::shared_ptr<SchurComplement> schur_complement() const;
    void factorise(SchurComplement& schur) const;
    void spread(const double* reduced, Nodal& nodal) const;
    void collect(const Nodal& nodal, double* reduced) const;
    /// reduced += C^T lambda, C u; over contacts, then springs
    void add_forces(const Vector& lambda, double* reduced) const;
    void relative(const ContactLaws& laws, const double* reduced, Vector& w) const;
    /// u = W f
    void apply_compliance(const double* f, double* u) const;
    /// The forces of P, contacts' then springs', for displacements u without them and contact laws' right sides r.
    [[nodiscard]] Vector contact_forces(const Vector& u, const double* r) const;
    /// P^-1 y on the contact nodes: forces, displacements, and f, K u = f.
    void precondition(const double* y, Vector& lambda, Vector& u, Vector& f) const;
    /// C^T lambda + E lambda + G u, and A u + D lambda
    void apply_contact(const Vector& lambda, const Vector& u, double* z) const;
    [[nodiscard]] Index forces() const { return 3 * static_cast<Index>(contacts_->size()); }

    const Constraints& constraints_;
    const BlockMatrix* K_;
    int threads_;
    std::vector<Index> slaves_; ///< by coupling
    std::vector<Index> nodes_;  ///< contact nodes, global, ascending
    std::vector<Index> place_;  ///< (nodes of the model) among contact nodes, -1
    std::vector<BodyCompliance> bodies_;
    std::vector<Index> body_of_; ///< (contact nodes)
    std::vector<Index> first_;   ///< (bodies + 1) first reduced displacement
    std::vector<Index> reduced_; ///< (3 contact nodes) reduced displacement of a local component, -1 held
    std::vector<Index> sprung_;  ///< contact nodes on springs
    double spring_ = 0;
    double dt_ = 0;
    bool factorised_ = false, usable_ = true;
    int factorisations_ = 0;
    const std::vector<BearingContact>* contacts_ = nullptr;
    mutable std::vector<Vector> on_;                ///< scratch of apply_contact()
    std::shared_ptr<SchurComplement> schur_, kept_; ///< null: to be made
    std::unique_ptr<solve::Gmres> gmres_;
    Index gmres_size_ = -1;
};

} // namespace osculate::linear

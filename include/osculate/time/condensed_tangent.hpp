#pragma once
/// Solves with the tangent of a step whose bodies are linear, on the nodes of the contact pairs alone.

#include "osculate/contact/contact_point.hpp"
#include "osculate/core/timing.hpp"
#include "osculate/model/body_compliance.hpp"
#include "osculate/model/model.hpp"
#include "osculate/model/system_matrix.hpp"
#include "osculate/solve/dense_lu.hpp"
#include "osculate/solve/gmres.hpp"
#include "osculate/time/contact_preconditioner.hpp"

#include <memory>
#include <span>
#include <vector>

namespace osculate::time {

/// Derivatives of one slave node's contact law and of the forces on its masters, as SystemMatrix takes them.
struct ContactTangent {
    bool reaches = false; ///< false: only D means anything
    Mat3 D = Mat3::Zero();
    contact::MatrixX3 E;
    Matrix A, G, dd;
    contact::ContactVariation variation;
};

/// One slave node that bears.
struct BearingContact {
    const ContactTangent* tangent = nullptr; ///< without G
    const model::ContactTerm* pair = nullptr;
    Index slave = -1;             ///< of the pair
    Vec3 force = Vec3::Zero();    ///< lambda where the tangent was taken, N
    std::span<const Index> nodes; ///< masters, as in the tangent
    SoftContact law;              ///< with the nearest facet in place of the patch

    /// Derivatives along the motion u(node) of global nodes and a force: of the contact law, and of the forces on the
    /// masters, as they stand on the left of the equilibrium, by add(node, force). The slave's own is -force.
    template <class U, class Add> Vec3 multiply(const U& u, const Vec3& lambda, Add&& add) const {
        static thread_local Vector dy, on;
        dy.resize(3 + 3 * static_cast<Index>(nodes.size()));
        dy.head<3>() = u(law.where.slave);
        for (std::size_t i = 0; i < nodes.size(); ++i) dy.segment<3>(3 + 3 * static_cast<Index>(i)) = u(nodes[i]);
        const Vec3 value = tangent->A * dy + tangent->D * lambda;
        pair->master_force_along(slave, force, tangent->variation, dy, on);
        for (Index i = 0; i < on.size() / 3; ++i)
            add(nodes[static_cast<std::size_t>(i)],
                Vec3(tangent->E.middleRows<3>(3 * i) * lambda - on.segment<3>(3 * i)));
        add(law.where.slave, Vec3(-lambda));
        return value;
    }
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
    /// Estimates of the work, in floating-point operations, and of the memory for W and T.
    struct Cost {
        double condensed = 0;   ///< W of all bodies and some T's
        double factorising = 0; ///< one sparse factorisation of all bodies
        double bytes = 0;
        /// Whether to condense: what it costs once is made up for within a few iterations, and fits.
        [[nodiscard]] bool pays() const;
    };
    [[nodiscard]] static Cost cost(const model::Model& model);

    CondensedTangent(const model::Model& model, const model::Constraints& constraints, const model::BlockMatrix& K,
                     const std::vector<Index>& slaves, bool inertia);
    /// Opens an attempt: K belongs to dt (0 in statics), and has changed since the last.
    void begin(double dt, bool changed) {
        dt_ = dt;
        if (changed) factorised_ = false;
        if (laws_ && laws_->dt != dt) laws_ = nullptr;
    }
    /// T stays as it is, or goes back to what it was at the last keep(): an attempt that is rejected leaves no trace.
    void keep() { kept_ = laws_; }
    void restore() { laws_ = kept_; }
    /// Contacts of the next solve(): every coupling that bears, in their order. They must outlive it.
    void set(const std::vector<BearingContact>& contacts);
    /// How many there have been: of all bodies together, and T's.
    [[nodiscard]] int factorisations() const { return factorisations_; }
    /// x with |b - J x| <= allowed. False where K or T is singular, or GMRES gets nowhere.
    /// @param D  (couplings) by lambda, of those that bear on nothing
    [[nodiscard]] bool solve(const model::SystemMatrix& rows, std::span<const Mat3> D, const double* b, double* x,
                             double allowed, Timings& timings);

private:
    using Nodal = std::vector<Vec3>; ///< by contact node, global components
    /// One node of the relative motion C, or of the springs'.
    struct Term {
        Index node; ///< contact node
        Mat3 by;    ///< global components
    };
    /// C, B and D of contacts, then springs, and T of them.
    struct Laws {
        std::vector<Index> couplings;
        std::vector<std::vector<Term>> terms;
        std::vector<Mat3> B, D;
        solve::DenseLu T;
        double dt = 0;
        bool usable = false;
    };
    void factorise_bodies();
    [[nodiscard]] std::shared_ptr<const Laws> factorise_laws() const;
    void spread(const double* reduced, Nodal& nodal) const;
    void collect(const Nodal& nodal, double* reduced) const;
    /// reduced += C^T lambda, C u; over contacts, then springs
    void add_forces(const Vector& lambda, double* reduced) const;
    void relative(const Laws& laws, const double* reduced, Vector& w) const;
    void comply(const double* f, double* u) const;
    /// P^-1 y on the contact nodes: forces, displacements, and f, K u = f.
    void nearly(const double* y, Vector& lambda, Vector& u, Vector& f) const;
    /// C^T lambda + E lambda + G u, and A u + D lambda
    void laws(const Vector& lambda, const Vector& u, double* z) const;
    [[nodiscard]] Index forces() const { return 3 * static_cast<Index>(contacts_->size()); }

    const model::Model& model_;
    const model::Constraints& constraints_;
    const model::BlockMatrix* K_;
    std::vector<Index> slaves_; ///< by coupling
    std::vector<Index> nodes_;  ///< contact nodes, global, ascending
    std::vector<Index> place_;  ///< (nodes of the model) among contact nodes, -1
    std::vector<model::BodyCompliance> bodies_;
    std::vector<Index> first_;   ///< (bodies + 1) first reduced displacement
    std::vector<Index> reduced_; ///< (3 contact nodes) reduced displacement of a local component, -1 held
    std::vector<Index> sprung_;  ///< contact nodes on springs
    double spring_ = 0;
    double dt_ = 0;
    bool factorised_ = false, usable_ = true;
    int factorisations_ = 0;
    const std::vector<BearingContact>* contacts_ = nullptr;
    std::shared_ptr<const Laws> laws_, kept_; ///< null: to be made
    std::unique_ptr<solve::Gmres> gmres_;
    Index gmres_size_ = -1;
};

} // namespace osculate::time

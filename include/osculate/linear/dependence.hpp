#pragma once
/// Nodes whose motion follows from that of other nodes, and which therefore have no equations of their own, or fewer.

#include "osculate/core/field.hpp"

#include <span>
#include <vector>

namespace osculate::linear {

/// A node i moves with its carriers a, and the forces on it act on them:
///     du_i = keeps_i du_i + sum_a moves_ia du_a,    f_a += loads_ia f_i,    f_i <- (keeps_i + rests_i) f_i.
/// What rests is zero, but for nodes that something else holds along some directions. keeps is zero, but for nodes that
/// follow others along some directions only: the projector on those along which they have equations of their own. loads
/// is the transpose of moves where forces and motions belong to the same instant; it differs from it where forces are
/// means over a step.
class Dependence {
public:
    struct Carrier {
        Index node = -1;
        Mat3 moves = Mat3::Identity(), loads = Mat3::Identity();
    };

    /// @param nodes  number of all nodes, none of which depends on others yet
    explicit Dependence(Index nodes) : list_(static_cast<std::size_t>(nodes), -1) {}
    /// Sets the carriers of a node, others than itself. They must not depend on others, but for those that keep
    /// directions of their own: what they carry must be along these.
    void set(Index node, std::vector<Carrier> carriers, const Mat3& rests = Mat3::Zero(),
             const Mat3& keeps = Mat3::Zero());

    [[nodiscard]] bool empty() const { return nodes_.empty(); }
    [[nodiscard]] bool depends(Index node) const { return list_[static_cast<std::size_t>(node)] >= 0; }
    /// Whether it has equations of its own.
    [[nodiscard]] bool owns(Index node) const {
        const Index place = list_[static_cast<std::size_t>(node)];
        return place < 0 || !keeps_[static_cast<std::size_t>(place)].isZero(0);
    }
    /// Projector on the directions of these.
    [[nodiscard]] Mat3 keeps(Index node) const {
        const Index place = list_[static_cast<std::size_t>(node)];
        return place < 0 ? Mat3(Mat3::Identity()) : keeps_[static_cast<std::size_t>(place)];
    }
    /// Dependent nodes, in the order in which they were first set.
    [[nodiscard]] const std::vector<Index>& nodes() const { return nodes_; }
    /// @pre depends(node)
    [[nodiscard]] std::span<const Carrier> carriers(Index node) const {
        return carriers_[static_cast<std::size_t>(list_[static_cast<std::size_t>(node)])];
    }

    /// Sets the motions of dependent nodes from those of their carriers, (all nodes) global components.
    void move(Field& du) const;
    /// Moves the forces on dependent nodes to their carriers; on them there is what rests. (all nodes) global components.
    void fold(Field& f) const;
    /// The same for sums of absolute values.
    void fold_magnitudes(Field& sums) const;

private:
    std::vector<Index> list_; ///< (all nodes) number among the dependent nodes, -1: independent
    std::vector<Index> nodes_;
    std::vector<std::vector<Carrier>> carriers_; ///< (dependent nodes)
    std::vector<Mat3> rests_, keeps_;            ///< (dependent nodes)
};

/// A point of contact between a slave node and master nodes, of which some depend on others: the nodes that take their
/// place, with the derivatives of SystemMatrix::add_contact.
struct FoldedContact {
    std::vector<Index> masters; ///< independent nodes, those that carry force first
    Matrix A, E, G;

    /// @param masters  global nodes, those that carry force first
    /// @param A        (3 x 3+3n) of the law
    /// @param E        (3m x 3) of the forces by the contact force
    /// @param G        (3m x 3+3n) of the forces; empty: not wanted
    FoldedContact(const Dependence& dependence, Index slave, std::span<const Index> masters,
                  const Eigen::Ref<const Matrix>& A,
                  const Eigen::Ref<const Eigen::Matrix<double, Eigen::Dynamic, 3>>& E,
                  const Eigen::Ref<const Matrix>& G);
};

/// Whether FoldedContact would change anything.
[[nodiscard]] bool any_depends(const Dependence& dependence, Index slave, std::span<const Index> masters);
/// Adds the carriers of dependent nodes to a list of nodes, and takes these nodes out of it.
void replace_dependent(const Dependence& dependence, Index slave, std::vector<Index>& masters);

} // namespace osculate::linear

#include "multigrid/free_nodes.hpp"

namespace osculate::solve {

FreeNodes::FreeNodes(const NodalUnknowns& unknowns) : node_(unknowns.node), body_(unknowns.body) {
    number_.assign(node_.empty() ? 0 : static_cast<std::size_t>(node_.back()) + 1, -1);
    for (std::size_t i = 0; i < node_.size(); ++i) {
        number_[node_[i]] = static_cast<Index>(i);
        Mat3 projection = Mat3::Zero();
        bool whole = true;
        for (std::size_t k = 0; k < 3; ++k)
            if (unknowns.equation[3 * i + k] >= 0) {
                const Vec3 axis = unknowns.frame[i].col(static_cast<Index>(k));
                projection += axis * axis.transpose();
            } else
                whole = false;
        whole_.push_back(whole ? 1 : 0);
        projection_.push_back(whole ? Mat3(Mat3::Identity()) : projection);
    }
}

} // namespace osculate::solve

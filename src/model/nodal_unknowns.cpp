#include "osculate/model/nodal_unknowns.hpp"

#include "osculate/model/rigid_motion.hpp"

namespace osculate::model {

solve::NodalUnknowns nodal_unknowns(const Model& model, const linear::Constraints& constraints) {
    solve::NodalUnknowns result;
    Index moving = 0;
    for (Index node = 0; node < model.nodes(); ++node) moving += constraints.free_components(node) > 0;
    result.near_kernel.setZero(3 * moving, 6);
    for (const Body& body : model.bodies) {
        const Index last = body.first_node + body.nodes();
        const auto [centre, radius] = extent(body, model.X);
        for (Index node = body.first_node; node < last; ++node)
            for (int k = 0; k < 3 && constraints.free_components(node) > 0; ++k) {
                const Index e = constraints.equation(node, k), row = static_cast<Index>(result.equation.size());
                result.equation.push_back(e == linear::Constraints::held ? -1 : e);
                if (e == linear::Constraints::held) continue;
                const Vec3 d = constraints.frame(node).col(k);
                result.near_kernel.row(row) << d.transpose(), (model.X[node] - centre).cross(d).transpose() / radius;
            }
    }
    return result;
}

} // namespace osculate::model

#include "osculate/model/model.hpp"

namespace osculate::model {

void add_replicas(const Model& model, Replicas& replicas) {
    replicas.add(model.X);
    replicas.add(model.initial_velocity);
    for (const Body& body : model.bodies) {
        replicas.add(body.mesh.nodes);
        replicas.add(body.mesh.node_ids);
        for (const mesh::ElementBlock& block : body.mesh.blocks) replicas.add(block.connectivity);
    }
    if (model.share) replicas.add(model.share->owner());
}

} // namespace osculate::model

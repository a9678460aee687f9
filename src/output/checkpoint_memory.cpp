#include "output/checkpoint_memory.hpp"

namespace osculate::output {

namespace {

/// Nodes, each with other nodes: couplings and springs.
template <class T> Json links(const std::vector<T>& list) {
    std::vector<Index> slaves;
    Ragged<Index> masters;
    for (const T& link : list) {
        slaves.push_back(link.slave);
        masters.add(link.masters);
    }
    return {{"slave", packed(slaves)}, {"count", packed(masters.length)}, {"master", packed(masters.value)}};
}

template <class T> std::vector<T> links(const Json& json, const char* name) {
    const auto slaves = unpacked<Index>(json, "slave");
    const auto masters = Ragged<Index>{unpacked<Index>(json, "count"), unpacked<Index>(json, "master")}.lists(name);
    if (slaves.size() != masters.size()) incomplete(name);
    std::vector<T> list(slaves.size());
    for (std::size_t i = 0; i < list.size(); ++i) {
        list[i].slave = slaves[i];
        list[i].masters = masters[i];
    }
    return list;
}

Json to_json(const linear::ContactLaws& laws) {
    Ragged<Index> nodes;
    std::vector<Mat3> by;
    for (const auto& terms : laws.terms) {
        nodes.length.push_back(static_cast<Index>(terms.size()));
        for (const auto& term : terms) {
            nodes.value.push_back(term.node);
            by.push_back(term.by);
        }
    }
    return {{"mass_factor", laws.mass_factor}, {"couplings", packed(laws.couplings)}, {"count", packed(nodes.length)},
            {"node", packed(nodes.value)},     {"by", packed_matrices(by)},           {"B", packed_matrices(laws.B)},
            {"D", packed_matrices(laws.D)}};
}

linear::ContactLaws contact_laws(const Json& json) {
    linear::ContactLaws laws;
    laws.mass_factor = number<double>(json, "mass_factor");
    laws.couplings = unpacked<Index>(json, "couplings");
    const auto nodes = Ragged<Index>{unpacked<Index>(json, "count"), unpacked<Index>(json, "node")}.lists("laws");
    const auto by = unpacked_matrices<Mat3>(json, "by");
    std::size_t at = 0;
    for (const std::vector<Index>& list : nodes) {
        auto& terms = laws.terms.emplace_back();
        for (const Index node : list) {
            if (at == by.size()) incomplete("laws");
            terms.push_back({node, by[at++]});
        }
    }
    laws.B = unpacked_matrices<Mat3>(json, "B");
    laws.D = unpacked_matrices<Mat3>(json, "D");
    return laws;
}

Json to_json(const linear::KeptFactors& factors) {
    std::vector<linear::Spring> springs;
    std::vector<Mat3> follow, B, D;
    std::vector<Vec3> normal;
    std::vector<double> c;
    for (const linear::SoftContact& contact : *factors.contacts) {
        springs.push_back(contact.where);
        follow.insert(follow.end(), contact.where.follow.begin(), contact.where.follow.end());
        normal.push_back(contact.normal);
        B.push_back(contact.B);
        D.push_back(contact.D);
        c.push_back(contact.c);
    }
    return {{"mass_factor", factors.mass_factor},
            {"fresh", factors.fresh},
            {"wasted", factors.wasted},
            {"springs", links(springs)},
            {"follow", packed_matrices(follow)},
            {"normal", packed_matrices(normal)},
            {"B", packed_matrices(B)},
            {"D", packed_matrices(D)},
            {"c", packed(c)}};
}

linear::KeptFactors kept_factors(const Json& json) {
    linear::KeptFactors factors;
    factors.mass_factor = number<double>(json, "mass_factor");
    factors.fresh = number<double>(json, "fresh");
    factors.wasted = number<double>(json, "wasted");
    const auto springs = links<linear::Spring>(member(json, "springs"), "factors");
    const auto follow = unpacked_matrices<Mat3>(json, "follow"), B = unpacked_matrices<Mat3>(json, "B"),
               D = unpacked_matrices<Mat3>(json, "D");
    const auto normal = unpacked_matrices<Vec3>(json, "normal");
    const auto c = unpacked<double>(json, "c");
    if (B.size() != springs.size() || D.size() != springs.size() || normal.size() != springs.size() ||
        c.size() != springs.size())
        incomplete("factors");
    std::vector<linear::SoftContact> contacts;
    std::size_t at = 0;
    for (std::size_t j = 0; j < springs.size(); ++j) {
        linear::SoftContact& contact = contacts.emplace_back();
        contact.coupling = static_cast<Index>(j);
        contact.where = springs[j];
        if (contact.where.masters.size() > follow.size() - at) incomplete("factors");
        for (std::size_t i = 0; i < contact.where.masters.size(); ++i) contact.where.follow.push_back(follow[at++]);
        contact.normal = normal[j];
        contact.B = B[j];
        contact.D = D[j];
        contact.c = c[j];
    }
    if (at != follow.size()) incomplete("factors");
    factors.contacts = std::make_shared<const std::vector<linear::SoftContact>>(std::move(contacts));
    return factors;
}

} // namespace

Json to_json(const equilibrium::EquilibriumMemory& memory) {
    Json json{{"couplings", links(memory.couplings)}};
    if (memory.springs) json["springs"] = links(*memory.springs);
    if (memory.laws) json["laws"] = to_json(*memory.laws);
    if (memory.factors) json["factors"] = to_json(*memory.factors);
    if (!memory.condensed.empty()) json["condensed"] = packed(memory.condensed);
    return json;
}

equilibrium::EquilibriumMemory equilibrium_memory(const Json& json) {
    equilibrium::EquilibriumMemory memory;
    memory.couplings = links<linear::Coupling>(member(json, "couplings"), "couplings");
    if (json.contains("springs")) memory.springs = links<linear::Spring>(json["springs"], "springs");
    if (json.contains("laws")) memory.laws = contact_laws(json["laws"]);
    if (json.contains("factors")) memory.factors = kept_factors(json["factors"]);
    if (json.contains("condensed")) memory.condensed = unpacked<Index>(json, "condensed");
    return memory;
}

} // namespace osculate::output

#include "osculate/mesh/instances.hpp"

#include <algorithm>
#include <iterator>

namespace osculate::mesh {

const Instance* Instances::of(long long id) const {
    const auto after = std::ranges::lower_bound(all_, id, {}, &Instance::before);
    return after == all_.begin() ? nullptr : &*std::prev(after);
}

std::string Instances::shown(long long id) const {
    const Instance* instance = of(id);
    if (instance == nullptr) return std::to_string(id);
    return std::to_string(id - instance->before) + " of instance '" + instance->name + "'";
}

} // namespace osculate::mesh

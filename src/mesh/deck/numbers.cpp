#include "mesh/deck/numbers.hpp"

#include <algorithm>
#include <limits>

namespace osculate::mesh {

DeckOrder::const_iterator first_from(const DeckOrder& order, long long id) {
    return std::lower_bound(order.begin(), order.end(), std::pair(id, std::numeric_limits<Index>::min()));
}

Index find_id(const DeckOrder& order, long long id) {
    const auto at = first_from(order, id);
    return at != order.end() && at->first == id ? at->second : -1;
}

void DeckNumbers::index(DeckReading& reading) {
    const std::string file = reading.deck.files.empty() ? "" : reading.deck.files.front();
    if (order_.size() > static_cast<std::size_t>(std::numeric_limits<Index>::max() / 10)) {
        reading.faults.add(file, "too many " + word_ + "s");
        order_.clear();
    }
    if (!std::is_sorted(order_.begin(), order_.end())) std::sort(order_.begin(), order_.end());
    for (std::size_t k = 1; k < order_.size(); ++k)
        if (order_[k].first == order_[k - 1].first)
            reading.faults.add(file, word_ + " " + reading.deck.instances.shown(order_[k].first) + " is defined twice");
    if (order_.empty() || order_.back().first > 4 * static_cast<long long>(order_.size()) + 1000) return;
    dense_.assign(static_cast<std::size_t>(order_.back().first) + 1, -1);
    for (const auto& [id, number] : order_) dense_[static_cast<std::size_t>(id)] = number;
}

} // namespace osculate::mesh

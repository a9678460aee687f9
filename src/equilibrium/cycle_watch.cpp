#include "osculate/equilibrium/cycle_watch.hpp"

#include <algorithm>

namespace osculate::equilibrium {

void CycleWatch::begin() {
    recent_.clear();
    last_configuration_ = 0;
    restart();
}

void CycleWatch::restart() {
    visits_.clear();
    best_ = std::numeric_limits<double>::max();
    idle_ = slow_ = 0;
    round_ = false;
}

void CycleWatch::note(const Statuses& statuses, double residual) {
    constexpr std::size_t most_remembered = 8;
    if (recent_.empty() || recent_.back() != statuses) {
        if (recent_.size() == most_remembered) recent_.erase(recent_.begin());
        recent_.push_back(statuses);
    }
    // in the slip branch Newton can also alternate with all statuses at rest
    const int patience = impatient_ ? 4 : 8;
    idle_ = residual < 0.99 * best_ ? 0 : idle_ + 1;
    slow_ = residual < 0.5 * best_ ? 0 : slow_ + 1;
    best_ = std::min(best_, residual);
    round_ = idle_ >= patience || comes_back(statuses, residual);
}

bool CycleWatch::comes_back(const Statuses& statuses, double residual) {
    // the iteration goes round when it comes back to a contact configuration it has left, for the second time and
    // without having gained anything
    std::size_t configuration = 1469598103934665603ULL;
    const auto mix = [&](std::size_t value) { configuration = (configuration ^ value) * 1099511628211ULL; };
    for (const auto& pair : statuses)
        for (const contact::Status status : pair) mix(static_cast<std::size_t>(status) + 1);
    auto& [times, least] = visits_.try_emplace(configuration, 0, residual).first->second;
    bool round = false;
    if (configuration != last_configuration_ && times > 0) {
        round = (times > 1 || impatient_) && residual > 0.5 * least;
        ++times;
    } else if (times == 0) {
        times = 1;
    }
    least = std::min(least, residual);
    last_configuration_ = configuration;
    return round;
}

} // namespace osculate::equilibrium

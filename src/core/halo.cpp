#include "osculate/core/halo.hpp"

namespace osculate {

Halo::Halo(Ranks& ranks, std::vector<std::vector<Index>> wanted)
    : ranks_(&ranks), wanted_(std::move(wanted)), sent_(wanted_.size()), out_(wanted_.size()), in_(wanted_.size()) {
    const std::size_t count = wanted_.size(), own = static_cast<std::size_t>(ranks.rank());
    std::vector<double> lengths, all(count * count);
    for (const auto& list : wanted_) lengths.push_back(static_cast<double>(list.size()));
    ranks.gather(lengths, std::vector<int>(count, static_cast<int>(count)), all.data());
    for (std::size_t r = 0; r < count; ++r) {
        out_[r].assign(wanted_[r].begin(), wanted_[r].end());
        in_[r].resize(static_cast<std::size_t>(all[count * r + own]));
    }
    ranks.exchange(out_, in_);
    for (std::size_t r = 0; r < count; ++r) {
        for (const double place : in_[r]) sent_[r].push_back(static_cast<Index>(place));
        out_[r].resize(sent_[r].size());
        in_[r].resize(wanted_[r].size());
    }
}

void Halo::fill(double* x) {
    for (std::size_t r = 0; r < sent_.size(); ++r)
        for (std::size_t k = 0; k < sent_[r].size(); ++k) out_[r][k] = x[sent_[r][k]];
    ranks_->exchange(out_, in_);
    for (std::size_t r = 0; r < wanted_.size(); ++r)
        for (std::size_t k = 0; k < wanted_[r].size(); ++k) x[wanted_[r][k]] = in_[r][k];
}

} // namespace osculate

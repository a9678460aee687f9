#pragma once
/// Numbers of nodes or elements.

#include <algorithm>
#include <cstdint>
#include <vector>

namespace osculate::mesh {

/// Numbers from 1 on, in any order, with gaps: a bit each where they lie close, else a search.
class TagSet {
public:
    void add(std::int64_t tag) { tags_.push_back(tag); }

    /// To be called behind the last one; a number that is there twice, or 0.
    std::int64_t finish() {
        if (!std::is_sorted(tags_.begin(), tags_.end())) std::sort(tags_.begin(), tags_.end());
        if (const auto twice = std::adjacent_find(tags_.begin(), tags_.end()); twice != tags_.end()) return *twice;
        constexpr std::int64_t spread = 64; // a bit each takes no more than the numbers themselves
        if (tags_.empty() || (most() - least()) / spread > static_cast<std::int64_t>(tags_.size())) return 0;
        bits_.assign(static_cast<std::size_t>(most() - least()) + 1, false);
        for (const std::int64_t tag : tags_) bits_[static_cast<std::size_t>(tag - least())] = true;
        return 0;
    }

    [[nodiscard]] std::int64_t least() const { return tags_.empty() ? 0 : tags_.front(); }
    [[nodiscard]] std::int64_t most() const { return tags_.empty() ? 0 : tags_.back(); }

    [[nodiscard]] bool contains(std::int64_t tag) const {
        if (tags_.empty() || tag < least() || tag > most()) return false;
        if (!bits_.empty()) return bits_[static_cast<std::size_t>(tag - least())];
        return std::binary_search(tags_.begin(), tags_.end(), tag);
    }

private:
    std::vector<std::int64_t> tags_;
    std::vector<bool> bits_;
};

} // namespace osculate::mesh

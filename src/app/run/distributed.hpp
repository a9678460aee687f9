#pragma once
/// A run by several processes, as its user sees it.

#include "osculate/core/ranks.hpp"

#include <filesystem>

namespace osculate::app {

/// The first process speaks and writes. The others do the same work, as they take the same decisions, and write their pieces of the
/// frames; their other files go to a folder that is removed, and what they say is kept for the case that one fails alone.
class Distributed {
public:
    /// Ends all processes where this one has no room for its files.
    /// @throws RunFailure if MPI cannot be loaded
    Distributed();
    ~Distributed();
    Distributed(const Distributed&) = delete;
    Distributed& operator=(const Distributed&) = delete;

    [[nodiscard]] const std::shared_ptr<Ranks>& ranks() const { return ranks_; }
    [[nodiscard]] bool first() const { return ranks_->rank() == 0; }
    /// Where files go that nobody will read.
    [[nodiscard]] std::filesystem::path scratch() const { return scratch_ / "run"; }
    /// To be called at last: ends all processes, and says why where this one ends alone.
    /// @param surprise  the end is one that the others are not likely to come to
    void leave(int code, bool surprise);

private:
    void hide_what_is_said();
    std::shared_ptr<Ranks> ranks_;
    std::filesystem::path scratch_; ///< empty: the first process
    int told_ = -1;                 ///< the real stderr
};

} // namespace osculate::app

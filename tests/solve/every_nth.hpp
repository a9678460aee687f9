#pragma once
/// Vectors that several processes share for tests.

#include "osculate/core/slices.hpp"

namespace osculate::solve::fixtures {

/// Every n-th number is a process' own; all are read. With more processes than numbers, some have none.
class EveryNth final : public Slices {
public:
    EveryNth(Ranks& ranks, Index size) : ranks_(ranks), size_(size) {
        for (Index i = ranks.rank(); i < size; i += ranks.count()) own_.push_back(i);
    }
    [[nodiscard]] Ranks& ranks() const override { return ranks_; }
    [[nodiscard]] const std::vector<Index>& own() const override { return own_; }
    void fill_unknowns(double* x) override { fill(x); }
    void fill_rows(double* r) override { fill(r); }
    void gather(std::span<const double> own_values, double* x) const override {
        const auto count = static_cast<Index>(ranks_.count());
        std::vector<int> lengths;
        for (Index r = 0; r < count; ++r)
            lengths.push_back(static_cast<int>(r < size_ ? (size_ - r - 1) / count + 1 : 0));
        std::vector<double> all(static_cast<std::size_t>(size_));
        ranks_.gather(own_values, lengths, all.data());
        const double* from = all.data();
        for (Index r = 0; r < count; ++r)
            for (Index i = r; i < size_; i += count) x[i] = *from++;
    }

private:
    void fill(double* x) {
        std::vector<double> values;
        for (const Index i : own_) values.push_back(x[i]);
        gather(values, x);
    }
    Ranks& ranks_;
    Index size_;
    std::vector<Index> own_;
};

} // namespace osculate::solve::fixtures

#pragma once
/// KINSOL's vectors: whole ones, or a process' own slices.

#include "osculate/core/shared_pages.hpp"
#include "osculate/core/slices.hpp"
#include "osculate/core/types.hpp"

#include <memory>
#include <sundials/sundials_nvector.h>
#include <type_traits>

namespace osculate::solve {

struct VectorDeleter {
    void operator()(N_Vector v) const { N_VDestroy(v); }
};
using VectorPtr = std::unique_ptr<std::remove_pointer_t<N_Vector>, VectorDeleter>;

class KinsolVectors {
public:
    /// @param size  of whole vectors
    KinsolVectors(Index size, int threads, SUNContext context) : size_(size), threads_(threads), context_(context) {}

    /// Null: vectors are whole. @returns whether those made before have another shape, or there are none
    [[nodiscard]] bool shape_for(Slices* slices);
    /// Lets go of the scratch; shape_for() makes it again.
    void release() {
        shaped_ = false;
        for (Vector* whole : {&whole_in, &whole_out}) whole->resize(0);
    }
    /// Before products, which write parts of the scratch; what they read of others is of no account.
    void forget_whole() {
        for (Vector* whole : {&whole_in, &whole_out}) forget({whole->data(), static_cast<std::size_t>(whole->size())});
    }
    [[nodiscard]] bool in_slices() const { return slices_ != nullptr; }
    [[nodiscard]] Slices* slices() const { return slices_; }
    /// One more vector. @pre shape_for()
    [[nodiscard]] VectorPtr make() const;
    /// Takes a whole vector (size) over, or one's own of it.
    void take(const ConstVectorRef& whole, N_Vector to) const;
    /// Gives the whole vector (size) to all processes; collective.
    void give(N_Vector from, VectorRef whole) const;
    /// Whether all numbers of a vector are finite, those of other processes, too; collective.
    [[nodiscard]] bool finite(N_Vector v) const;

    Vector whole_in, whole_out; ///< (size) scratch where there are slices, else empty

private:
    [[nodiscard]] Index length() const { return in_slices() ? static_cast<Index>(slices_->own().size()) : size_; }

    Index size_;
    int threads_;
    SUNContext context_;
    bool shaped_ = false;
    Slices* slices_ = nullptr;
};

} // namespace osculate::solve

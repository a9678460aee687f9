#include "solve/kinsol_vectors.hpp"

#include "solve/gmres_vector.hpp"

#include <algorithm>
#include <cmath>
#include <nvector/nvector_serial.h>

namespace osculate::solve {

bool KinsolVectors::shape_for(Slices* slices) {
    if (shaped_ && slices_ == slices) return false;
    shaped_ = true;
    slices_ = slices;
    for (Vector* whole : {&whole_in, &whole_out}) whole->setZero(in_slices() ? size_ : 0);
    return true;
}

VectorPtr KinsolVectors::make() const {
    if (!in_slices()) return VectorPtr(N_VNew_Serial(size_, context_));
    const VectorPtr like(make_gmres_vector(length(), &slices_->ranks(), threads_, context_));
    return VectorPtr(N_VClone(like.get()));
}

void KinsolVectors::take(const ConstVectorRef& whole, N_Vector to) const {
    double* own = N_VGetArrayPointer(to);
    if (!in_slices())
        Eigen::Map<Vector>(own, size_) = whole;
    else
        for (const Index place : slices_->own()) *own++ = whole[place];
}

void KinsolVectors::give(N_Vector from, VectorRef whole) const {
    const double* own = N_VGetArrayPointer(from);
    if (!in_slices())
        whole = Eigen::Map<const Vector>(own, size_);
    else
        slices_->gather({own, slices_->own().size()}, whole.data());
}

bool KinsolVectors::finite(N_Vector v) const {
    const double* first = N_VGetArrayPointer(v);
    const bool own = std::all_of(first, first + length(), [](double value) { return std::isfinite(value); });
    return in_slices() ? slices_->ranks().largest(own ? 0 : 1) == 0 : own;
}

} // namespace osculate::solve

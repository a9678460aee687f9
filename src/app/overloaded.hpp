#pragma once
/// One visitor out of several lambdas, for std::visit.

namespace osculate::app {

template <class... F> struct Overloaded : F... { using F::operator()...; };
template <class... F> Overloaded(F...) -> Overloaded<F...>;

} // namespace osculate::app

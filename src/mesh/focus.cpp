#include "osculate/mesh/focus.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace osculate::mesh {
namespace {

constexpr double most = 10000; ///< elements along one axis

/// 1 + ratio + ... of n terms.
double geometric_sum(double ratio, int n) {
    return ratio == 1 ? n : std::expm1(n * std::log(ratio)) / (ratio - 1);
}

/// Distances from the point of the ends of the elements that reach to `length`, which is the last of them.
std::vector<double> outward(double length, const Focus& focus) {
    std::vector<double> ends;
    if (length <= 0) return ends;
    // elements of the given size until the rest is better shared out at once
    const double fine = std::min(length, std::max(focus.extent, focus.size));
    if (fine / focus.size > most) throw std::invalid_argument("the elements of focus are too small for its extent");
    constexpr double round_off = 1e-9; // of an element
    const int equal = static_cast<int>(std::ceil(fine / focus.size - round_off));
    const double size = fine == length ? length / equal : focus.size;
    for (int i = 1; i <= equal; ++i) ends.push_back(size * i);
    const double rest = length - ends.back();
    if (rest <= round_off * size) {
        ends.back() = length;
        return ends;
    }
    // the fewest elements that reach the end at the growth allowed; then the growth at which they reach it exactly
    int count = 1;
    while (size * focus.growth * geometric_sum(focus.growth, count) < rest && count < most) ++count;
    if (count >= most) throw std::invalid_argument("the elements of focus are too small for the block");
    double low = 0, high = focus.growth;
    for (int i = 0; i < 200 && low < high; ++i) {
        const double middle = (low + high) / 2;
        (size * middle * geometric_sum(middle, count) < rest ? low : high) = middle;
    }
    double step = size, end = ends.back();
    for (int i = 1; i < count; ++i) ends.push_back(end += step *= high);
    ends.push_back(length);
    return ends;
}

} // namespace

std::vector<double> focused_lines(double start, double end, double at, const Focus& focus) {
    if (!(focus.growth >= 1) || !std::isfinite(focus.growth))
        throw std::invalid_argument("growth of focus must be finite and at least 1");
    if (!(focus.size > 0) || !(focus.extent >= 0) || !std::isfinite(focus.extent) || !std::isfinite(at))
        throw std::invalid_argument("size of focus must be positive, its extent not negative, its point finite");
    at = std::clamp(at, start, end);
    std::vector<double> lines;
    for (const double distance : outward(at - start, focus)) lines.push_back(at - distance);
    std::reverse(lines.begin(), lines.end());
    lines.push_back(at);
    for (const double distance : outward(end - at, focus)) lines.push_back(at + distance);
    lines.front() = start;
    lines.back() = end;
    return lines;
}

} // namespace osculate::mesh

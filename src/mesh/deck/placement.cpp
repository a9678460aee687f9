#include "mesh/deck/placement.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <vector>

namespace osculate::mesh {

bool read_vector(std::span<const std::string_view> fields, Vec3& x) {
    x = Vec3::Zero();
    for (std::size_t d = 0; d < 3 && d < fields.size(); ++d)
        if (!fields[d].empty() && !to_number(fields[d], x[static_cast<Index>(d)])) return false;
    return true;
}

std::string written(const Vec3& x) {
    std::string text;
    std::array<char, 32> digits{};
    for (const double value : x) {
        const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
        text += (text.empty() ? "" : ", ") + std::string(digits.data(), end);
    }
    return text;
}

Eigen::Isometry3d placement_of(const Deck& deck, const DeckCard& card, DeckFaults& faults) {
    Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
    const auto fail = [&](std::size_t line, const std::string& what) {
        const DeckLine& at = *(deck.begin(card) + static_cast<std::ptrdiff_t>(line));
        faults.add(deck.place(at), what + ", found '" + shown(at.source) + "'");
        return motion;
    };
    const std::size_t lines = card.last - card.first;
    if (lines == 0) return motion;
    if (lines > 2) return fail(2, "an *INSTANCE has at most two data lines, a translation and a rotation");
    std::vector<std::string_view> fields;
    split_fields(deck.begin(card)->text, fields);
    Vec3 along;
    if (fields.size() > 3 || !read_vector(fields, along))
        return fail(0, "the first line of an *INSTANCE is its translation, x, y, z (0, 0, 0 where it is only rotated)");
    motion.translation() = along;
    if (lines == 1) return motion;
    split_fields((deck.begin(card) + 1)->text, fields);
    const std::span<const std::string_view> all(fields);
    constexpr std::size_t wanted = 7;
    Vec3 a, b;
    double degrees = 0;
    if (fields.size() != wanted || !read_vector(all.first(3), a) || !read_vector(all.subspan(3, 3), b) ||
        !to_number(fields[6], degrees))
        return fail(1, "the second line of an *INSTANCE is its rotation, seven numbers: x, y, z of two points on the "
                       "axis and an angle in degrees");
    if (!((b - a).norm() > 0)) return fail(1, "the two points on the axis of an *INSTANCE must differ");
    if (degrees == 0) return motion;
    const Eigen::AngleAxisd turn(degrees * std::numbers::pi / 180, (b - a).normalized());
    return Eigen::Isometry3d(Eigen::Translation3d(a) * turn * Eigen::Translation3d(along - a));
}

} // namespace osculate::mesh

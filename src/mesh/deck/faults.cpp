#include "mesh/deck/faults.hpp"

#include "osculate/mesh/mesh_error.hpp"

#include <utility>

namespace osculate::mesh {
namespace {

constexpr std::size_t listed = 20;

} // namespace

void DeckFaults::add(const std::string& place, const std::string& what) {
    if (++count_ <= listed) first_.push_back(place + ": " + what);
}

void DeckFaults::throw_if_any() {
    if (count_ > listed) first_.push_back("and " + std::to_string(count_ - listed) + " more");
    if (!first_.empty()) throw MeshError(std::move(first_));
}

std::string shown(std::string_view text) {
    constexpr std::size_t most = 60;
    return std::string(text.substr(0, most)) + (text.size() > most ? "..." : "");
}

} // namespace osculate::mesh

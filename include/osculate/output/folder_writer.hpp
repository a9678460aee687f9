#pragma once
/// Which process writes into a folder.

#include <filesystem>
#include <optional>

namespace osculate::output {

/// The process that its manifest names and that holds the manifest's lock, by the kernel's list of locks: one that was
/// killed holds none. Nothing where that list is not there, or where the process is not seen from here (another machine,
/// another container). Takes no lock itself, so that no run is ever refused for it.
[[nodiscard]] std::optional<long> writer_of(const std::filesystem::path& folder);

} // namespace osculate::output

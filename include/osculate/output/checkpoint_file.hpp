#pragma once
/// Checkpoints on disk: what a run needs to go on, and what its files held then.

#include "osculate/output/series.hpp"
#include "osculate/output/summary.hpp"
#include "osculate/time/checkpoint.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace osculate::output {

struct CheckpointFile {
    std::string version;      ///< of the program
    std::string scene;        ///< resolved, as scene.yaml holds it
    std::uint64_t meshes = 0; ///< fingerprint(), of what files may have changed since
    time::Checkpoint run;
    std::vector<SeriesEntry> frames{};                            ///< written
    std::vector<std::pair<std::string, std::uintmax_t>> tables{}; ///< by path in the run's folder, bytes written
    Summary::Steps steps;
    long iterations = 0;
    double total_seconds = 0, cpu_seconds = 0;
    std::vector<double> seconds{}; ///< by Part
    std::vector<double> checks{};  ///< what they have found so far
};

/// Of nodes and elements of all bodies, placed as they are.
[[nodiscard]] std::uint64_t fingerprint(const model::Model& model);

/// As a file holds it: sealed() CBOR.
[[nodiscard]] std::string encode(const CheckpointFile& checkpoint);
/// A line that names the format, the checksum of what follows, and that.
[[nodiscard]] std::string sealed(std::string_view cbor);
/// @throws std::runtime_error with what is wrong: no checkpoint, of another format, damaged, incomplete
[[nodiscard]] CheckpointFile decode(std::string_view bytes);

/// Writes a checkpoint aside, waits until the disk has it, and renames; the one of before becomes `path`.previous.
/// @throws std::runtime_error with path and reason
void write_checkpoint(const std::filesystem::path& path, const CheckpointFile& checkpoint);
/// @throws std::runtime_error with path and reason
[[nodiscard]] CheckpointFile read_checkpoint(const std::filesystem::path& path);

} // namespace osculate::output

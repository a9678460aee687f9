#pragma once
/// Checkpoints on disk: all data to continue a run, and the state of its output files at that time.

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
    std::string scene;        ///< resolved, as in scene.yaml
    std::uint64_t meshes = 0; ///< fingerprint() of the meshes, whose files may have changed since
    time::Checkpoint run;
    std::vector<SeriesEntry> frames{};                            ///< written
    std::vector<std::pair<std::string, std::uintmax_t>> tables{}; ///< path in the run's folder, bytes written
    Summary::Steps steps;
    long iterations = 0;
    double total_seconds = 0, cpu_seconds = 0;
    std::vector<double> seconds{}; ///< by Part
    std::vector<double> checks{};  ///< results of the checks so far
};

/// Checksum of the nodes and elements of all bodies, after placement.
[[nodiscard]] std::uint64_t fingerprint(const model::Model& model);

/// The content of a file: sealed() CBOR.
[[nodiscard]] std::string encode(const CheckpointFile& checkpoint);
/// A line with the format and the checksum of `cbor`, followed by `cbor`.
[[nodiscard]] std::string sealed(std::string_view cbor);
/// @throws std::runtime_error with the fault: no checkpoint, another format, damaged, incomplete
[[nodiscard]] CheckpointFile decode(std::string_view bytes);

/// Writes a checkpoint to a temporary file, waits until it is on the disk, and renames it; the previous one becomes
/// `path`.previous.
/// @throws std::runtime_error with path and reason
void write_checkpoint(const std::filesystem::path& path, const CheckpointFile& checkpoint);
/// @throws std::runtime_error with path and reason
[[nodiscard]] CheckpointFile read_checkpoint(const std::filesystem::path& path);

} // namespace osculate::output

#pragma once
/// The frames of a run: one VTK file per body and contact surface, and the series that lists them.

#include "osculate/output/fields.hpp"
#include "osculate/output/series.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace osculate::output {

/// Fields by name; a part without fields has no files.
struct FrameFields {
    std::vector<std::string> body, slave, master;
};

/// Files frames/BODY_00000.vtu, frames/PAIR.slave_00000.vtp and frames/PAIR.master_00000.vtp. Points are reference
/// positions; surfaces bring the displacement along, so that they warp as bodies do.
class Frames {
public:
    /// Removes the frames of an earlier run in `directory`, and no other file.
    /// @throws std::runtime_error with path and reason, as write() does
    Frames(std::filesystem::path directory, const FrameFields& fields, const model::Model& model);

    /// Removes the frames in `directory` and their series, and the folders where nothing else is in them.
    /// @throws std::runtime_error with path and reason
    static void remove(const std::filesystem::path& directory);

    /// Writes frame number `number` and lists it in series.pvd.
    void write(const Snapshot& snapshot, long number);

private:
    struct Surface {
        std::string name;
        Index pair = -1;
        std::vector<Index> nodes;        ///< global node of every point
        std::vector<Vec3> points;        ///< reference positions, m
        std::vector<mesh::Facet> facets; ///< nodes index points
        std::vector<const Field*> fields;
    };
    void add_surface(const model::Model& model, std::string name, Index pair, const std::vector<Index>& nodes,
                     const std::vector<mesh::Facet>& facets, std::vector<const Field*> fields);
    [[nodiscard]] std::string file(const std::string& part, long number, const char* extension);

    std::filesystem::path directory_;
    std::vector<const Field*> body_fields_;
    std::vector<Surface> surfaces_;
    Series series_;
};

} // namespace osculate::output

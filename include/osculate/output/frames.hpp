#pragma once
/// The frames of a run: one VTK file per body and contact surface, or per piece of a body, and the series that lists them.

#include "osculate/output/fields.hpp"
#include "osculate/output/series.hpp"

#include <filesystem>
#include <future>
#include <optional>
#include <string>
#include <vector>

namespace osculate::output {

/// Fields by name; a part without fields has no files.
struct FrameFields {
    std::vector<std::string> body, slave, master;
};

/// Writes the files frames/BODY_00000.vtu, frames/PAIR.slave_00000.vtp and frames/PAIR.master_00000.vtp. Points are
/// reference positions; surfaces include the displacement, so that viewers can warp them like bodies.
/// Where processes share a run, each writes its piece of a body, frames/pieces/BODY_00000_RANK.vtu, and the first one a list of
/// them, frames/BODY_00000.pvtu, and all else; all of them make the object and write each frame together.
class Frames {
public:
    /// Starts a new series.pvd.
    /// @param beside  write files on a separate thread, while the next step continues; not with several processes
    /// @param kept    frames to keep, see written()
    /// @param share   among processes; null: there is one
    /// @throws std::runtime_error with path and reason, like write() and finish()
    Frames(std::filesystem::path directory, const FrameFields& fields, const model::Model& model, bool beside = false,
           std::vector<SeriesEntry> kept = {}, const Share* share = nullptr);

    /// Files of frame `number`, those of all processes, relative to the directory.
    [[nodiscard]] std::vector<std::string> files(long number) const;

    /// Whether a file is a piece of a listed one; both relative to the directory.
    [[nodiscard]] static bool is_piece_of(const std::string& file, const std::string& listed);

    /// Writes frame number `number` and lists it in series.pvd, at the latest when the next frame is written or
    /// finish() is called.
    void write(const Snapshot& snapshot, long number);
    /// Waits until every frame is written.
    void finish();
    /// Waits until every frame so far is written, and returns them; of the first process.
    [[nodiscard]] const std::vector<SeriesEntry>& written();

private:
    struct Surface {
        std::string name;
        Index pair = -1;
        std::vector<Index> nodes;        ///< global node of every point
        std::vector<Vec3> points;        ///< reference positions, m
        std::vector<mesh::Facet> facets; ///< nodes index points
        std::vector<const OutputField*> fields;
    };
    struct File {
        const Surface* surface = nullptr; ///< null: of a body
        Index number = -1;                ///< of the body
        const model::Body* body = nullptr;
        const Piece* piece = nullptr; ///< of the body; null: all of it
        std::string part, name;
        std::vector<Array> arrays;
    };
    /// Without values.
    [[nodiscard]] std::vector<File> files_of(const model::Model& model, long number) const;
    void take_values(File& file, const Snapshot& snapshot) const;
    void write_file(const File& file, const Vec3& origin, double time) const;
    void list(const std::vector<File>& files, long number, double time);
    [[nodiscard]] bool first() const { return share_ == nullptr || share_->ranks().rank() == 0; }
    void add_surface(const model::Model& model, std::string name, Index pair, const std::vector<Index>& nodes,
                     const std::vector<mesh::Facet>& facets, std::vector<const OutputField*> fields);
    [[nodiscard]] static std::string file(const std::string& part, long number, const char* extension);
    [[nodiscard]] static std::string piece_file(const std::string& part, long number, int rank);

    std::filesystem::path directory_;
    std::vector<const OutputField*> body_fields_;
    std::vector<std::string> bodies_; ///< those with files
    std::vector<Surface> surfaces_;
    const Share* share_;           ///< null: one process
    std::vector<Piece> pieces_;    ///< (bodies) of this process; empty: whole bodies
    std::optional<Series> series_; ///< of the first process
    bool beside_;
    std::future<void> writing_; ///< last member: its thread uses the others, and its destructor waits
};

} // namespace osculate::output

#pragma once
/// The three kinds of error that end a run, one type each; the command line maps them to exit codes 2, 3 and 4.

#include <stdexcept>
#include <string>
#include <vector>

namespace osculate {

/// One fault of a scene, with everything that a user needs to correct it. The message leaves out empty members.
struct Fault {
    std::string file;
    int line = 0; ///< 1-based; 0 where the fault has no place in the file
    int column = 0;
    std::string key;      ///< dotted key path, "contact.sliding.friction"
    std::string expected; ///< what would be correct
    std::string found;    ///< what the scene contains
    std::string nearest;  ///< the most similar known key or name, if there is one

    [[nodiscard]] std::string message() const;
};

/// A scene that cannot be run. Contains every fault found, not only the first.                            [exit code 2]
class SceneError : public std::runtime_error {
public:
    explicit SceneError(std::vector<Fault> faults);
    [[nodiscard]] const std::vector<Fault>& faults() const noexcept { return faults_; }

private:
    std::vector<Fault> faults_;
};

/// A run that failed for a known physical or numerical reason; frames written so far are kept.            [exit code 3]
class RunFailure : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// A broken invariant: a defect of Osculate itself.                                                     [exit code 4]
class InternalError : public std::logic_error {
public:
    using std::logic_error::logic_error;
};

/// Throws InternalError(what) when `condition` is false. For invariants, never for user input.
inline void require(bool condition, const char* what) {
    if (!condition) throw InternalError(what);
}

} // namespace osculate

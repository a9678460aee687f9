#pragma once
/// The three ways a run can end badly, one type each; the command line maps them to exit codes 2, 3 and 4.

#include <stdexcept>
#include <string>
#include <vector>

namespace osculate {

/// One fault of a scene, with everything a reader needs to mend it. Empty members are left out of the message.
struct Fault {
    std::string file;
    int line = 0; ///< 1-based; 0 where the fault has no place in the file
    int column = 0;
    std::string key;      ///< dotted key path, "contact.sliding.friction"
    std::string expected; ///< what would have been right
    std::string found;    ///< what stood there
    std::string nearest;  ///< the nearest known key or name, when there is one

    [[nodiscard]] std::string message() const;
};

/// A scene that cannot be run. Carries every fault found, never only the first.                         [exit code 2]
class SceneError : public std::runtime_error {
public:
    explicit SceneError(std::vector<Fault> faults);
    [[nodiscard]] const std::vector<Fault>& faults() const noexcept { return faults_; }

private:
    std::vector<Fault> faults_;
};

/// A run that gave up for a named physical or numerical cause; frames written so far are kept.          [exit code 3]
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

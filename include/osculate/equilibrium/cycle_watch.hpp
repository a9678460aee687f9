#pragma once
/// Detects when a nonlinear iteration with contact makes no more progress.

#include "osculate/equilibrium/contact_term.hpp"

#include <limits>
#include <map>
#include <utility>
#include <vector>

namespace osculate::equilibrium {

class CycleWatch {
public:
    /// Whether half of the patience will do, and the first return to statuses that were left counts.
    void set_impatient(bool impatient) { impatient_ = impatient; }
    /// Opens an attempt.
    void begin();
    /// Opens a solve.
    void restart();
    /// Records an iterate: its statuses and the norm of its residual.
    void note(const Statuses& statuses, double residual);
    /// Whether the iteration cycles, or has made no progress for several iterates.
    [[nodiscard]] bool goes_round() const { return round_; }
    /// Number of consecutive iterates that have not halved the residual.
    [[nodiscard]] int slow() const { return slow_; }
    /// The last few different sets of statuses since begin(), the latest last, for diagnosis of a failure.
    [[nodiscard]] const std::vector<Statuses>& recent() const { return recent_; }

private:
    [[nodiscard]] bool comes_back(const Statuses& statuses, double residual);

    std::vector<Statuses> recent_;
    std::map<std::size_t, std::pair<int, double>> visits_; ///< contact configuration -> visits, least residual
    std::size_t last_configuration_ = 0;
    double best_ = std::numeric_limits<double>::max(); ///< least residual of the solve
    int idle_ = 0, slow_ = 0; ///< consecutive iterates without progress; and that have not halved the residual
    bool round_ = false, impatient_ = false;
};

} // namespace osculate::equilibrium

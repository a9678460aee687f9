#include "app/run/process_summary.hpp"

#include "osculate/output/piece.hpp"

#include <fstream>
#include <sstream>
#include <string>
#include <sys/resource.h>

namespace osculate::app {

namespace {

/// Bytes of the process that the system counts as files in memory, as pages from Replicas are, and MPI's own; 0 where it does not say.
double shared_bytes() {
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);)
        if (line.starts_with("RssShmem:")) {
            double kilobytes = 0;
            std::istringstream(line.substr(line.find(':') + 1)) >> kilobytes;
            return 1024 * kilobytes;
        }
    return 0;
}

} // namespace

long peak_memory_bytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return 1024 * usage.ru_maxrss; // Linux counts in kB
}

std::vector<output::Summary::Process> processes_of(const model::Model& model) {
    std::vector<output::Summary::Process> processes;
    if (!model.share) return processes;
    for (const long elements : output::elements_of_processes(model, *model.share)) {
        const auto rank = static_cast<int>(processes.size());
        processes.push_back({static_cast<long>(model.share->nodes_of(rank).size()), elements});
    }
    return processes;
}

void update_processes(std::vector<output::Summary::Process>& processes, const equilibrium::Equilibrium& equilibrium,
                      const model::Model& model) {
    if (processes.empty()) return;
    constexpr int measured = 2;
    const double own[measured] = {static_cast<double>(peak_memory_bytes()), shared_bytes()};
    std::vector<double> all(measured * processes.size());
    model.share->ranks().gather(own, std::vector<int>(processes.size(), measured), all.data());
    for (std::size_t rank = 0; rank < processes.size(); ++rank) {
        output::Summary::Process& process = processes[rank];
        process.slave_nodes = 0;
        for (const model::ContactEvaluation& pair : equilibrium.contact())
            if (pair.share() != nullptr) process.slave_nodes += pair.share()->size(static_cast<int>(rank));
        process.peak_memory_bytes = static_cast<long>(all[measured * rank]);
        process.shared_memory_bytes = static_cast<long>(all[measured * rank + 1]);
    }
}

} // namespace osculate::app

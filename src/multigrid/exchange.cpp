#include "multigrid/exchange.hpp"

#include <algorithm>

namespace osculate::solve {

std::vector<double> sum_over_ranks(const std::vector<double>& own) {
    int ranks = 1;
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    std::vector<double> all(own.size() * static_cast<std::size_t>(ranks)), sum(own.size(), 0.0);
    meet();
    MPI_Allgather(own.data(), static_cast<int>(own.size()), MPI_DOUBLE, all.data(), static_cast<int>(own.size()),
                  MPI_DOUBLE, MPI_COMM_WORLD);
    for (std::size_t k = 0; k < all.size(); ++k) sum[k % own.size()] += all[k];
    return sum;
}

double largest_over_ranks(double own) {
    double all = own;
    meet();
    MPI_Allreduce(&own, &all, 1, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
    return all;
}

Exchange::Exchange(const std::vector<Index>& own, const std::vector<Index>& ghosts, const std::vector<int>& owner) {
    int ranks = 1;
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    ranks_ = static_cast<std::size_t>(ranks);
    std::vector<std::vector<Index>> wanted(ranks_);
    for (std::size_t g = 0; g < ghosts.size(); ++g) wanted[static_cast<std::size_t>(owner[g])].push_back(ghosts[g]);
    first_.assign(1, static_cast<Index>(own.size()));
    for (const auto& list : wanted) first_.push_back(first_.back() + static_cast<Index>(list.size()));
    send_ = send_to_each(wanted);
    for (auto& list : send_)
        for (Index& number : list) number = static_cast<Index>(std::ranges::lower_bound(own, number) - own.begin());
}

void send_and_receive(const std::vector<std::vector<double>>& out, std::vector<std::vector<double>>& in) {
    constexpr int tag = 26;
    std::vector<MPI_Request> open;
    for (std::size_t r = 0; r < in.size(); ++r)
        if (!in[r].empty())
            MPI_Irecv(in[r].data(), static_cast<int>(in[r].size()), MPI_DOUBLE, static_cast<int>(r), tag,
                      MPI_COMM_WORLD, &open.emplace_back());
    for (std::size_t r = 0; r < out.size(); ++r)
        if (!out[r].empty())
            MPI_Isend(out[r].data(), static_cast<int>(out[r].size()), MPI_DOUBLE, static_cast<int>(r), tag,
                      MPI_COMM_WORLD, &open.emplace_back());
    wait(open);
}

void Exchange::fill(double* x, int width) const {
    if (alone()) return;
    const auto w = static_cast<std::size_t>(width);
    std::vector<std::vector<double>> out(ranks_), in(ranks_);
    for (std::size_t r = 0; r < ranks_; ++r) {
        for (const Index place : send_[r])
            out[r].insert(out[r].end(), x + w * static_cast<std::size_t>(place),
                          x + w * static_cast<std::size_t>(place + 1));
        in[r].resize(w * static_cast<std::size_t>(first_[r + 1] - first_[r]));
    }
    send_and_receive(out, in);
    for (std::size_t r = 0; r < ranks_; ++r) std::ranges::copy(in[r], x + w * static_cast<std::size_t>(first_[r]));
}

void Exchange::add(double* x, int width) const {
    if (alone()) return;
    const auto w = static_cast<std::size_t>(width);
    std::vector<std::vector<double>> out(ranks_), in(ranks_);
    for (std::size_t r = 0; r < ranks_; ++r) {
        out[r].assign(x + w * static_cast<std::size_t>(first_[r]), x + w * static_cast<std::size_t>(first_[r + 1]));
        in[r].resize(w * send_[r].size());
    }
    send_and_receive(out, in);
    for (std::size_t r = 0; r < ranks_; ++r)
        for (std::size_t k = 0; k < send_[r].size(); ++k)
            for (std::size_t c = 0; c < w; ++c) x[w * static_cast<std::size_t>(send_[r][k]) + c] += in[r][w * k + c];
}

} // namespace osculate::solve

#include "osculate/linear/unknown_slices.hpp"

#include "support/thread_ranks.hpp"

#include <algorithm>
#include <gtest/gtest.h>
#include <numeric>

namespace osculate::linear::OSCULATE_THIS_FILE {
namespace {

/// Six nodes of three processes; node 1 is held along y, node 2 fully. Nodes 1, 4 and 2 are slaves, 4 in two pairs.
const std::vector<int> owner{0, 1, 2, 2, 1, 0};
const std::vector<Index> slaves{1, 4, 4, 2};
constexpr Index hub = 5;

Constraints some_constraints() {
    const auto hold = [](Index node, const Vec3& direction) {
        NodeConstraint c;
        c.node = node;
        c.direction = direction;
        return c;
    };
    return {6, {hold(1, Vec3::UnitY()), hold(2, Vec3::UnitX()), hold(2, Vec3::UnitY()), hold(2, Vec3::UnitZ())}};
}

/// Calls body(rank, slices, constraints, unknowns) on three processes that read the nodes 1, 3 and 4.
void on_slices(const auto& body) {
    support::on_ranks(3, [&](const std::shared_ptr<Ranks>& ranks) {
        const Share share(ranks, owner);
        const Constraints constraints = some_constraints();
        const Unknowns unknowns(constraints, slaves);
        UnknownSlices slices(share, constraints, unknowns, {4, 1, 3, 4}, {hub});
        body(ranks->rank(), slices, constraints, unknowns);
    });
}

TEST(UnknownSlices, HaveEveryUnknownAndEveryRowOnce) {
    std::vector<std::vector<Index>> own(3);
    on_slices([&](int rank, const UnknownSlices& slices, const Constraints& constraints, const Unknowns& unknowns) {
        own[static_cast<std::size_t>(rank)] = slices.own();
        std::vector<Index> rows;
        for (Index node = 0; node < 6; ++node)
            for (int k = 0; k < 3 && owner[static_cast<std::size_t>(node)] == rank; ++k)
                if (const Index row = unknowns.equilibrium_row(node, k); row != Constraints::held) rows.push_back(row);
        for (Index j = 0; j < unknowns.couplings(); ++j)
            for (int k = 0; k < 3 && owner[static_cast<std::size_t>(unknowns.slave(j))] == rank; ++k)
                rows.push_back(unknowns.contact_row(j, k));
        EXPECT_TRUE(std::ranges::is_permutation(rows, slices.own()));
        EXPECT_EQ(constraints.equations(), 14);
    });
    std::vector<Index> all;
    for (const auto& list : own) all.insert(all.end(), list.begin(), list.end());
    std::ranges::sort(all);
    std::vector<Index> expected(14 + 12);
    std::iota(expected.begin(), expected.end(), 0);
    EXPECT_EQ(all, expected);
}

TEST(UnknownSlices, AreFilledInWhereProductsAndPreconditionersRead) {
    on_slices([](int rank, UnknownSlices& slices, const Constraints& constraints, const Unknowns& unknowns) {
        Vector whole(unknowns.size());
        for (Index i = 0; i < whole.size(); ++i) whole(i) = 100 + i;
        Vector x = Vector::Constant(whole.size(), -1);
        for (const Index i : slices.own()) x(i) = whole(i);
        Vector r = x;
        slices.fill_unknowns(x.data());
        for (const Index node : {1, 3, 4})
            for (int k = 0; k < 3; ++k)
                if (const Index e = constraints.equation(node, k); e != Constraints::held) {
                    EXPECT_EQ(x(e), whole(e)) << rank;
                }
        EXPECT_EQ(x.tail(12), whole.tail(12));
        slices.fill_rows(r.data());
        for (Index j = 0; j < unknowns.couplings(); ++j)
            for (int k = 0; k < 3; ++k)
                EXPECT_EQ(r(unknowns.contact_row(j, k)), whole(unknowns.contact_row(j, k))) << rank;
        for (int k = 0; k < 3; ++k) EXPECT_EQ(r(constraints.equation(hub, k)), whole(constraints.equation(hub, k)));
        EXPECT_EQ(x(constraints.equation(0, 0)), rank == 0 ? whole(constraints.equation(0, 0)) : -1); // nobody reads it

        std::vector<double> own;
        for (const Index i : slices.own()) own.push_back(whole(i));
        Vector together(whole.size());
        slices.gather(own, together.data());
        EXPECT_EQ(together, whole);
    });
}

} // namespace
} // namespace osculate::linear::OSCULATE_THIS_FILE

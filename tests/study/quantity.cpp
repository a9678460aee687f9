#include "osculate/study/quantity.hpp"

#include "osculate/study/formulas.hpp"
#include "support/source_tree.hpp"

#include <cmath>
#include <filesystem>
#include <gtest/gtest.h>

namespace osculate::study::OSCULATE_THIS_FILE {
namespace {

constexpr double round_off = 1e-14;

/// Five nodes, not in their order along X.
const QuantityRows nodes{{{"X", "p"}, {{2, 0, 1, 4, 3}, {30, 10, 20, 7, 40}}}, {1, 1, 2, 0, 1}};
const scene::Numbers numbers{{"h", "p0"}, {0.5, 40}};

scene::StudyQuantity of(const char* formula) {
    scene::StudyQuantity q;
    q.source = scene::RowSource::contact;
    q.of = {formula};
    return q;
}

double value(const scene::StudyQuantity& q) {
    return measure(q, nodes, numbers, {}).value;
}

TEST(Quantity, ReducesTheRowsThatAreAskedForInTheirOrder) {
    scene::StudyQuantity q = of("p");
    q.order_by = {"X"};
    const auto reduced = [&](const char* reduce) {
        q.reduce = reduce;
        return value(q);
    };
    EXPECT_EQ(reduced("first"), 10);
    EXPECT_EQ(reduced("last"), 7);
    EXPECT_EQ(reduced("max"), 40);
    q.where = {"X < 4"};
    EXPECT_EQ(reduced("last"), 40);
    EXPECT_EQ(reduced("min"), 10);
    EXPECT_EQ(reduced("sum"), 100);
    EXPECT_EQ(reduced("mean"), 25);
    EXPECT_EQ(reduced("amplitude"), 30);
    EXPECT_NEAR(reduced("ripple"), 30. / 25, round_off);
    EXPECT_NEAR(reduced("rms"), std::sqrt(750), 30 * round_off);
    q.where = {"X > 9"};
    EXPECT_TRUE(std::isnan(reduced("max"))) << "of nothing";
}

TEST(Quantity, RoughnessIsThatOfTheInnerNodes) {
    // inner values 10 20 30 40, of which those in the middle have second differences: of a line none
    scene::StudyQuantity q = of("X == 0 ? 10 : X == 4 ? 99 : 10 * X");
    q.order_by = {"X"};
    q.reduce = "roughness";
    EXPECT_EQ(value(q), 0); // 10 10 20 30 99: inner 10 20 30
    q.of = {"X == 2 ? 26 : 10 * X + 10"};
    // inner 20 26 40: second difference 20 - 52 + 40 = 8 over 26
    EXPECT_NEAR(value(q), 8. / 26, round_off);
}

TEST(Quantity, AggregatesStandInAFormula) {
    scene::StudyQuantity q;
    q.value = {"max(p * (X > 1)) / p0 + count(p > 15) + max(1, 2)"};
    EXPECT_EQ(value(q), 1 + 3 + 2);
    q.where = {"X < 3"};
    EXPECT_EQ(value(q), 30. / 40 + 2 + 2);
}

TEST(Quantity, NormsWeighDifferences) {
    scene::StudyQuantity q = of("p");
    q.exact = {"p - X"};
    q.scale = {"h"};
    const Measured m = measure(q, nodes, numbers, {});
    EXPECT_TRUE(m.is_error);
    EXPECT_NEAR(m.value, std::sqrt((4 + 0 + 2 * 1 + 0 * 16 + 9) / 5.) / 0.5, round_off);
    q.norm = scene::ErrorNorm::mean;
    EXPECT_NEAR(value(q), (2 + 0 + 2 * 1 + 3) / 5. / 0.5, round_off);
    q.norm = scene::ErrorNorm::max;
    EXPECT_NEAR(value(q), 4 / 0.5, round_off);
}

TEST(ShippedStudies, CanBeRead) {
    scene::NamedFunctions functions;
    for (const NamedSolution& f : formulas()) functions.push_back({f.name, f.count, f.value});
    int runs = 0;
    for (const auto& entry : std::filesystem::directory_iterator(support::source_tree() + "/configs/studies")) {
        const std::string path = entry.path().string();
        if (entry.path().extension() != ".yaml" || !scene::is_run_study(path)) continue;
        const scene::Study study = scene::read_study(path, functions);
        EXPECT_FALSE(study.problem.empty()) << path;
        ++runs;
        if (std::ranges::none_of(study.quantities, &scene::StudyQuantity::has_error)) continue; // a matrix of values
        EXPECT_FALSE(study.source.empty()) << path;
        EXPECT_GE(study.refine, 0) << path;
    }
    EXPECT_GT(runs, 0);
}

TEST(Quantity, ErrorsAreRelativeWhereTheyCanBe) {
    scene::StudyQuantity q;
    EXPECT_EQ(error_of(q, 3, -2), 2.5);
    EXPECT_EQ(error_of(q, 3, 0), 3);
    q.relative = false;
    EXPECT_EQ(error_of(q, 3, -2), 5);
}

} // namespace
} // namespace osculate::study::OSCULATE_THIS_FILE

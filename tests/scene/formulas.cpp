#include "osculate/scene/aggregate.hpp"

#include <cmath>
#include <gmock/gmock.h>

namespace osculate::scene::OSCULATE_THIS_FILE {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

double product(const double* a) {
    return a[0] * a[1];
}
const NamedFunctions functions{{"product_of", 2, product}};

TEST(Formula, SeesItsVariablesAndFunctions) {
    const ParsedFormula f =
        parse_formula("product_of(a, 3) + pair.sliding.force_x - 2.5", {"a", "pair.sliding.force_x", "c"}, functions);
    ASSERT_EQ(f.problem, "");
    EXPECT_EQ(f.function(std::vector{2.0, 10.0, 0.0}), 13.5);
    EXPECT_THAT(f.uses, ElementsAre("a", "pair.sliding.force_x"));
}

TEST(Formula, NamesTheNearestOfWhatItDoesNotKnow) {
    EXPECT_EQ(parse_formula("product_fo(1, 2)", {}, functions).nearest, "product_of");
    EXPECT_EQ(parse_formula("pair.sliding.force_z + 1", {"pair.sliding.force_x"}).nearest, "pair.sliding.force_x");
    EXPECT_THAT(parse_formula("product_of(1)", {}, functions).problem, HasSubstr("product_of takes 2 numbers, not 1"));
    EXPECT_NE(parse_formula("", {}).problem, "");
    EXPECT_NE(parse_formula("a = 1", {"a"}).problem, "");
    EXPECT_NE(parse_formula("a, 1", {"a"}).problem, "");
}

TEST(Formula, KnowsWhichNamesAreFree) {
    EXPECT_TRUE(is_variable_name("h_2"));
    for (const char* name : {"", "2h", "a-b", "a.b", "pi", "e", "sqrt"}) EXPECT_FALSE(is_variable_name(name)) << name;
    EXPECT_FALSE(is_variable_name("product_of", functions));
}

const Rows rows{{"p", "A"}, {{1, 2, 3}, {4, 5, 6}}};

double aggregate(const std::string& text) {
    const Aggregate f(text, rows.names, {"h"}, functions);
    EXPECT_EQ(f.problem(), "") << text;
    return f(rows, std::vector{10.0});
}

TEST(Aggregate, ReducesCallsOfOneArgument) {
    EXPECT_EQ(aggregate("max(p)"), 3);
    EXPECT_EQ(aggregate("max( p * (A > 4) ) + min(A) * h"), 43);
    EXPECT_EQ(aggregate("sum(p * A) / sum(A)"), 32. / 15);
    EXPECT_EQ(aggregate("first(p) + last(A) + count(p > 1) + mean(p)"), 1 + 6 + 2 + 2);
    EXPECT_EQ(aggregate("max(h, 3) + product_of(max(p), 2)"), 16) << "two arguments are muparser's";
    EXPECT_EQ(aggregate("max(max(0, p - 1))"), 2);
}

TEST(Reductions, DoNotDependOnTheSignButWhereTheySay) {
    const std::vector<double> values{4, 5, 7, 5, 4}, negative{-4, -5, -7, -5, -4};
    for (const char* reduction : {"amplitude", "ripple", "rms", "roughness", "count"}) {
        EXPECT_GT(reduce(reduction, values), 0) << reduction;
        EXPECT_EQ(reduce(reduction, negative), reduce(reduction, values)) << reduction;
    }
    for (const char* reduction : {"sum", "mean", "first", "last"})
        EXPECT_EQ(reduce(reduction, negative), -reduce(reduction, values)) << reduction;
    EXPECT_EQ(reduce("max", negative), -reduce("min", values));
}

TEST(Aggregate, TellsWhatItCannotDo) {
    const auto problem = [](const std::string& text) {
        return Aggregate(text, rows.names, {"h"}, functions).problem();
    };
    EXPECT_THAT(problem("p / 2"), HasSubstr("a value of every row where one number is due"));
    EXPECT_EQ(problem("max(sum(p))"), "a reduction within max");
    EXPECT_NE(problem("max(q)"), "");
    EXPECT_NE(problem("max(p"), "");
    EXPECT_TRUE(std::isnan(Aggregate("max(p)", {"p"}, {}, {})({{"p"}, {{}}}, {}))) << "of no row";
}

} // namespace
} // namespace osculate::scene::OSCULATE_THIS_FILE

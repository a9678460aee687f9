/// Axes, sampled ones too, as what curves and maps go over.

#include "scene/study_samples.hpp"
#include "small_study.hpp"

#include <cmath>
#include <gmock/gmock.h>

namespace osculate::scene::OSCULATE_THIS_FILE {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const std::string with_stiffness = replaced(
    small_study, "  mesh:\n", "  E: {key: bodies.cap.material.linear_elastic.E, values: [10 MPa, 20MPa]}\n  mesh:\n");

std::string sampled(const std::string& rule = "latin_hypercube", const std::string& from = "10 MPa") {
    return replaced(
        small_study, "  mesh:\n",
        "  sample:\n    sample: " + rule + "\n    runs: 8\n    variables:\n" +
            "      mu: {key: contact.joint.friction, from: 0.1, to: 0.5}\n"
            "      E: {key: [bodies.cap.material.linear_elastic.E, bodies.base.material.linear_elastic.E], from: " +
            from + ", to: 40 MPa, spacing: logarithmic}\n  mesh:\n");
}

std::vector<std::string> names(const std::vector<StudyCurves>& curves) {
    std::vector<std::string> list;
    for (const StudyCurves& c : curves) list.push_back(c.name);
    return list;
}

TEST(StudyAxes, ValuesOfOneUnitAreNumbersInIt) {
    const Study study = read(with_stiffness);
    const StudyAxis& axis = study.axes[1];
    EXPECT_EQ(axis.unit, "MPa");
    EXPECT_EQ(axis.values[0].number, 10);
    EXPECT_EQ(axis.values[1].number, 20);
    EXPECT_EQ(study.axes[0].values[0].number, std::nullopt) << "facets";
    EXPECT_EQ(read(replaced(with_stiffness, "20MPa", "2e7 Pa")).axes[1].values[0].number, std::nullopt)
        << "two units have no common scale";
}

TEST(StudyAxes, QuantitiesWithoutReferenceGetCurvesOverNumbersByThemselves) {
    EXPECT_THAT(names(read(with_stiffness).curves), ElementsAre("force_over_E"));
    EXPECT_THAT(names(read(small_study).curves), IsEmpty()) << "names and the refined axis";
    EXPECT_THAT(names(read(replaced(with_stiffness, "reduce: max", "plot: false")).curves), IsEmpty());
    EXPECT_THAT(names(read(with_stiffness + "plots: {curves: {}}\n").curves), IsEmpty()) << "asked for none";
}

TEST(StudyAxes, CurvesAndContoursGoOverAxesAndParameters) {
    const Study study =
        read(with_stiffness + "plots:\n  curves:\n    a: {quantity: peak, over: h, logarithmic: [x, y]}\n"
                              "  contours:\n    m: {quantity: force, over: [E, h], logarithmic: [y]}\n");
    ASSERT_EQ(study.curves.size(), 1U);
    EXPECT_EQ(study.curves[0].over.axis, 2U);
    EXPECT_TRUE(study.curves[0].logarithmic && study.curves[0].over.logarithmic);
    EXPECT_EQ(study.place_of(study.curves[0].over, 1), 0.5);
    ASSERT_EQ(study.contours.size(), 1U);
    EXPECT_EQ(study.contours[0].over[0].unit, "MPa");
    EXPECT_TRUE(!study.contours[0].over[0].logarithmic && study.contours[0].over[1].logarithmic);
}

TEST(StudyAxes, FaultsOfPlotsNameWhatThereIs) {
    const auto plots = [](const std::string& text) { return faults(with_stiffness + "plots: " + text + "\n"); };
    EXPECT_THAT(plots("{curves: {a: {quantity: forse, over: E}}}"),
                ElementsAre(AllOf(HasSubstr("plots.curves.a.quantity: expected one of the quantities peak, force"),
                                  HasSubstr("did you mean 'force'?"))));
    EXPECT_THAT(plots("{curves: {a: {quantity: force, over: mehs}}}"),
                ElementsAre(AllOf(HasSubstr("an axis or a parameter of one: surface, E, mesh, h"),
                                  HasSubstr("did you mean 'mesh'?"))));
    EXPECT_THAT(plots("{curves: {a: {quantity: force, over: surface, logarithmic: [x]}}}"),
                ElementsAre(HasSubstr("an axis of positive numbers")));
    EXPECT_THAT(plots("{contours: {a: {quantity: force, over: [mesh, h]}}}"), ElementsAre(HasSubstr("'mesh' twice")));
    EXPECT_THAT(plots("{contours: {a: {quantity: force, over: E}}}"), ElementsAre(HasSubstr("a list of two axes")));
}

TEST(StudySamples, SetEveryKeyOfAVariableInItsUnit) {
    const Study study = read(sampled());
    const StudyAxis& axis = study.axes[1];
    ASSERT_EQ(axis.values.size(), 8U);
    EXPECT_EQ(axis.values[0].name, "1");
    for (std::size_t v = 0; v < 8; ++v) {
        const AxisValue& value = axis.values[v];
        const double mu = *find(value.parameters, "mu"), E = *find(value.parameters, "E");
        EXPECT_TRUE(mu >= 0.1 && mu < 0.5 && E >= 10 && E < 40) << mu << " " << E;
        ASSERT_EQ(value.settings.size(), 3U);
        const Scene scene = read_scene(study.scene, study.overrides_of({0, v, 0}, {}));
        EXPECT_EQ(scene.contact[0].second.friction, mu);
        for (const auto& [name, body] : scene.bodies)
            EXPECT_NEAR(std::get<LinearElastic>(body.material).E, E * 1e6, 1e-9 * E * 1e6) << "round-off of the unit";
    }
    EXPECT_THAT(names(study.curves), ElementsAre("force_over_mu", "force_over_E"));
    EXPECT_TRUE(study.curves[1].over.sampled && study.curves[1].over.logarithmic);
}

/// McKay, Beckman, Conover (1979): one value in each of n equal slices. And Sobol's first 2^k points likewise.
TEST(StudySamples, FillEverySliceOfEveryVariableOnce) {
    for (const SampleRule rule : {SampleRule::latin_hypercube, SampleRule::sobol}) {
        const auto points = unit_samples(rule, 64, 5, 3);
        for (std::size_t v = 0; v < 5; ++v) {
            std::vector<int> hits(64, 0);
            for (const auto& p : points) ++hits.at(static_cast<std::size_t>(std::floor(64 * p[v])));
            EXPECT_THAT(hits, testing::Each(1)) << "rule " << static_cast<int>(rule) << " variable " << v;
        }
    }
}

/// Any two of Sobol's variables fill a grid of 8 by 8; random points leave a third of its cells empty.
TEST(StudySamples, OfSobolFillPlanesEvenly) {
    const auto points = unit_samples(SampleRule::sobol, 64, 2, 7);
    std::vector<int> hits(64, 0);
    for (const auto& p : points) ++hits.at(static_cast<std::size_t>(8 * std::floor(8 * p[0]) + std::floor(8 * p[1])));
    EXPECT_THAT(hits, testing::Each(1));
}

TEST(StudySamples, AreTheSameForTheSameSeedOnly) {
    for (const SampleRule rule : {SampleRule::latin_hypercube, SampleRule::sobol}) {
        EXPECT_EQ(unit_samples(rule, 16, 3, 1), unit_samples(rule, 16, 3, 1));
        EXPECT_NE(unit_samples(rule, 16, 3, 1), unit_samples(rule, 16, 3, 2));
    }
}

TEST(StudySamples, FaultsSayWhatARangeMayBe) {
    EXPECT_THAT(faults(sampled("sobel")), Contains(HasSubstr("did you mean 'sobol'?")));
    EXPECT_THAT(faults(sampled("sobol", "10")), Contains(HasSubstr("variables.E.to: expected the unit of from, none")));
    EXPECT_THAT(faults(sampled("sobol", "50 MPa")),
                Contains(HasSubstr("variables.E.to: expected more than from, 50 MPa")));
    EXPECT_THAT(faults(sampled("sobol", "-1 MPa")), Contains(HasSubstr("more than 0, as the spacing is logarithmic")));
    EXPECT_THAT(faults(sampled("sobol", "some")), Contains(HasSubstr("a number, with the unit that the key takes")));
    EXPECT_THAT(faults(replaced(sampled(), "friction, from", "fricton, from")),
                Contains(AllOf(HasSubstr("study.yaml:"), HasSubstr("fricton"), HasSubstr("did you mean"))))
        << "of the scene, at its place in the study";
    EXPECT_THAT(faults(replaced(sampled(), "runs: 8", "runs: 1")), Contains(HasSubstr("runs")));
}

/// 64 million runs took 42 s and 5.7 GB before they were refused.
TEST(StudyAxes, AbsurdNumbersOfRunsAreRefusedBeforeTheyAreListed) {
    std::string many = "[1";
    for (int i = 2; i <= 400; ++i) many += ", " + std::to_string(i);
    many += "]";
    const std::string text = replaced(small_study, "  mesh:\n",
                                      "  a: {key: stages.load.steps, values: " + many +
                                          "}\n  b: {key: stages.load.steps, values: " + many + "}\n  mesh:\n");
    EXPECT_THAT(faults(text),
                ElementsAre(AllOf(HasSubstr("at most 100000 combinations"), HasSubstr("2 x 400 x 400 x 2 of them"))));
}

} // namespace
} // namespace osculate::scene::OSCULATE_THIS_FILE

#include "deck/no_counterpart.hpp"

#include <map>

namespace osculate::deck {
namespace {

constexpr NoCounterpart output{"what is written is chosen under output", false},
    settings{"the solver has settings of its own", false}, nonlinear{"only linear equations have a counterpart", true},
    elastic_only{"all bodies are elastic", true}, heat{"there are no temperatures", false};

/// By keywords without blanks.
const std::map<std::string, NoCounterpart> reasons{
    {"NODEPRINT", output},
    {"ELPRINT", output},
    {"NODEFILE", output},
    {"ELFILE", output},
    {"ELEMENTFILE", output},
    {"NODEOUTPUT", output},
    {"ELEMENTOUTPUT", output},
    {"CONTACTFILE", output},
    {"CONTACTOUTPUT", output},
    {"CONTACTPRINT", output},
    {"ENERGYFILE", output},
    {"ENERGYOUTPUT", output},
    {"ENERGYPRINT", output},
    {"SECTIONPRINT", output},
    {"OUTPUT", output},
    {"PRINT", output},
    {"MONITOR", output},
    {"FILEFORMAT", output},
    {"CONTROLS", settings},
    {"CONTACTCONTROLS", settings},
    {"SOLVERCONTROLS", settings},
    {"SECTIONCONTROLS", settings},
    {"HOURGLASSSTIFFNESS", settings},
    {"MPC", nonlinear},
    {"TIE", {"only surfaces that move as one, or the ends of a sector, have a counterpart", true}},
    {"PLASTIC", elastic_only},
    {"CYCLICHARDENING", elastic_only},
    {"CREEP", elastic_only},
    {"CONDUCTIVITY", heat},
    {"SPECIFICHEAT", heat},
    {"GAPCONDUCTANCE", heat},
    {"PHYSICALCONSTANTS", heat},
    {"TEMPERATURE", {"there are no temperatures", true}},
    {"TIMEPOINTS", {"frames are chosen under output", false}},
    {"RESTART", {"runs begin at the beginning", false}},
};

} // namespace

NoCounterpart no_counterpart(const std::string& word) {
    const auto known = reasons.find(word);
    return known != reasons.end() ? known->second : NoCounterpart{"it has no counterpart", true};
}

} // namespace osculate::deck

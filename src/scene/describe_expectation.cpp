#include "scene/describe_parts.hpp"

namespace osculate::scene {

void describe(Visitor& v, Expectation& expect) {
    static const std::string bound = "allowed_interpenetration of the stage, " + number_text(Expectation::exact) +
                                     " in statics where it is not given";
    static const Words outcomes{"completed", "gives_up"};
    word(v, {.name = "outcome", .meaning = "How the run ends."}, outcomes, expect.outcome);
    v.text({.name = "cause", .meaning = "Words that the message contains when the run gives up."}, expect.cause);
    v.number({.name = "force_balance",
              .meaning = "Largest imbalance of the forces on a body, as a fraction of the forces that act.",
              .range = range::positive},
             expect.force_balance);
    v.number({.name = "energy_growth",
              .meaning = "Largest rise of kinetic plus strain energy beyond external work in dynamics, as a fraction "
                         "of the largest energy.",
              .range = range::positive},
             expect.energy_growth);
    v.optional_number({.name = "penetration",
                       .meaning = "Deepest interpenetration of any slave node in an accepted state, in facet sizes; if "
                                  "given, also of any body inside another that the audit finds.",
                       .range = range::positive,
                       .default_text = bound.c_str()},
                      expect.penetration);
}

} // namespace osculate::scene

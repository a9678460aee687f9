#pragma once
/// A load over the steps of a deck, as courses of a scene's stages.

#include "deck/model.hpp"

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace osculate::deck {

/// One number of a load (a pressure, a component of a force) from step to step. What loads of several origins give adds
/// up; a step's loads of one origin add to one another and take the place of those that earlier steps gave.
class LoadHistory {
public:
    /// A load of the step that is under way. @param amplitude  factors over the step's time; nullptr for none
    void add(const std::string& origin, double value, const Amplitude* amplitude);
    /// The step takes away what an origin gave before it.
    void remove(std::string_view origin);
    void remove_all();

    /// Ends the step. Returns its course as a scene has it: a number, which is reached linearly or at once as the stage says,
    /// or a table; empty where the step gives no load.
    /// @param ramped  loads without an amplitude change linearly over the step, in place of at once
    std::string end_step(double duration, bool ramped);

    /// Whether an origin gives a load in the step that is under way.
    [[nodiscard]] bool gives(std::string_view origin) const;
    /// What an origin gave at the end of the last step that has ended.
    [[nodiscard]] double standing(std::string_view origin) const;
    [[nodiscard]] double standing() const; ///< of all origins

private:
    struct Term {
        double value;
        const Amplitude* amplitude;
    };
    struct Origin {
        double start = 0;        ///< value when the step begins
        std::vector<Term> given; ///< in this step
        bool changed = false;    ///< in this step
    };
    static double value_at(const Origin& origin, double t, double duration, bool ramped);

    std::map<std::string, Origin, std::less<>> origins_;
};

/// Factor at a time since the step's start; before its first row and after its last it stays.
[[nodiscard]] double factor_at(const Amplitude& amplitude, double t);

} // namespace osculate::deck

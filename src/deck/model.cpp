#include "deck/model.hpp"

#include "deck/contact_cards.hpp"
#include "deck/equations.hpp"
#include "deck/general_contact.hpp"
#include "deck/load_cards.hpp"
#include "deck/material_cards.hpp"
#include "deck/no_counterpart.hpp"

#include <set>

namespace osculate::deck {
namespace {

/// What these say is in the mesh, or has nothing to say.
const std::set<std::string> read_elsewhere{"NODE",    "ELEMENT",  "NSET",      "ELSET",    "SURFACE",
                                           "HEADING", "PREPRINT", "RIGIDBODY", "COUPLING", "KINEMATICCOUPLING"};

class Reader : CardReader {
public:
    Reader(const mesh::Deck& deck, DeckModel& model)
        : CardReader(deck, model), materials_(deck, model), contact_(deck, model), general_(deck, model),
          equations_(deck, model), loads_(deck, model) {}

    void read() {
        for (const DeckCard& card : deck_.cards) take(card);
        if (step_ != nullptr && !step_taken_) drop_step("it has no analysis");
    }

private:
    void take(const DeckCard& card) {
        const std::string word = without_blanks(card.keyword);
        if (passing_over_) {
            passing_over_ = word != "ENDSTEP";
            return;
        }
        if (word == "STEP") return begin_step(card);
        if (word == "ENDSTEP") {
            if (step_ != nullptr && !step_taken_) drop_step("it has no analysis");
            step_ = nullptr;
            contact_.end_step();
            return;
        }
        const bool of_coupling = (word == "KINEMATIC" || word == "DISTRIBUTING") && before_ == "COUPLING";
        before_ = word;
        if (of_coupling) return;
        if (read_elsewhere.contains(word)) {
            check_element_type(card);
            return;
        }
        if (materials_.take(card, word, step_ != nullptr) || contact_.take(card, word, step_) ||
            general_.take(card, word, step_) || equations_.take(card, word, step_ != nullptr) ||
            loads_.take(card, word, step_))
            return;
        if (word == "SOLIDSECTION") return section(card);
        if (word == "TRANSFORM" && step_ == nullptr) return transform(card);
        if ((word == "STATIC" || word == "DYNAMIC") && step_ != nullptr) return analysis(card);
        if (step_ != nullptr && !step_taken_ && is_analysis(word))
            return drop_step("*" + card.keyword + " has no counterpart: statics and implicit dynamics do");
        const NoCounterpart reason = no_counterpart(word);
        model_.left_out.push_back({deck_.place(card), "*" + card.keyword, reason.why, reason.lost});
    }

    static bool is_analysis(const std::string& word) {
        static const std::set<std::string> others{"FREQUENCY",
                                                  "BUCKLE",
                                                  "MODALDYNAMIC",
                                                  "STEADYSTATEDYNAMICS",
                                                  "HEATTRANSFER",
                                                  "VISCO",
                                                  "NOANALYSIS",
                                                  "COMPLEXFREQUENCY",
                                                  "ELECTROMAGNETICS",
                                                  "GREEN",
                                                  "CFD",
                                                  "UNCOUPLEDTEMPERATURE-DISPLACEMENT",
                                                  "SENSITIVITY",
                                                  "COUPLEDTEMPERATURE-DISPLACEMENT"};
        return others.contains(word);
    }

    void check_element_type(const DeckCard& card) {
        const std::string type = capitals_of(card, "TYPE");
        if (card.keyword == "ELEMENT" && type.starts_with("CAX") && model_.mesh.bored > 0)
            model_.note(deck_.place(card), "*ELEMENT, TYPE=" + type,
                        "what is on the axis stands beside it, by a thousandth of the mesh's size");
        if (card.keyword == "ELEMENT" && (type == "C3D8R" || type == "CPE4R" || type == "CPS4R" || type == "CAX4R"))
            model_.note(
                deck_.place(card), "*ELEMENT, TYPE=" + type,
                "hexahedra are integrated in full; incompatible_modes is used instead, which does not lock either");
    }

    void section(const DeckCard& card) {
        DeckSection s;
        s.place = deck_.place(card);
        const std::string* name = card.parameter("ELSET");
        s.elements = name == nullptr ? "" : *name;
        s.material = capitals_of(card, "MATERIAL");
        s.cells = cells_of(s.elements);
        if (const auto at = model_.mesh.element_set_names.find(in_capitals(s.elements));
            at != model_.mesh.element_set_names.end())
            s.elements = at->second;
        if (s.cells.empty()) return lose(card, "no element set '" + s.elements + "'");
        s.orientation = capitals_of(card, "ORIENTATION");
        model_.sections.push_back(std::move(s));
    }

    void transform(const DeckCard& card) {
        const std::string* nodes = card.parameter("NSET");
        const std::vector<Index> points = nodes == nullptr ? std::vector<Index>{} : points_of(*nodes);
        if (points.empty() || card.first == card.last) return lose(card, "no node set, or no data");
        const std::string type = capitals_of(card, "TYPE");
        if (!type.empty() && type != "R" && type != "C") return lose(card, "only TYPE=R and TYPE=C have a counterpart");
        const std::vector<double> v = numbers(*deck_.begin(card), 6);
        DeckTransform axes{type == "C", {Vec3(v[0], v[1], v[2]), Vec3(v[3], v[4], v[5])}};
        if (!(axes.cylinder ? (axes.points[1] - axes.points[0]).norm() > 0
                            : axes.points[0].cross(axes.points[1]).norm() > 0))
            return lose(card, "its points are on one line, or the same");
        for (const Index p : points) model_.transform_of[p] = model_.transforms.size();
        model_.transforms.push_back(axes);
    }

    /// Whether the step that begins with a card asks for eigenfrequencies, which the steps before it do not depend on.
    [[nodiscard]] bool asks_for_frequencies(const DeckCard& card) const {
        for (auto at = deck_.cards.begin() + (&card - deck_.cards.data()) + 1; at != deck_.cards.end(); ++at) {
            const std::string word = without_blanks(at->keyword);
            if (word == "STEP" || word == "ENDSTEP") return false;
            if (word == "FREQUENCY") return true;
        }
        return false;
    }

    void begin_step(const DeckCard& card) {
        if (asks_for_frequencies(card)) {
            model_.note(deck_.place(card), "*STEP", "eigenfrequencies are not computed: all of the step is left out");
            passing_over_ = true;
            return;
        }
        model_.steps.emplace_back();
        step_ = &model_.steps.back();
        step_taken_ = false;
        step_->place = deck_.place(card);
        if (card.parameter("NLGEOM") != nullptr) nlgeom_ = capitals_of(card, "NLGEOM") != "NO";
        step_->nlgeom = nlgeom_;
        if (const std::string course = capitals_of(card, "AMPLITUDE"); course == "STEP" || course == "RAMP")
            step_->ramped = course == "RAMP";
        else if (!course.empty())
            lose(card, "AMPLITUDE=" + course + ": it is STEP or RAMP");
        if (card.parameter("PERTURBATION") != nullptr) drop_step("PERTURBATION has no counterpart");
    }

    /// Goes on reading into a step that is not kept, so that nothing of it reaches another.
    void drop_step(const std::string& why) {
        lose(step_->place, "*STEP", why + "; all of the step is left out");
        model_.steps.pop_back();
        step_ = &dropped_;
        step_taken_ = true;
    }

    void analysis(const DeckCard& card) {
        if (step_ == &dropped_) return;
        step_taken_ = true;
        step_->dynamic = card.keyword == "DYNAMIC";
        if (step_->dynamic && card.parameter("EXPLICIT") != nullptr)
            return drop_step("*DYNAMIC, EXPLICIT has no counterpart: dynamics are implicit");
        if (card.parameter("RIKS") != nullptr) return drop_step("RIKS has no counterpart: loads are given");
        step_->direct = card.parameter("DIRECT") != nullptr;
        if (const std::string* alpha = card.parameter("ALPHA"); alpha != nullptr && !to_number(*alpha, step_->alpha))
            note(card, "ALPHA is no number");
        if (step_->alpha < -1.0 / 3 || step_->alpha > 0) step_->alpha = -0.05;
        if (card.first == card.last) return;
        const std::vector<double> v = numbers(*deck_.begin(card), 2);
        if (v[0] > 0) step_->increment = v[0];
        step_->duration = v[1] > 0 ? v[1] : step_->increment;
    }

    MaterialCards materials_;
    ContactCards contact_;
    GeneralContactCards general_;
    EquationCards equations_;
    LoadCards loads_;
    std::string before_; ///< the card before
    DeckStep* step_ = nullptr;
    DeckStep dropped_;
    bool step_taken_ = false, passing_over_ = false;
    bool nlgeom_ = false; ///< of the last step that said so
};

} // namespace

bool DeckModel::on_axis(Index point) const {
    constexpr double near = 1e-9; // of the distance along the axis
    const auto at = transform_of.find(point);
    if (at == transform_of.end() || !transforms[at->second].cylinder) return false;
    const auto& points = transforms[at->second].points;
    const Vec3 axis = (points[1] - points[0]).normalized(),
               arm = mesh.raw.points[static_cast<std::size_t>(point)] - points[0];
    return !((arm - axis * axis.dot(arm)).norm() > near * arm.norm());
}

Mat3 DeckModel::axes_of(Index point) const {
    const auto at = transform_of.find(point);
    if (at == transform_of.end()) return Mat3::Identity();
    const auto& [cylinder, points] = transforms[at->second];
    Mat3 axes;
    if (cylinder) {
        axes.col(2) = (points[1] - points[0]).normalized();
        const Vec3 arm = mesh.raw.points[static_cast<std::size_t>(point)] - points[0];
        axes.col(0) = (arm - axes.col(2) * axes.col(2).dot(arm)).normalized();
        axes.col(1) = axes.col(2).cross(axes.col(0));
    } else {
        axes.col(0) = points[0].normalized();
        axes.col(2) = points[0].cross(points[1]).normalized();
        axes.col(1) = axes.col(2).cross(axes.col(0));
    }
    return axes;
}

DeckModel read_deck_model(const mesh::Deck& deck) {
    DeckModel model;
    model.mesh = mesh::read_deck_mesh(deck);
    Reader(deck, model).read();
    add_pairs_of_general_contact(model);
    return model;
}

} // namespace osculate::deck

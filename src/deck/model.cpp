#include "deck/model.hpp"

#include "deck/contact_cards.hpp"
#include "deck/equations.hpp"
#include "deck/general_contact.hpp"
#include "deck/material_cards.hpp"
#include "deck/no_counterpart.hpp"
#include "deck/rigid_cards.hpp"

#include <algorithm>
#include <numeric>
#include <set>

namespace osculate::deck {
namespace {

constexpr int components = 3;

/// What these say is in the mesh, or has nothing to say.
const std::set<std::string> read_elsewhere{"NODE",    "ELEMENT",  "NSET",      "ELSET",    "SURFACE",
                                           "HEADING", "PREPRINT", "RIGIDBODY", "COUPLING", "KINEMATICCOUPLING"};

class Reader : CardReader {
public:
    Reader(const mesh::Deck& deck, DeckModel& model)
        : CardReader(deck, model), materials_(deck, model), contact_(deck, model), general_(deck, model),
          equations_(deck, model), rigid_(deck, model) {}

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
            general_.take(card, word, step_) || equations_.take(card, word, step_ != nullptr))
            return;
        if (word == "TEMPERATURE" && step_ != nullptr) return temperatures(card, step_->temperatures);
        if (word == "INITIALCONDITIONS" && capitals_of(card, "TYPE") == "TEMPERATURE")
            return temperatures(card, model_.initial_temperatures);
        if (word == "SOLIDSECTION") return section(card);
        if (word == "TRANSFORM" && step_ == nullptr) return transform(card);
        if (word == "AMPLITUDE") return amplitude(card);
        if (word == "BOUNDARY") return boundary(card);
        if (word == "CLOAD" && step_ != nullptr) return forces(card);
        if ((word == "DLOAD" || word == "DSLOAD") && step_ != nullptr) return pressures(card);
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

    void temperatures(const DeckCard& card, std::vector<DeckTemperature>& list) {
        for (const char* unknown : {"AMPLITUDE", "USER", "FILE", "BSTEP"})
            if (given(card, unknown) != nullptr) return lose(card, std::string(unknown) + " has no counterpart");
        if (is_new(card)) return lose(card, "OP=NEW has no counterpart: temperatures stay until they change");
        for (auto line = deck_.begin(card); line != deck_.end(card); ++line) {
            split_fields(line->text, fields_);
            DeckTemperature t;
            t.place = deck_.place(*line);
            const std::string shown(line->source.substr(0, 60));
            t.points = points_of(fields_[0]);
            for (std::size_t i = 0, n = t.points.size(); i < n; ++i) // through the layer of plane elements
                if (const auto above = model_.mesh.above.find(t.points[i]); above != model_.mesh.above.end())
                    t.points.insert(t.points.end(), above->second.begin(), above->second.end());
            if (t.points.empty() || fields_.size() < 2 || !to_number(fields_[1], t.value))
                lose(t.place, shown, "not understood");
            else
                list.push_back(std::move(t));
        }
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

    /// Abaqus' SMOOTH STEP: between rows A_i + (A_i+1 - A_i) s^3 (10 - 15 s + 6 s^2), without slope and curvature at the rows.
    static Amplitude smooth_steps(const Amplitude& rows) {
        constexpr int pieces = 64; // 5.8 / 8 / 64^2 of the step between a chord and its arc
        Amplitude all{rows.front()};
        for (std::size_t k = 1; k < rows.size(); ++k)
            for (int i = 1; i <= pieces; ++i) {
                const double s = static_cast<double>(i) / pieces, rise = s * s * s * (10 + s * (6 * s - 15));
                const auto between = [&](std::size_t column, double part) {
                    return rows[k - 1][column] + part * (rows[k][column] - rows[k - 1][column]);
                };
                all.push_back({between(0, s), between(1, rise)});
            }
        return all;
    }

    void amplitude(const DeckCard& card) {
        const std::string name = capitals_of(card, "NAME");
        const std::string type = capitals_of(card, "DEFINITION");
        const bool smooth = type == "SMOOTH STEP" || type == "SMOOTHSTEP";
        if (!type.empty() && type != "TABULAR" && !smooth)
            return note(card, "only TABULAR amplitudes and SMOOTH STEP have a counterpart");
        if (capitals_of(card, "TIME") == "TOTAL TIME" || card.parameter("USER") != nullptr ||
            card.parameter("SHIFTX") != nullptr || card.parameter("SHIFTY") != nullptr)
            return note(card, "only amplitudes over the time of a step have a counterpart");
        std::vector<double> all;
        for (auto line = deck_.begin(card); line != deck_.end(card); ++line)
            for (const double v : numbers(*line, 0)) all.push_back(v);
        Amplitude rows;
        for (std::size_t k = 0; k + 1 < all.size(); k += 2) rows.push_back({all[k], all[k + 1]});
        for (std::size_t k = 1; k < rows.size(); ++k)
            if (!(rows[k][0] > rows[k - 1][0])) return note(card, "its times do not ascend");
        if (rows.empty()) return note(card, "it has no rows");
        if (smooth) note(card, "64 straight pieces between two rows are off by up to 2e-4 of the step");
        model_.amplitudes[name] = smooth ? smooth_steps(rows) : std::move(rows);
    }

    bool amplitude_of(const DeckCard& card, std::string& name) {
        name = capitals_of(card, "AMPLITUDE");
        const std::string* delay = given(card, "TIMEDELAY");
        if (name.empty() || (model_.amplitudes.contains(name) && delay == nullptr)) return true;
        double later = 0;
        if (!model_.amplitudes.contains(name) || !to_number(*delay, later)) {
            lose(card, "its amplitude '" + name + "' has no counterpart");
            return false;
        }
        Amplitude rows = model_.amplitudes[name];
        for (auto& row : rows) row[0] += later;
        name += " later by " + *delay;
        model_.amplitudes[name] = std::move(rows);
        return true;
    }

    bool is_new(const DeckCard& card) const { return capitals_of(card, "OP") == "NEW"; }

    void boundary(const DeckCard& card) {
        std::vector<DeckValues>& held = step_ != nullptr ? step_->held : model_.held;
        if (is_new(card) && step_ != nullptr) step_->forget_held = true;
        DeckValues values;
        if (!amplitude_of(card, values.amplitude)) return;
        if (const std::string type = capitals_of(card, "TYPE"); !type.empty() && type != "DISPLACEMENT")
            return lose(card, "TYPE=" + type + " has no counterpart");
        for (const char* name : {"FIXED", "SUBMODEL", "USER", "LOADCASE"})
            if (card.parameter(name) != nullptr) return lose(card, std::string(name) + " has no counterpart");
        for (auto line = deck_.begin(card); line != deck_.end(card); ++line) {
            split_fields(line->text, fields_);
            values.place = deck_.place(*line);
            const std::string shown(line->source.substr(0, 60));
            values.points = fields_.empty() ? std::vector<Index>{} : points_of(fields_[0]);
            if (values.points.empty()) {
                lose(values.place, shown, "no node or node set of that name");
                continue;
            }
            values.value = 0;
            long long first = 0, last = 0;
            static const std::map<std::string, std::vector<int>> words{{"ENCASTRE", {1, 2, 3, 4, 5, 6}},
                                                                       {"PINNED", {1, 2, 3}},
                                                                       {"XSYMM", {1, 5, 6}},
                                                                       {"YSYMM", {2, 4, 6}},
                                                                       {"ZSYMM", {3, 4, 5}},
                                                                       {"XASYMM", {2, 3, 4}},
                                                                       {"YASYMM", {1, 3, 5}},
                                                                       {"ZASYMM", {1, 2, 6}}};
            std::vector<int> all;
            const auto word = fields_.size() > 1 ? words.find(in_capitals(fields_[1])) : words.end();
            if (word != words.end()) {
                all = word->second;
            } else {
                const bool good = fields_.size() > 1 && to_integer(fields_[1], first) &&
                                  (fields_.size() < 3 || fields_[2].empty() || to_integer(fields_[2], last)) &&
                                  (fields_.size() < 4 || fields_[3].empty() || to_number(fields_[3], values.value));
                if (fields_.size() < 3 || fields_[2].empty()) last = first;
                if (!good || first < 1 || last < first) {
                    lose(values.place, shown, "not understood");
                    continue;
                }
                for (long long c = first; c <= std::min<long long>(last, 2 * components); ++c)
                    all.push_back(static_cast<int>(c));
            }
            rigid_.hold(values, all, step_);
            if (values.points.empty()) continue;
            if (all.empty() || all.front() > components) {
                model_.note(values.place, shown, "nodes have three displacements");
                continue;
            }
            for (const int c : all) {
                values.first = values.last = c - 1;
                if (c <= components) held.push_back(values);
            }
        }
    }

    void forces(const DeckCard& card) {
        if (is_new(card)) step_->forget_forces = true;
        DeckValues values;
        if (!amplitude_of(card, values.amplitude)) return;
        for (auto line = deck_.begin(card); line != deck_.end(card); ++line) {
            split_fields(line->text, fields_);
            values.place = deck_.place(*line);
            const std::string shown(line->source.substr(0, 60));
            long long component = 0;
            if (fields_.size() < 3 || !to_integer(fields_[1], component) || !to_number(fields_[2], values.value)) {
                lose(values.place, shown, "not understood");
                continue;
            }
            values.points = points_of(fields_[0]);
            if (!values.points.empty() && component >= 1 && component <= 2 * components) {
                rigid_.load(values, static_cast<int>(component), step_);
                if (values.points.empty()) continue;
            }
            if (values.points.empty() || component < 1 || component > components) {
                lose(values.place, shown,
                     values.points.empty() ? "no node or node set of that name" : "nodes have forces alone");
                continue;
            }
            values.first = values.last = static_cast<int>(component) - 1;
            step_->forces.push_back(values);
        }
    }

    void pressures(const DeckCard& card) {
        const bool on_surface = card.keyword == "DSLOAD";
        if (is_new(card)) (on_surface ? step_->forget_on_surfaces : step_->forget_on_elements) = true;
        std::string amplitude;
        if (!amplitude_of(card, amplitude)) return;
        for (auto line = deck_.begin(card); line != deck_.end(card); ++line) {
            split_fields(line->text, fields_);
            const std::string place = deck_.place(*line), shown(line->source.substr(0, 60));
            const std::string label = fields_.size() > 1 ? in_capitals(fields_[1]) : "";
            if (label == "GRAV" && fields_.size() >= 6) {
                gravity(place, shown, amplitude);
                continue;
            }
            if (label == "CENTRIF" && fields_.size() >= 9 && amplitude.empty()) {
                centrifugal(place, shown);
                continue;
            }
            DeckPressure p;
            p.amplitude = amplitude;
            p.place = place;
            if (fields_.size() < 3 || !to_number(fields_[2], p.value)) {
                lose(place, shown, "not understood");
                continue;
            }
            p.name = std::string(fields_[0]);
            p.keyword = card.keyword;
            std::string why = "only pressures on faces, gravity and centrifugal forces have a counterpart";
            if (on_surface) {
                const auto at = model_.mesh.surface_names.find(in_capitals(fields_[0]));
                if (at == model_.mesh.surface_names.end())
                    why = "no surface of that name";
                else if (label == "P")
                    p.faces = model_.mesh.raw.surfaces.at(at->second);
            } else if (label.size() == 2 && label[0] == 'P' && label[1] >= '1' && label[1] <= '6') {
                const std::vector<Index> cells = cells_of(fields_[0]);
                why = cells.empty() ? "no element or element set of that name" : "its elements have no such face";
                for (const Index c : cells)
                    if (const mesh::RawFace face = model_.mesh.face_of(c, label[1] - '1'); face.count > 0)
                        p.faces.push_back(face);
                if (long long id = 0; to_integer(fields_[0], id)) p.name = "elements"; // one by one
            }
            if (p.faces.empty())
                lose(place, shown, why);
            else
                step_->pressures.push_back(std::move(p));
        }
    }

    /// Of the first field of a line of *DLOAD; all for an empty one.
    [[nodiscard]] std::vector<Index> loaded_cells() const {
        if (!fields_[0].empty()) return cells_of(fields_[0]);
        std::vector<Index> all(model_.mesh.raw.cells.size());
        std::iota(all.begin(), all.end(), 0);
        return all;
    }

    void gravity(const std::string& place, const std::string& shown, const std::string& amplitude) {
        DeckGravity g;
        double size = 0;
        Vec3 direction;
        bool good = to_number(fields_[2], size);
        for (int d = 0; d < 3; ++d) good = good && to_number(fields_[3 + static_cast<std::size_t>(d)], direction[d]);
        g.cells = loaded_cells();
        g.elements = in_capitals(fields_[0]);
        if (!good || g.cells.empty() || !(direction.norm() > 0)) return lose(place, shown, "not understood");
        g.acceleration = size * direction.normalized();
        g.amplitude = amplitude;
        g.place = place;
        step_->gravity.push_back(std::move(g));
    }

    void centrifugal(const std::string& place, const std::string& shown) {
        DeckCentrifugal c;
        bool good = to_number(fields_[2], c.square) && c.square >= 0;
        for (std::size_t d = 0; d < 3; ++d)
            good = good && to_number(fields_[3 + d], c.point[static_cast<Index>(d)]) &&
                   to_number(fields_[6 + d], c.axis[static_cast<Index>(d)]);
        c.cells = loaded_cells();
        if (!good || c.cells.empty() || !(c.axis.norm() > 0)) return lose(place, shown, "not understood");
        c.place = place;
        step_->centrifugal.push_back(std::move(c));
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
    RigidCards rigid_;
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

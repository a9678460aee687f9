#pragma once
/// How enums, named maps and variants are shown to a visitor, and the descriptions that describe.cpp joins.

#include "osculate/scene/scene.hpp"
#include "scene/visitor.hpp"

#include <algorithm>
#include <type_traits>
#include <utility>

namespace osculate::scene {

inline const Words axis_words{"x", "y", "z"};
inline const Words motion_words{"x",  "y",  "z",
                                "rx", "ry", "rz"}; ///< components of the motion of a rigid body or coupling

/// An enum whose enumerators stand in the order of the vocabulary.
template <class E> void word(Visitor& v, const Key& key, const Words& vocabulary, E& value) {
    auto index = static_cast<std::size_t>(value);
    v.word(key, vocabulary, index);
    value = static_cast<E>(index);
}

/// Named values; `item(name, value)` describes one under its name.
template <class T, class Item> Entries entries_of(Named<T>& values, const Item& item) {
    return {.size = [&] { return values.size(); },
            .name = [&](std::size_t i) { return values[i].first; },
            .add =
                [&, given = values.size()](const std::string& name) mutable { // by a template, first
                    const auto end = values.begin() + static_cast<std::ptrdiff_t>(given);
                    const auto at =
                        std::find_if(values.begin(), end, [&](const auto& known) { return known.first == name; });
                    if (at != end) {
                        values.erase(at);
                        --given;
                    }
                    if constexpr (std::is_same_v<T, Vec3>)
                        values.emplace_back(name, Vec3::Zero());
                    else
                        values.emplace_back(name, T{});
                },
            .describe = [&, item](std::size_t i) { item(values[i].first, values[i].second); }};
}
template <class T, class Item> void named(Visitor& v, const Key& key, Named<T>& values, const Item& item) {
    v.named(key, entries_of(values, item));
}

template <class Variant, std::size_t... I>
void emplace(Variant& value, std::size_t index, std::index_sequence<I...> /*all*/) {
    ((I == index ? static_cast<void>(value.template emplace<I>()) : void()), ...);
}

/// A variant whose alternatives are groups, tagged in the order of the variant.
template <class Variant, class Describe>
void one_of(Visitor& v, const Words& tags, const std::vector<const char*>& meanings, bool required, Variant& value,
            const Describe& describe_alternative) {
    v.one_of(
        {.tags = tags,
         .active = value.index(),
         .required = required,
         .choose = [&](std::size_t i) { emplace(value, i, std::make_index_sequence<std::variant_size_v<Variant>>{}); },
         .describe =
             [&](std::size_t i) {
                 v.group({.name = tags[i], .meaning = meanings[i]},
                         [&] { std::visit([&](auto& alternative) { describe_alternative(alternative); }, value); });
             }});
}

void describe_overclosure(Visitor& v, const Key& key, PressureOverclosure& law);
void describe(Visitor& v, Body& body);
void describe(Visitor& v, Material& material);
void describe(Visitor& v, Section& section);
void describe(Visitor& v, SelectBox& box);
void describe(Visitor& v, Rigid& rigid);
void describe(Visitor& v, Slice& slice);
void describe(Visitor& v, RigidSurface& surface);
void describe(Visitor& v, Coupling& coupling);
void describe(Visitor& v, Tie& tie);
void describe(Visitor& v, CyclicSymmetry& symmetry);
void describe(Visitor& v, Equation& equation);
void describe(Visitor& v, Axis& axis);
void describe(Visitor& v, SetSpec& set);
void describe(Visitor& v, Support& support);
void describe(Visitor& v, Pair& pair);
void describe(Visitor& v, GeneralContact& general);
void describe(Visitor& v, Stage& stage);
void describe(Visitor& v, Solver& solver);
void describe(Visitor& v, Expectation& expect);

} // namespace osculate::scene

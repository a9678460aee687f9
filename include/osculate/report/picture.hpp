#pragma once
/// Pictures of the bodies, drawn without a display.

#include "osculate/report/encode.hpp"
#include "osculate/report/moving_surfaces.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace osculate::report {

/// Colours from the smallest to the largest value, evenly spaced: viridis, perceptually uniform, without its darkest
/// fifth, which would be invisible on a dark background.
[[nodiscard]] const std::vector<std::array<std::uint8_t, 3>>& colour_map();

/// Field that pictures and the page show first: a scalar field of the bodies.
struct ShownField {
    std::string name; ///< empty: bodies in plain colour
    std::string unit;
    double low = 0, high = 1; ///< over all frames and bodies
};
[[nodiscard]] ShownField field_to_show(const MovingSurfaces& surfaces);
/// A field of the bodies by its name, the length of its values where it is a vector; without a name where there is none.
[[nodiscard]] ShownField shown_field(const MovingSurfaces& surfaces, const std::string& name);

struct PictureOptions {
    int width = 1200, height = 750;   ///< pixels
    Vec3 towards_eye{0.62, -1, 0.72}; ///< from the bodies; z is up
    ShownField field;
    bool outlines = false; ///< lines along the borders of parts only, not around every facet
};

/// Draws the deformed bodies of a frame in parallel projection, without hidden parts, as a PNG file with transparent
/// background. The view is the same for every frame. Empty if the bodies have no displacement.
[[nodiscard]] Bytes draw(const MovingSurfaces& surfaces, std::size_t frame, const PictureOptions& options);

/// A picture, and where things are seen in it.
struct PictureWithPlaces {
    Bytes png;
    std::vector<std::optional<Eigen::Vector2d>> places; ///< pixels from the upper left corner; none for what is hidden
};

/// The same picture, and for each list of points that one of those not hidden which is nearest to their middle.
[[nodiscard]] PictureWithPlaces draw(const MovingSurfaces& surfaces, std::size_t frame, const PictureOptions& options,
                                     const std::vector<std::vector<Vec3>>& things);

/// An SVG file: the picture with a title and a colour legend.
[[nodiscard]] std::string with_legend(const Bytes& png, const PictureOptions& options, const std::string& title);

} // namespace osculate::report

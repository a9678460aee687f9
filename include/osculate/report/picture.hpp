#pragma once
/// Pictures of the bodies, drawn without any display.

#include "osculate/report/encode.hpp"
#include "osculate/report/moving_surfaces.hpp"

#include <array>
#include <string>
#include <vector>

namespace osculate::report {

/// Colours from the least to the largest value, evenly spaced: viridis, perceptually uniform, without its darkest fifth,
/// which a dark ground would swallow.
[[nodiscard]] const std::vector<std::array<std::uint8_t, 3>>& colour_map();

/// What pictures and the page show at first: a field of the bodies as a number.
struct ShownField {
    std::string name; ///< empty: bodies in plain colour
    std::string unit;
    double low = 0, high = 1; ///< over all frames and bodies
};
[[nodiscard]] ShownField field_to_show(const MovingSurfaces& surfaces);

struct PictureOptions {
    int width = 1200, height = 750;   ///< pixels
    Vec3 towards_eye{0.62, -1, 0.72}; ///< from the bodies; z is up
    ShownField field;
};

/// The deformed bodies in a frame, parallel projection, hidden parts hidden, as a PNG file with a transparent ground. The
/// same view for every frame. Empty where the bodies have no displacement to draw.
[[nodiscard]] Bytes draw(const MovingSurfaces& surfaces, std::size_t frame, const PictureOptions& options);

/// An SVG file: the picture with a title and its colours' legend.
[[nodiscard]] std::string with_legend(const Bytes& png, const PictureOptions& options, const std::string& title);

} // namespace osculate::report

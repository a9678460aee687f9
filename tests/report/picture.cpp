#include "osculate/report/picture.hpp"

#include <gtest/gtest.h>
#include <png.h>

namespace osculate::report::OSCULATE_THIS_FILE {
namespace {

constexpr int width = 80, height = 60;

struct Pixels {
    std::vector<std::uint8_t> rgba;
    [[nodiscard]] const std::uint8_t* at(int x, int y) const {
        return &rgba[static_cast<std::size_t>(4 * (y * width + x))];
    }
};

Pixels decoded(const Bytes& file) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    EXPECT_NE(png_image_begin_read_from_memory(&image, file.data(), file.size()), 0);
    image.format = PNG_FORMAT_RGBA;
    Pixels pixels;
    pixels.rgba.resize(PNG_IMAGE_SIZE(image));
    EXPECT_NE(png_image_finish_read(&image, nullptr, pixels.rgba.data(), 0, nullptr), 0);
    EXPECT_EQ(image.width, static_cast<png_uint_32>(width));
    return pixels;
}

/// A square at x = const with one value on it, which shifts by `u` along y.
MovingPart square(double x, double half, float value, float u) {
    MovingPart part;
    part.name = "square";
    part.points = {{x, -half, -half}, {x, half, -half}, {x, half, half}, {x, -half, half}};
    part.facets = {{0, 1, 2, 3}};
    PartField displacement{"displacement", "m", false, {3, {}}}, stress{"von_mises", "Pa", false, {1, {}}};
    displacement.values.frames.push_back({0, u, 0, 0, u, 0, 0, u, 0, 0, u, 0});
    stress.values.frames.push_back({value, value, value, value});
    part.fields = {displacement, stress};
    return part;
}

class Picture : public testing::Test {
protected:
    Picture() {
        surfaces.times = {0};
        surfaces.parts = {square(1, 0.5, 10, 0), square(0, 1, 0, 0)}; // the small one is nearer to an eye at x
        options.width = width;
        options.height = height;
        options.towards_eye = Vec3::UnitX();
        options.field = field_to_show(surfaces);
    }
    MovingSurfaces surfaces;
    PictureOptions options;
};

TEST_F(Picture, WhatIsInFrontHidesWhatIsBehind) {
    const Pixels pixels = decoded(draw(surfaces, 0, options));
    const auto high = colour_map().back(), low = colour_map().front();
    for (const std::size_t c : {0U, 1U, 2U}) {
        EXPECT_NEAR(pixels.at(width / 2 + 5, height / 2)[c], high[c], 2); // yellow, of the one in front
        EXPECT_NEAR(pixels.at(width / 2 + 20, height / 2)[c], low[c], 2); // beside it that behind
    }
    EXPECT_EQ(pixels.at(1, height / 2)[3], 0); // nothing: transparent
    options.towards_eye = -Vec3::UnitX();
    const Pixels behind = decoded(draw(surfaces, 0, options));
    EXPECT_NEAR(behind.at(width / 2 + 5, height / 2)[2], low[2], 2);
}

TEST_F(Picture, IsTheSameEveryTime) {
    EXPECT_EQ(draw(surfaces, 0, options), draw(surfaces, 0, options));
}

TEST_F(Picture, FollowsTheDisplacement) {
    const Bytes before = draw(surfaces, 0, options);
    surfaces.parts[0] = square(1, 0.5, 10, 0.3F);
    EXPECT_NE(draw(surfaces, 0, options), before);
}

TEST_F(Picture, OfPointsThatAreNoNumbersLeavesThemOut) {
    surfaces.parts[0].fields[0].values.frames[0][1] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_FALSE(draw(surfaces, 0, options).empty());
}

TEST_F(Picture, IsNoneWithoutDisplacement) {
    for (MovingPart& part : surfaces.parts) part.fields.clear();
    EXPECT_TRUE(draw(surfaces, 0, options).empty());
    EXPECT_EQ(field_to_show(surfaces).name, "");
}

TEST_F(Picture, ItsLegendTellsTheEndsAndTheUnit) {
    const std::string svg = with_legend(draw(surfaces, 0, options), options, "<end>");
    EXPECT_NE(svg.find("10 Pa"), std::string::npos);
    EXPECT_NE(svg.find("&lt;end&gt;"), std::string::npos);
}

} // namespace
} // namespace osculate::report::OSCULATE_THIS_FILE

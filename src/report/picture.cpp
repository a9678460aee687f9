#include "osculate/report/picture.hpp"

#include "osculate/core/escaped.hpp"
#include "osculate/core/without_traps.hpp"
#include "osculate/scene/outline.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <limits>
#include <map>
#include <png.h>
#include <set>
#include <stdexcept>

namespace osculate::report {

namespace {

constexpr int samples = 2; ///< along either side of a pixel
constexpr double margin = 0.04;
const Vec3 plain{0.62, 0.66, 0.71};

Vec3 colour(double share) {
    const auto& map = colour_map();
    const double at = std::clamp(share, 0., 1.) * static_cast<double>(map.size() - 1);
    const std::size_t i = std::min(static_cast<std::size_t>(at), map.size() - 2);
    const double t = at - static_cast<double>(i);
    Vec3 mixed;
    for (int c = 0; c < 3; ++c) {
        const auto k = static_cast<std::size_t>(c);
        mixed[c] = ((1 - t) * map[i][k] + t * map[i + 1][k]) / 255;
    }
    return mixed;
}

/// Length of a field's values, or the value itself.
double magnitude(const PartField& field, std::size_t frame, std::size_t point) {
    const auto n = static_cast<std::size_t>(field.values.components);
    const std::vector<float>& values = field.values.frames[frame];
    if (n == 1) return values[point];
    double sum = 0;
    for (std::size_t c = 0; c < n; ++c) sum += double{values[point * n + c]} * double{values[point * n + c]};
    return std::sqrt(sum);
}

Vec3 position(const MovingPart& part, const PartField& displacement, std::size_t frame, std::size_t point) {
    const std::vector<float>& u = displacement.values.frames[frame];
    return part.points[point] + Vec3(u[3 * point], u[3 * point + 1], u[3 * point + 2]);
}

/// Parallel projection onto the picture: x right, y down in samples, z towards the eye in metres.
class Projection {
public:
    Projection(const MovingSurfaces& surfaces, const PictureOptions& options) {
        const Vec3 w = options.towards_eye.normalized(), u = Vec3::UnitZ().cross(w).normalized();
        axes_.row(0) = u;
        axes_.row(1) = -w.cross(u);
        axes_.row(2) = w;
        Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
        const std::size_t last = surfaces.times.size() - 1;
        for (const MovingPart& part : surfaces.parts) {
            const PartField* displacement = part.find("displacement");
            if (part.kind != PartKind::body || displacement == nullptr) continue;
            for (const std::size_t frame : {std::size_t{0}, last / 2, last})
                for (std::size_t p = 0; p < part.points.size(); ++p) {
                    const Vec3 x = axes_ * position(part, *displacement, frame, p);
                    if (!x.allFinite()) continue;
                    low = low.cwiseMin(x);
                    high = high.cwiseMax(x);
                }
        }
        if (!(low.array() <= high.array()).all()) return; // no position at all
        const double width = samples * options.width, height = samples * options.height;
        const Vec3 extent = (high - low).cwiseMax(1e-12);
        scale_ = (1 - 2 * margin) * std::min(width / extent.x(), height / extent.y());
        shift_ = Vec3(width / 2, height / 2, 0) - scale_ * (low + high) / 2;
        shift_.z() = 0;
    }
    [[nodiscard]] bool valid() const { return scale_ > 0; }
    [[nodiscard]] Vec3 operator()(const Vec3& x) const {
        Vec3 y = axes_ * x;
        y.head<2>() = scale_ * y.head<2>() + shift_.head<2>();
        y.z() *= scale_;
        return y;
    }

private:
    Mat3 axes_ = Mat3::Identity();
    double scale_ = 0;
    Vec3 shift_ = Vec3::Zero();
};

struct Corner {
    Vec3 at; ///< projected
    double share = 0;
};

/// Samples with their depth; triangles first, lines on top of what they lie on.
class Canvas {
public:
    Canvas(int width, int height)
        : width_(width), height_(height), depth_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height),
                                                 -std::numeric_limits<double>::infinity()),
          colours_(depth_.size(), Vec3::Zero()), lined_(depth_.size(), false) {}

    void triangle(const Corner& a, const Corner& b, const Corner& c, bool plainly) {
        const Vec3 normal = (b.at - a.at).cross(c.at - a.at);
        const double area = normal.z();
        if (!normal.allFinite() || std::abs(area) < 1e-9) return;
        const double light = 0.6 + 0.4 * std::abs(area) / normal.norm();
        const auto bound = [](double value, int limit) {
            return static_cast<int>(std::clamp(value, 0., double(limit)));
        };
        const int x0 = bound(std::floor(std::min({a.at.x(), b.at.x(), c.at.x()})), width_);
        const int x1 = bound(std::ceil(std::max({a.at.x(), b.at.x(), c.at.x()})) + 1, width_);
        const int y0 = bound(std::floor(std::min({a.at.y(), b.at.y(), c.at.y()})), height_);
        const int y1 = bound(std::ceil(std::max({a.at.y(), b.at.y(), c.at.y()})) + 1, height_);
        for (int y = y0; y < y1; ++y)
            for (int x = x0; x < x1; ++x) {
                const Vec3 p(x + 0.5, y + 0.5, 0);
                const double s = twice_area(p, b.at, c.at) / area, t = twice_area(a.at, p, c.at) / area, r = 1 - s - t;
                if (s < 0 || t < 0 || r < 0) continue;
                const double z = s * a.at.z() + t * b.at.z() + r * c.at.z();
                const std::size_t i = index(x, y);
                if (z <= depth_[i]) continue;
                depth_[i] = z;
                const double share = s * a.share + t * b.share + r * c.share;
                colours_[i] = light * (plainly || !std::isfinite(share) ? plain : colour(share));
            }
    }

    void line(const Vec3& a, const Vec3& b) {
        const double length = std::max(std::abs(b.x() - a.x()), std::abs(b.y() - a.y()));
        if (!std::isfinite(length) || length > 1e5) return;
        const int steps = static_cast<int>(length) + 1;
        constexpr double before = 2.5, strength = 0.4; // samples; of the line over what lies below
        for (int k = 0; k <= steps; ++k) {
            const Vec3 p = a + (b - a) * (static_cast<double>(k) / steps);
            const int x = static_cast<int>(std::floor(p.x())), y = static_cast<int>(std::floor(p.y()));
            if (x < 0 || y < 0 || x >= width_ || y >= height_) continue;
            const std::size_t i = index(x, y);
            if (p.z() + before < depth_[i] || lined_[i]) continue;
            lined_[i] = true;
            const bool dark = colours_[i].sum() < 1.1; // there lines are light
            colours_[i] = (1 - strength) * colours_[i] + (dark ? strength / 2 : 0) * (colours_[i] + Vec3::Ones());
        }
    }

    /// Whether a projected point is in front of all triangles but its own.
    [[nodiscard]] bool shows(const Vec3& p) const {
        const int x = static_cast<int>(std::floor(p.x())), y = static_cast<int>(std::floor(p.y()));
        constexpr double before = 1.5; // samples
        return x >= 0 && y >= 0 && x < width_ && y < height_ && p.z() + before >= depth_[index(x, y)];
    }

    [[nodiscard]] Bytes png() const {
        const int w = width_ / samples, h = height_ / samples;
        Bytes pixels;
        for (int y = 0; y < h; ++y)
            for (int x = 0; x < w; ++x) {
                Vec3 sum = Vec3::Zero();
                int covered = 0;
                for (int k = 0; k < samples * samples; ++k) {
                    const std::size_t i = index(samples * x + k % samples, samples * y + k / samples);
                    if (!std::isfinite(depth_[i])) continue;
                    sum += colours_[i];
                    ++covered;
                }
                for (int c = 0; c < 3; ++c)
                    pixels.push_back(covered == 0 ? 0 : static_cast<std::uint8_t>(std::lround(255 * sum[c] / covered)));
                pixels.push_back(static_cast<std::uint8_t>(255 * covered / (samples * samples)));
            }
        png_image image{};
        image.version = PNG_IMAGE_VERSION;
        image.width = static_cast<png_uint_32>(w);
        image.height = static_cast<png_uint_32>(h);
        image.format = PNG_FORMAT_RGBA;
        png_alloc_size_t size = 0;
        if (png_image_write_to_memory(&image, nullptr, &size, 0, pixels.data(), 0, nullptr) == 0)
            throw std::runtime_error(std::string("a picture cannot be written: ") + image.message);
        Bytes file(size);
        if (png_image_write_to_memory(&image, file.data(), &size, 0, pixels.data(), 0, nullptr) == 0)
            throw std::runtime_error(std::string("a picture cannot be written: ") + image.message);
        file.resize(size);
        return file;
    }

private:
    static double twice_area(const Vec3& a, const Vec3& b, const Vec3& c) {
        return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
    }
    [[nodiscard]] std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
    }
    int width_, height_;
    std::vector<double> depth_;
    std::vector<Vec3> colours_;
    std::vector<bool> lined_; ///< samples a line has darkened already
};

/// @param outlines  only those of a single facet
std::set<std::pair<std::uint32_t, std::uint32_t>> edges_of(const MovingPart& part, bool outlines) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> facets;
    for (const auto& f : part.facets)
        for (std::size_t c = 0; c < 4; ++c) {
            const std::uint32_t a = f[c], b = f[(c + 1) % 4];
            if (a != b) ++facets[{std::min(a, b), std::max(a, b)}];
        }
    std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
    for (const auto& [edge, count] : facets)
        if (!outlines || count == 1) edges.insert(edge);
    return edges;
}

Canvas drawn(const MovingSurfaces& surfaces, std::size_t frame, const PictureOptions& options,
             const Projection& project) {
    Canvas canvas(samples * options.width, samples * options.height);
    std::vector<std::vector<Corner>> corners;
    for (const MovingPart& part : surfaces.parts) {
        const PartField* displacement = part.find("displacement");
        std::vector<Corner>& list = corners.emplace_back();
        if (part.kind != PartKind::body || displacement == nullptr) continue;
        const PartField* field = options.field.name.empty() ? nullptr : part.find(options.field.name);
        for (std::size_t p = 0; p < part.points.size(); ++p) {
            const double value = field == nullptr ? 0 : magnitude(*field, frame, p);
            list.push_back({project(position(part, *displacement, frame, p)),
                            (value - options.field.low) / (options.field.high - options.field.low)});
        }
        for (const auto& f : part.facets) {
            canvas.triangle(list[f[0]], list[f[1]], list[f[2]], field == nullptr);
            if (f[3] != f[2]) canvas.triangle(list[f[0]], list[f[2]], list[f[3]], field == nullptr);
        }
    }
    constexpr std::size_t too_dense = 60000; // facets whose edges would cover them
    for (std::size_t k = 0; k < corners.size(); ++k)
        if (!corners[k].empty() && surfaces.parts[k].facets.size() < too_dense)
            for (const auto& [a, b] : edges_of(surfaces.parts[k], options.outlines))
                canvas.line(corners[k][a].at, corners[k][b].at);
    return canvas;
}

} // namespace

const std::vector<std::array<std::uint8_t, 3>>& colour_map() {
    static const std::vector<std::array<std::uint8_t, 3>> viridis{{65, 68, 135},  {53, 95, 141},  {42, 120, 142},
                                                                  {33, 145, 140}, {34, 168, 132}, {68, 191, 112},
                                                                  {122, 209, 81}, {189, 223, 38}, {253, 231, 37}};
    return viridis;
}

ShownField shown_field(const MovingSurfaces& surfaces, const std::string& name) {
    ShownField shown;
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const MovingPart& part : surfaces.parts) {
        const PartField* field = part.find(name);
        if (part.kind != PartKind::body || field == nullptr) continue;
        shown.unit = field->unit;
        for (std::size_t f = 0; f < surfaces.times.size(); ++f)
            for (std::size_t p = 0; p < part.points.size(); ++p)
                if (const double value = magnitude(*field, f, p); std::isfinite(value)) {
                    low = std::min(low, value);
                    high = std::max(high, value);
                }
    }
    if (low > high) return {};
    shown.name = name;
    shown.low = low;
    shown.high = high > low ? high : low + 1;
    return shown;
}

ShownField field_to_show(const MovingSurfaces& surfaces) {
    const ShownField stress = shown_field(surfaces, "von_mises");
    return stress.name.empty() ? shown_field(surfaces, "displacement") : stress;
}

Bytes draw(const MovingSurfaces& surfaces, std::size_t frame, const PictureOptions& options) {
    if (surfaces.times.empty()) return {};
    const WithoutTraps positions_may_be_no_numbers;
    const Projection project(surfaces, options);
    if (!project.valid()) return {};
    return drawn(surfaces, frame, options, project).png();
}

PictureWithPlaces draw(const MovingSurfaces& surfaces, std::size_t frame, const PictureOptions& options,
                       const std::vector<std::vector<Vec3>>& things) {
    PictureWithPlaces picture{{}, std::vector<std::optional<Eigen::Vector2d>>(things.size())};
    if (surfaces.times.empty()) return picture;
    const WithoutTraps positions_may_be_no_numbers;
    const Projection project(surfaces, options);
    if (!project.valid()) return picture;
    const Canvas canvas = drawn(surfaces, frame, options, project);
    picture.png = canvas.png();
    for (std::size_t i = 0; i < things.size(); ++i) {
        std::vector<Eigen::Vector2d> seen;
        Eigen::Vector2d middle = Eigen::Vector2d::Zero();
        for (const Vec3& x : things[i])
            if (const Vec3 at = project(x); canvas.shows(at)) {
                seen.emplace_back(at.head<2>() / samples);
                middle += seen.back();
            }
        if (seen.empty()) continue;
        middle /= static_cast<double>(seen.size());
        picture.places[i] =
            *std::ranges::min_element(seen, {}, [&](const Eigen::Vector2d& at) { return (at - middle).squaredNorm(); });
    }
    return picture;
}

std::string with_legend(const Bytes& png, const PictureOptions& options, const std::string& title) {
    const int foot = 90, head = 50;
    std::string svg = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\" viewBox=\"0 0 {0} "
        "{1}\" "
        "width=\"{0}\" height=\"{1}\" font-family=\"sans-serif\" font-size=\"18\" fill=\"#222\">\n"
        "<rect width=\"{0}\" height=\"{1}\" fill=\"#fff\"/>\n<text x=\"24\" y=\"34\" font-size=\"20\">{2}</text>\n"
        "<image x=\"0\" y=\"{3}\" width=\"{0}\" height=\"{4}\" xlink:href=\"data:image/png;base64,{5}\"/>\n",
        options.width, options.height + head + foot, escaped(title), head, options.height, base64(png));
    if (!options.field.name.empty()) {
        const auto& map = colour_map();
        svg += "<defs><linearGradient id=\"map\">";
        for (std::size_t i = 0; i < map.size(); ++i)
            svg += fmt::format("<stop offset=\"{:.4g}\" stop-color=\"#{:02x}{:02x}{:02x}\"/>",
                               static_cast<double>(i) / static_cast<double>(map.size() - 1), map[i][0], map[i][1],
                               map[i][2]);
        const int y = options.height + head + 24;
        const auto value = [&](double v) {
            return escaped(scene::engineering(std::stod(fmt::format("{:.3g}", v)), options.field.unit));
        };
        svg += fmt::format(
            "</linearGradient></defs>\n<rect x=\"24\" y=\"{}\" width=\"360\" height=\"16\" fill=\"url(#map)\"/>\n"
            "<text x=\"24\" y=\"{}\">{}</text><text x=\"384\" y=\"{}\" text-anchor=\"end\">{}</text>"
            "<text x=\"404\" y=\"{}\">{}</text>\n",
            y, y + 40, value(options.field.low), y + 40, value(options.field.high), y + 15,
            escaped(options.field.name));
    }
    return svg + "</svg>\n";
}

} // namespace osculate::report

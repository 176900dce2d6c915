#include "dem/page/bed_image.h"

#include <fmt/core.h>
#include <png.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "dem/base/constants.h"
#include "dem/base/error.h"

namespace granrad {

namespace {

/// Dark blue to yellow, as in page.js: reads the same in grey.
constexpr std::array<std::array<double, 3>, 8> stops{{{13, 8, 135},
                                                      {84, 2, 163},
                                                      {139, 10, 165},
                                                      {185, 50, 137},
                                                      {219, 92, 104},
                                                      {244, 136, 73},
                                                      {254, 188, 43},
                                                      {240, 249, 33}}};
constexpr double margin = 0.94;  ///< of the picture that the box fills
constexpr std::array<std::uint8_t, 3> line_colour{120, 120, 125};

std::array<double, 3> heat_colour(double t) {
  const double at = std::clamp(std::isfinite(t) ? t : 0.0, 0.0, 1.0) * (stops.size() - 1);
  const auto k = std::min(static_cast<std::size_t>(at), stops.size() - 2);
  std::array<double, 3> colour{};
  for (int c = 0; c < 3; ++c)
    colour[c] = stops[k][c] + (at - static_cast<double>(k)) * (stops[k + 1][c] - stops[k][c]);
  return colour;
}

/// Right, up, and away from the eye, in pixels.
class Camera {
 public:
  Camera(const BedPicture& bed, const View& view)
      : middle_(0.5 * (bed.low + bed.high)),
        turn_{std::cos(view.turn_rad), std::sin(view.turn_rad)},
        tilt_{std::cos(view.tilt_rad), std::sin(view.tilt_rad)},
        centre_{0.5 * view.width, 0.5 * view.height} {
    double across = 1e-300, up = 1e-300;
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 p = seen({corner & 1 ? bed.high.x : bed.low.x, corner & 2 ? bed.high.y : bed.low.y,
                           corner & 4 ? bed.high.z : bed.low.z});
      across = std::max(across, std::abs(p.x));
      up = std::max(up, std::abs(p.y));
    }
    scale_ = margin * std::min(centre_[0] / across, centre_[1] / up);
  }
  Vec3 operator()(const Vec3& p) const {
    const Vec3 s = seen(p);
    return {centre_[0] + scale_ * s.x, centre_[1] - scale_ * s.y, scale_ * s.z};
  }
  double scale() const { return scale_; }

 private:
  Vec3 seen(const Vec3& p) const {
    const Vec3 d = p - middle_;
    const double deep = -turn_[1] * d.x + turn_[0] * d.y;
    return {turn_[0] * d.x + turn_[1] * d.y, tilt_[0] * d.z + tilt_[1] * deep,
            tilt_[0] * deep - tilt_[1] * d.z};
  }
  Vec3 middle_;
  std::array<double, 2> turn_, tilt_, centre_;
  double scale_ = 1;
};

class Canvas {
 public:
  Canvas(int width, int height)
      : image_{width, height, std::vector<std::uint8_t>(static_cast<std::size_t>(3) * width * height, 255)},
        depth_(static_cast<std::size_t>(width) * height, infinity) {}

  void sphere(const Vec3& at, double r, const std::array<double, 3>& colour) {
    for (int y = std::max(0, static_cast<int>(at.y - r));
         y <= std::min(image_.height - 1, static_cast<int>(at.y + r)); ++y)
      for (int x = std::max(0, static_cast<int>(at.x - r));
           x <= std::min(image_.width - 1, static_cast<int>(at.x + r)); ++x) {
        const double dx = (x + 0.5 - at.x) / r, dy = (y + 0.5 - at.y) / r, rest = 1 - dx * dx - dy * dy;
        if (rest < 0) continue;
        const double towards = std::sqrt(rest),
                     light = 0.45 + 0.65 * std::max(0.0, -0.35 * dx - 0.45 * dy + 0.82 * towards);
        std::array<std::uint8_t, 3> shade{};
        for (int c = 0; c < 3; ++c)
          shade[c] = static_cast<std::uint8_t>(std::clamp(light * colour[c], 0.0, 255.0));
        put(x, y, at.z - r * towards, shade);
      }
  }

  void line(const Vec3& a, const Vec3& b) {
    const int steps = static_cast<int>(std::ceil(std::max({std::abs(b.x - a.x), std::abs(b.y - a.y), 1.0})));
    for (int k = 0; k <= steps; ++k) {
      const Vec3 p = a + (static_cast<double>(k) / steps) * (b - a);
      const int x = static_cast<int>(std::floor(p.x)), y = static_cast<int>(std::floor(p.y));
      if (x >= 0 && y >= 0 && x < image_.width && y < image_.height) put(x, y, p.z, line_colour);
    }
  }
  Image take() { return std::move(image_); }

 private:
  void put(int x, int y, double depth, const std::array<std::uint8_t, 3>& colour) {
    const std::size_t at = static_cast<std::size_t>(y) * image_.width + x;
    if (depth >= depth_[at]) return;
    depth_[at] = depth;
    std::copy(colour.begin(), colour.end(), image_.rgb.begin() + static_cast<std::ptrdiff_t>(3 * at));
  }
  Image image_;
  std::vector<double> depth_;
};

}  // namespace

Image bed_image(const BedPicture& bed, const View& view) {
  const Camera camera(bed, view);
  Canvas canvas(view.width, view.height);
  const double range = view.to > view.from ? view.to - view.from : 1;
  const auto& values = bed.columns.at(0).second;
  for (std::size_t i = 0; i < bed.position_m.size(); ++i)
    canvas.sphere(camera(bed.position_m[i]), std::max(0.7, camera.scale() * bed.radius_m[i]),
                  heat_colour((values[i] - view.from) / range));
  for (const auto& wall : bed.walls)
    for (std::size_t k = 0; k < wall.size(); ++k)
      canvas.line(camera(wall[k]), camera(wall[(k + 1) % wall.size()]));
  return canvas.take();
}

void write_png(const std::filesystem::path& file, const Image& image) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = static_cast<png_uint_32>(image.width);
  png.height = static_cast<png_uint_32>(image.height);
  png.format = PNG_FORMAT_RGB;
  if (!png_image_write_to_file(&png, file.c_str(), 0, image.rgb.data(), 0, nullptr))
    throw IoError(fmt::format("{}: cannot be written: {}", file.string(), png.message));
}

}  // namespace granrad

// A picture of a bed shows each sphere where it is, as large as it is, in the colour of its value, the nearer one in front.
#include "dem/page/bed_image.h"

#include <gtest/gtest.h>

#include "dem/base/constants.h"
#include "dem/base/error.h"
#include "tests/temporary_folder.h"

namespace granrad {
namespace {

/// Seen straight along y: x to the right, z up; the box fills 0.94 of the picture.
const View view{.width = 400, .height = 400, .turn_rad = 0, .tilt_rad = 0, .from = 0, .to = 1};

BedPicture bed_of(std::vector<Vec3> at, std::vector<double> radius, std::vector<double> value) {
  return {.position_m = std::move(at),
          .radius_m = std::move(radius),
          .columns = {{"T, K", std::move(value)}},
          .walls = {},
          .low = {0, 0, 0},
          .high = {1, 1, 1}};
}

bool is_white(const Image& image, int x, int y) {
  const auto* p = &image.rgb[3 * (static_cast<std::size_t>(y) * image.width + x)];
  return p[0] == 255 && p[1] == 255 && p[2] == 255;
}

TEST(BedImage, ASphereCoversItsDisc) {
  const Image image = bed_image(bed_of({{0.25, 0.5, 0.75}}, {0.1}, {0.5}), view);
  double covered = 0, x_sum = 0, y_sum = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      if (!is_white(image, x, y)) covered += 1, x_sum += x + 0.5, y_sum += y + 0.5;
  const double scale = 0.94 * 400, r = 0.1 * scale;
  EXPECT_NEAR(covered, pi * r * r, 0.02 * pi * r * r);
  EXPECT_NEAR(x_sum / covered, 200 - 0.25 * scale, 0.5);
  EXPECT_NEAR(y_sum / covered, 200 - 0.25 * scale, 0.5);  // up is up
}

TEST(BedImage, TheNearerSphereIsInFrontWhateverTheOrder) {
  for (const bool first : {true, false}) {
    const Vec3 near{0.5, 0.2, 0.5}, far{0.5, 0.8, 0.5};
    const Image image = bed_image(
        first ? bed_of({near, far}, {0.1, 0.1}, {1, 0}) : bed_of({far, near}, {0.1, 0.1}, {0, 1}), view);
    const auto* p = &image.rgb[3 * (200u * 400u + 200u)];
    EXPECT_GT(p[0] + p[1], 2 * p[2]);  // yellow, not dark blue
  }
}

TEST(BedImage, IsWrittenOrSaysWhyNot) {
  const TemporaryFolder folder;
  const Image image = bed_image(bed_of({{0.5, 0.5, 0.5}}, {0.1}, {0.5}), view);
  write_png(folder / "bed.png", image);
  EXPECT_GT(std::filesystem::file_size(folder / "bed.png"), 500u);
  EXPECT_THROW(write_png("/proc/granrad/bed.png", image), IoError);
}

}  // namespace
}  // namespace granrad

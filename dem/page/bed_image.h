#pragma once
#include <cstdint>
#include <filesystem>
#include <vector>

#include "dem/page/html_report.h"

namespace granrad {

/// Red, green, blue of each pixel, row by row from the top.
struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;
};

/// From where and how a bed is seen; the defaults are those of the page.
struct View {
  int width = 900, height = 1200;
  double turn_rad = 0.55, tilt_rad = 0.18;  ///< about the vertical axis, then down
  double from = 0, to = 1;                  ///< values of the darkest and the brightest colour
};

/// The bed as shaded spheres coloured by its first column, with the outlines of the walls before and behind.
Image bed_image(const BedPicture& bed, const View& view);

/// Throws IoError.
void write_png(const std::filesystem::path& file, const Image& image);

}  // namespace granrad

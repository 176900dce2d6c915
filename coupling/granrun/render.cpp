#include "coupling/granrun/render.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstdio>
#include <utility>

#include "coupling/simulation/case_folder.h"
#include "dem/base/constants.h"
#include "dem/base/error.h"
#include "dem/base/program.h"
#include "dem/io/snapshot.h"
#include "dem/page/bed_image.h"

namespace granrad {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t most_outlines = 4000;  ///< of triangles, more would hide the bed

std::vector<std::vector<Vec3>> outlines(const Bed& bed) {
  std::vector<std::vector<Vec3>> all;
  for (const Wall& wall : bed.walls) {
    if (wall.triangles.empty()) all.push_back(wall.vertices);
    if (all.size() + wall.triangles.size() > most_outlines) continue;
    for (const auto& t : wall.triangles)
      all.push_back({wall.vertices[t[0]], wall.vertices[t[1]], wall.vertices[t[2]]});
  }
  return all;
}

/// A single quote ends the quoting, and comes back escaped.
std::string quoted(const std::string& text) {
  std::string inside;
  for (const char c : text) inside += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return fmt::format("'{}'", inside);
}

/// Frames as raw pixels into ffmpeg.
class Film {
 public:
  Film(const fs::path& file, const View& view)
      : pipe_(
            popen(fmt::format(
                      "ffmpeg -v error -y -f rawvideo -pix_fmt rgb24 -s {}x{} -r 25 -i - -pix_fmt yuv420p {}",
                      view.width, view.height, quoted(file.string()))
                      .c_str(),
                  "w")) {
    if (!pipe_) throw IoError(advised("ffmpeg cannot be started", "install ffmpeg, or render a .png"));
  }
  ~Film() {
    if (pipe_) pclose(pipe_);
  }
  Film(const Film&) = delete;
  Film& operator=(const Film&) = delete;

  void add(const Image& image) {
    if (std::fwrite(image.rgb.data(), 1, image.rgb.size(), pipe_) != image.rgb.size()) fail();
  }
  void end() {
    FILE* pipe = std::exchange(pipe_, nullptr);
    if (pclose(pipe) != 0) fail();
  }

 private:
  [[noreturn]] static void fail() {
    throw IoError(
        advised("ffmpeg did not write the film", "install ffmpeg (its message is above), or render a .png"));
  }
  FILE* pipe_;
};

/// The colours of the first column: from the 0.5th to the 99.5th percentile of all frames.
void set_scale(View& view, const std::vector<BedPicture>& pictures) {
  std::vector<double> all;
  for (const auto& picture : pictures)
    all.insert(all.end(), picture.columns[0].second.begin(), picture.columns[0].second.end());
  if (all.empty()) return;
  const auto at = [&](double share) {
    const auto nth = all.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(all.size() - 1));
    std::nth_element(all.begin(), nth, all.end());
    return *nth;
  };
  view.from = at(0.005);
  view.to = at(0.995);
}

}  // namespace

BedPicture bed_picture(const Bed& bed) {
  BedPicture shown{.position_m = bed.position_m,
                   .radius_m = bed.radius_m,
                   .columns = {{"T, K", bed.temperature_K}},
                   .walls = outlines(bed),
                   .low = bed.box.min,
                   .high = bed.box.max};
  const auto received = [](double q) { return q != 0; };
  if (std::any_of(bed.radiative_heat_W.begin(), bed.radiative_heat_W.end(), received)) {
    std::vector<double> flux(bed.size());
    for (std::size_t i = 0; i < bed.size(); ++i)
      flux[i] = bed.radiative_heat_W[i] / (4 * pi * bed.radius_m[i] * bed.radius_m[i]);
    shown.columns.emplace_back("radiative flux received, W/m²", std::move(flux));
  }
  return shown;
}

int render_case(const fs::path& where, const fs::path& file, const RunOptions& options) {
  const bool film = file.extension() == ".mp4";
  if (!film && file.extension() != ".png")
    throw InputError(
        advised(fmt::format("-o {} (is neither .png nor .mp4)", file.string()), "name one of them"));
  const auto frames = CaseFolder(where).frames();
  if (frames.empty())
    throw InputError(advised(fmt::format("{} (has no frames yet)", where.string()), "wait for the first"));
  std::vector<BedPicture> pictures;
  for (std::size_t k = film ? 0 : frames.size() - 1; k < frames.size(); ++k)
    pictures.push_back(bed_picture(read_frame(frames[k].file).bed));
  View view;
  set_scale(view, pictures);
  if (!film) {
    write_png(file, bed_image(pictures.back(), view));
  } else {
    Film out(file, view);
    Progress progress("render", static_cast<double>(pictures.size()), options.quiet());
    for (std::size_t k = 0; k < pictures.size(); ++k) {
      out.add(bed_image(pictures[k], view));
      progress.update(static_cast<double>(k + 1));
    }
    out.end();
    progress.finish();
  }
  if (!options.quiet())
    fmt::print("{}: {}, {:.4g} (dark) to {:.4g} (bright)\n", file.string(), pictures.back().columns[0].first,
               view.from, view.to);
  return exit_ok;
}

}  // namespace granrad

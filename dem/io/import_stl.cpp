#include "dem/io/import_stl.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <map>
#include <tuple>

#include "dem/base/error.h"
#include "dem/base/text_lines.h"

namespace granrad {

namespace {

/// A triangle whose area is below this part of the squared size of its solid has no usable normal.
constexpr double no_area = 1e-12;
constexpr std::size_t binary_head = 84, binary_facet = 50;  // bytes; the head ends with the number of facets

/// As it stands in the file: three corners a triangle.
struct Solid {
  std::string name;
  std::vector<Vec3> corners;
};

std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in || !std::filesystem::is_regular_file(file))
    throw IoError(fmt::format("{}: cannot be read", file.string()));
  return {std::istreambuf_iterator<char>(in), {}};
}

bool is_binary(const std::string& bytes) {
  if (bytes.size() < binary_head) return false;
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + binary_head - sizeof count, sizeof count);
  return bytes.size() == binary_head + binary_facet * count;
}

Solid read_binary(const std::string& bytes) {
  Solid solid;
  for (std::size_t at = binary_head; at < bytes.size(); at += binary_facet) {
    float facet[12];  // normal, then corners
    std::memcpy(facet, bytes.data() + at, sizeof facet);
    for (int corner = 3; corner < 12; corner += 3)
      solid.corners.push_back({facet[corner], facet[corner + 1], facet[corner + 2]});
  }
  return solid;
}

class TextReader {
 public:
  explicit TextReader(const std::filesystem::path& file) : file_(file.string()), lines_(file) {}

  std::vector<Solid> read() {
    std::string_view line;
    while (lines_.next(line)) {
      split_words(line, words_);
      if (!words_.empty()) take(lower(words_[0]));
    }
    if (open_) fail("the file ends inside a solid (it is cut short)");
    return std::move(solids_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("{}:{}: {}", file_, lines_.line_number(), what));
  }
  static std::string lower(std::string_view word) {
    std::string text(word);
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
    return text;
  }

  void take(const std::string& keyword) {
    if (keyword == "solid") {
      solids_.push_back({words_.size() > 1 ? std::string(words_[1]) : "", {}});
      open_ = true;
    } else if (!open_) {
      fail("is not an STL file (a text file starts with \"solid\"; a binary one must be whole)");
    } else if (keyword == "vertex") {
      solids_.back().corners.push_back(vertex());
    } else if (keyword == "endfacet") {
      if (solids_.back().corners.size() % 3 != 0) fail("a facet must have three vertices");
    } else if (keyword == "endsolid") {
      open_ = false;
    } else if (keyword != "facet" && keyword != "outer" && keyword != "endloop") {
      fail("is not a line of an STL file");
    }
  }

  Vec3 vertex() const {
    Vec3 v;
    if (words_.size() != 4) fail("a vertex must be three numbers");
    for (int axis = 0; axis < 3; ++axis) {
      std::string_view text = words_[axis + 1];
      if (text.starts_with('+')) text.remove_prefix(1);
      const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), v[axis]);
      if (failure != std::errc{} || end != text.data() + text.size() || !std::isfinite(v[axis]))
        fail(fmt::format("vertex coordinate = {} (must be a finite number)", words_[axis + 1]));
    }
    return v;
  }

  std::string file_;
  TextLines lines_;
  std::vector<std::string_view> words_;
  std::vector<Solid> solids_;
  bool open_ = false;
};

/// Corners that agree in single precision, measured from the first, are one vertex: programs write the same
/// corner with different last digits.
Wall merged(const Solid& solid, double scale) {
  Wall wall;
  std::map<std::tuple<float, float, float>, std::int32_t> known;
  const auto index_of = [&](const Vec3& corner) {
    const Vec3 from_first = corner - solid.corners[0];
    const std::tuple key(static_cast<float>(from_first.x), static_cast<float>(from_first.y),
                         static_cast<float>(from_first.z));
    const auto [at, is_new] = known.emplace(key, static_cast<std::int32_t>(known.size()));
    if (is_new) wall.vertices.push_back(scale * corner);
    return at->second;
  };
  for (std::size_t k = 0; k + 2 < solid.corners.size(); k += 3) {
    const auto a = index_of(solid.corners[k]), b = index_of(solid.corners[k + 1]);
    wall.triangles.push_back({a, b, index_of(solid.corners[k + 2])});
  }
  return wall;
}

void check(const Wall& wall, const std::string& file) {
  double size_squared = 0;
  for (const auto& v : wall.vertices) {
    if (!is_finite(v)) throw InputError(fmt::format("{}: a vertex is not finite", file));
    const Vec3 diagonal = v - wall.vertices[0];
    size_squared = std::max(size_squared, dot(diagonal, diagonal));
  }
  std::size_t bad = 0, first = 0;
  for (std::size_t t = 0; t < wall.triangles.size(); ++t) {
    const auto& [a, b, c] = wall.triangles[t];
    const Vec3 twice_area = cross(wall.vertices[b] - wall.vertices[a], wall.vertices[c] - wall.vertices[a]);
    if (norm(twice_area) <= no_area * size_squared && bad++ == 0) first = t + 1;
  }
  if (bad > 0)
    throw InputError(
        fmt::format("{}: {} of {} triangles have no area, first number {} (their normal is undefined); "
                    "remove them in the program that wrote the file",
                    file, bad, wall.triangles.size(), first));
}

}  // namespace

std::vector<Wall> import_stl(const std::filesystem::path& file, double scale, const std::string& name) {
  const std::string bytes = bytes_of(file);
  std::vector<Solid> solids = is_binary(bytes) ? std::vector{read_binary(bytes)} : TextReader(file).read();
  std::erase_if(solids, [](const Solid& solid) { return solid.corners.empty(); });
  if (solids.empty()) throw InputError(fmt::format("{}: has no triangles", file.string()));
  std::vector<Wall> walls;
  for (const Solid& solid : solids) {
    Wall wall = merged(solid, scale);
    check(wall, file.string());
    wall.name = solids.size() == 1
                    ? name
                    : fmt::format("{}.{}", name,
                                  solid.name.empty() ? fmt::format("{}", walls.size() + 1) : solid.name);
    walls.push_back(std::move(wall));
  }
  return walls;
}

}  // namespace granrad

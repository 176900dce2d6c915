#include "dem/scene/import_stl.h"

#include <assimp/scene.h>
#include <fmt/core.h>

#include <assimp/Importer.hpp>
#include <charconv>
#include <cmath>
#include <fstream>
#include <map>
#include <tuple>

#include "dem/scene/error.h"
#include "dem/scene/text_lines.h"

namespace granrad {

namespace {

/// A triangle whose area is below this part of the squared size of its solid has no usable normal.
constexpr double no_area = 1e-12;

Wall merged(const aiMesh& mesh, double scale) {
  Wall wall;
  std::map<std::tuple<float, float, float>, std::int32_t> known;
  const auto index_of = [&](const aiVector3D& v) {
    const auto [at, is_new] =
        known.emplace(std::tuple(v.x, v.y, v.z), static_cast<std::int32_t>(known.size()));
    if (is_new) wall.vertices.push_back(scale * Vec3{v.x, v.y, v.z});
    return at->second;
  };
  for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
    const aiFace& face = mesh.mFaces[f];
    if (face.mNumIndices != 3) continue;
    wall.triangles.push_back({index_of(mesh.mVertices[face.mIndices[0]]),
                              index_of(mesh.mVertices[face.mIndices[1]]),
                              index_of(mesh.mVertices[face.mIndices[2]])});
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

/// Assimp reads a word such as nan as 0: every vertex of an ASCII file must be three finite numbers.
void refuse_words_for_numbers(const std::filesystem::path& file) {
  TextLines lines(file);
  std::string_view line;
  std::vector<std::string_view> words;
  while (lines.next(line)) {
    if (!line.starts_with("vertex ")) continue;
    split_words(line, words);
    for (std::size_t k = 1; k < words.size(); ++k) {
      std::string_view text = words[k];
      if (text.starts_with('+')) text.remove_prefix(1);
      double value = 0;
      const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
      if (failure != std::errc{} || end != text.data() + text.size() || !std::isfinite(value))
        throw InputError(fmt::format("{}:{}: vertex coordinate = {} (must be a finite number)", file.string(),
                                     lines.line_number(), words[k]));
    }
  }
}

/// Names of the meshes: those of the nodes that hold them.
std::map<unsigned, std::string> solid_names(const aiNode& node) {
  std::map<unsigned, std::string> names;
  for (unsigned m = 0; m < node.mNumMeshes; ++m) names[node.mMeshes[m]] = node.mName.C_Str();
  for (unsigned c = 0; c < node.mNumChildren; ++c)
    for (auto& [mesh, name] : solid_names(*node.mChildren[c])) names[mesh] = name;
  return names;
}

}  // namespace

std::vector<Wall> import_stl(const std::filesystem::path& file, double scale, const std::string& name) {
  if (!std::filesystem::is_regular_file(file) || !std::ifstream(file))
    throw IoError(fmt::format("{}: cannot be read", file.string()));
  Assimp::Importer importer;
  if (file.extension() != ".stl" && file.extension() != ".STL")
    throw InputError(fmt::format("{}: is not an STL file (its name must end in .stl)", file.string()));
  const aiScene* scene = importer.ReadFile(file.string(), 0);
  if (!scene || scene->mNumMeshes == 0)
    throw InputError(fmt::format("{}: is not an STL file ({})", file.string(),
                                 scene ? "no triangles" : importer.GetErrorString()));
  refuse_words_for_numbers(file);
  const auto names = solid_names(*scene->mRootNode);
  std::vector<Wall> walls;
  for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
    Wall wall = merged(*scene->mMeshes[m], scale);
    if (wall.triangles.empty()) continue;
    check(wall, file.string());
    const auto solid = names.find(m);
    const bool named = solid != names.end() && !solid->second.empty();
    wall.name = scene->mNumMeshes == 1
                    ? name
                    : fmt::format("{}.{}", name, named ? solid->second : fmt::format("{}", m + 1));
    walls.push_back(std::move(wall));
  }
  if (walls.empty()) throw InputError(fmt::format("{}: has no triangles", file.string()));
  return walls;
}

}  // namespace granrad

// Requirement: includes follow the arrows of ARCHITECTURE.md, and each third-party header stays where it
// belongs.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;
const fs::path source_dir = GRANRAD_SOURCE_DIR;
const std::vector<std::string> rooms = {"dem", "raytrace", "fit", "coupling"};

struct Include {
  std::string file;    ///< that includes, relative to the project
  std::string header;  ///< as written
};

std::vector<Include> all_includes() {
  static const std::regex pattern(R"(^\s*#\s*include\s*[<"]([^>"]+)[>"])");
  std::vector<Include> found;
  for (const auto& room : rooms)
    for (const auto& entry : fs::recursive_directory_iterator(source_dir / room)) {
      const auto extension = entry.path().extension();
      if (extension != ".h" && extension != ".cpp" && extension != ".inc") continue;
      std::ifstream in(entry.path());
      std::smatch match;
      for (std::string line; std::getline(in, line);)
        if (std::regex_search(line, match, pattern))
          found.push_back({fs::relative(entry.path(), source_dir).string(), match[1]});
    }
  return found;
}

bool starts_with_any(const std::string& text, const std::vector<std::string>& prefixes) {
  return std::any_of(prefixes.begin(), prefixes.end(), [&](const auto& p) { return text.starts_with(p); });
}

/// What the files below a path may include; the longest matching path decides.
const std::map<std::string, std::vector<std::string>> arrows = {
    {"dem/scene/", {"dem/scene/"}},
    {"dem/", {"dem/"}},
    {"raytrace/", {"raytrace/", "dem/scene/", "dem/near_pairs.h"}},
    {"fit/", {"fit/", "raytrace/", "dem/scene/", "dem/near_pairs.h", "dem/packing.h"}},
    {"coupling/", {"coupling/", "fit/", "raytrace/", "dem/"}},
};

std::string matching_arrow(const std::string& file) {
  std::string best;
  for (const auto& [path, allowed] : arrows)
    if (file.starts_with(path) && path.size() > best.size()) best = path;
  return best;
}

TEST(Layering, IncludesFollowTheArrows) {
  const auto includes = all_includes();
  ASSERT_GT(includes.size(), 100u) << "no sources found below " << source_dir;
  for (const auto& include : includes) {
    if (!starts_with_any(include.header, {"dem/", "raytrace/", "fit/", "coupling/"})) continue;
    const auto arrow = matching_arrow(include.file);
    ASSERT_FALSE(arrow.empty()) << include.file;
    EXPECT_TRUE(starts_with_any(include.header, arrows.at(arrow)))
        << include.file << " includes " << include.header << ", against the arrows of " << arrow;
  }
}

TEST(Layering, OwnHeadersAreIncludedFromTheRoot) {
  for (const auto& include : all_includes()) {
    if (!include.header.ends_with(".h") || include.header.find('/') != std::string::npos) continue;
    EXPECT_FALSE(fs::exists((source_dir / include.file).parent_path() / include.header))
        << include.file << " includes " << include.header << " without its path";
  }
}

TEST(Layering, ThirdPartyHeadersStayInTheirFile) {
  const std::map<std::string, std::vector<std::string>> homes = {
      {"embree3/", {"raytrace/embree_tracer.cpp"}},
      {"ceres/", {"fit/least_squares.cpp"}},
      {"toml++/", {"dem/scene/toml_reader.cpp"}},
      {"udunits2", {"dem/scene/units.cpp", "dem/scene/toml_reader.cpp"}},
      {"hdf5",
       {"dem/scene/hdf5_file", "dem/scene/frame", "dem/scene/snapshot.cpp", "raytrace/view_factor_file.cpp"}},
      {"Random123/", {"dem/scene/random.cpp"}},
      {"liggghts/", {"dem/liggghts/session.cpp"}},
      {"mpi.h", {"dem/liggghts/session.cpp"}},
      {"Eigen/", {"coupling/radiosity", "coupling/harmonic_radiosity", "fit/least_squares.cpp"}},
  };
  for (const auto& include : all_includes())
    for (const auto& [prefix, files] : homes) {
      if (!include.header.starts_with(prefix)) continue;
      EXPECT_TRUE(starts_with_any(include.file, files)) << include.file << " includes " << include.header;
    }
}

TEST(Layering, NoOtherFolderHoldsCode) {
  for (const auto& entry : fs::directory_iterator(source_dir)) {
    const std::string name = entry.path().filename();
    if (!entry.is_directory() || name.starts_with('.') || name.starts_with("build") || name == "out")
      continue;
    EXPECT_TRUE(starts_with_any(name, {"dem", "raytrace", "fit", "coupling", "data", "tests"})) << name;
  }
}

}  // namespace

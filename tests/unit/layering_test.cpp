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

#include "tests/source_dir.h"

namespace {

namespace fs = std::filesystem;
const fs::path source_dir = granrad::source_dir();
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

/// What the files of a folder may include beside their own: the arrows of ARCHITECTURE.md. The longest matching
/// path decides.
const std::map<std::string, std::vector<std::string>> arrows = [] {
  using Folders = std::vector<std::string>;
  const auto join = [](std::initializer_list<Folders> parts) {
    Folders all;
    for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
    return all;
  };
  const Folders ranks = {"dem/ranks/ranks.h"};
  const Folders base = {"dem/base/"}, bed = join({base, {"dem/bed/"}}), io = join({bed, {"dem/io/"}});
  const Folders cover = join({bed, {"dem/cover/"}});
  const Folders mesh = join({bed, {"dem/mesh/"}});
  const Folders scene = join({io, cover, mesh, {"dem/scene/"}}), packing = join({bed, {"dem/packing/"}});
  const Folders engine = join({scene, {"dem/engine.h", "dem/step_clock.h", "dem/step_limit.h"}});
  const Folders enclosure =
      join({bed,
            ranks,
            {"raytrace/balancing.h", "raytrace/conjugate_gradients.h", "raytrace/enclosure.h",
             "raytrace/exact.h", "raytrace/exchange.h", "raytrace/exchange_source.h", "raytrace/facets.h",
             "raytrace/mesh_check.h", "raytrace/morton.h", "raytrace/same_geometry.h",
             "raytrace/stated_error.h", "raytrace/unobstructed_pair.h", "raytrace/wall_patches.h"}});
  const Folders embree = join({enclosure, {"raytrace/embree/"}}),
                rays = join({embree, cover, {"raytrace/rays/"}});
  const Folders line_pass = join({embree, {"raytrace/line_pass/"}});
  const Folders lines = join({rays, line_pass, {"raytrace/lines/"}}),
                paths = join({rays, {"raytrace/paths/"}});
  const Folders shading = join({rays, {"raytrace/shading/"}});
  const Folders slab = join({rays, {"raytrace/slab/"}});
  const Folders correlation = join({rays, {"fit/correlation/"}});
  const Folders fitting = join({correlation, {"dem/page/", "fit/fitting/"}});
  const Folders trace = join({fitting, lines, io, mesh, {"fit/trace/"}});
  const Folders generate = join({trace, packing, {"fit/generate/"}});
  const Folders heat = join({lines, {"dem/io/", "coupling/heat/"}});
  const Folders simulation = join({heat,
                                   correlation,
                                   paths,
                                   shading,
                                   engine,
                                   {"dem/feed/feed.h", "dem/engine_native.h", "dem/engine_liggghts.h",
                                    "dem/engine_replay.h", "coupling/simulation/"}});
  const Folders results = join({simulation, {"coupling/results/"}});
  const Folders validate =
      join({simulation, {"dem/page/", "coupling/granrun/run_options.h", "coupling/validate/"}});
  const Folders forecast = join({validate, {"coupling/forecast/"}});
  const Folders granrun = join({results, forecast, {"coupling/granrun/"}});
  return std::map<std::string, Folders>{
      {"dem/", engine},
      {"dem/base/", {"dem/base/"}},
      {"dem/base/files/", {"dem/base/error.h", "dem/base/vec3.h", "dem/base/files/"}},
      {"dem/base/toml/", base},
      {"dem/ranks/", join({base, {"dem/ranks/"}})},
      {"dem/page/", join({base, {"dem/page/"}})},
      {"dem/bed/", bed},
      {"dem/cover/", cover},
      {"dem/io/", io},
      {"dem/mesh/", mesh},
      {"dem/scene/", scene},
      {"dem/packing/", packing},
      {"dem/feed/", join({scene, packing, {"dem/feed/"}})},
      {"dem/native/", join({engine, {"dem/engine_native.h", "dem/native/"}})},
      {"dem/replay/", join({engine, {"dem/engine_replay.h", "dem/replay/"}})},
      {"dem/liggghts/", join({engine, ranks, {"dem/engine_liggghts.h", "dem/liggghts/"}})},
      {"raytrace/", enclosure},
      {"raytrace/embree/", embree},
      {"raytrace/rays/", rays},
      {"raytrace/line_pass/", line_pass},
      {"raytrace/lines/", lines},
      {"raytrace/paths/", paths},
      {"raytrace/shading/", shading},
      {"raytrace/slab/", slab},
      {"fit/correlation/", correlation},
      {"fit/fitting/", fitting},
      {"fit/trace/", trace},
      {"fit/generate/", generate},
      {"fit/vfgen/", join({generate, slab, {"fit/vfgen/"}})},
      {"coupling/heat/", heat},
      {"coupling/simulation/", simulation},
      {"coupling/results/", results},
      {"coupling/validate/", validate},
      {"coupling/forecast/", forecast},
      {"coupling/granrun/", granrun},
      {"coupling/granrun/granrun.cpp",
       join({granrun, {"coupling/measure/measure_command.h", "coupling/study/run_study.h"}})},
      {"coupling/measure/",
       join({simulation, slab, {"dem/page/", "coupling/granrun/run_options.h", "coupling/measure/"}})},
      {"coupling/study/", join({granrun, {"coupling/study/"}})},
  };
}();

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

// The bottom of the house is a folder of its own: what lies below it in the tree lies above it in the arrows.
TEST(Layering, BaseIncludesOnlyItself) {
  for (const auto& include : all_includes())
    if (fs::path(include.file).parent_path() == "dem/base" && include.header.starts_with("dem/")) {
      EXPECT_EQ(fs::path(include.header).parent_path(), "dem/base") << include.file;
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
      {"embree3/", {"raytrace/embree/embree_tree.cpp"}},
      {"embree4/", {"raytrace/embree/embree_tree.cpp"}},
      {"ceres/", {"fit/fitting/least_squares.cpp", "fit/fitting/curve_fit.cpp"}},
      {"muParser", {"coupling/study/formula.cpp"}},
      {"toml++/", {"dem/base/toml/toml_reader_state.h"}},
      {"udunits2", {"dem/base/units.cpp"}},
      {"hdf5",
       {"dem/base/files/hdf5_handle.h", "dem/io/frame", "dem/io/snapshot.cpp",
        "raytrace/rays/view_factor_file.cpp"}},
      {"Random123/", {"dem/base/random.cpp"}},
      {"boost/hana/", {"dem/io/saved_state.h"}},
      {"zlib.h", {"dem/base/files/file_bytes.cpp"}},
      {"zip.h", {"dem/base/files/npz_file.cpp"}},
      {"pugixml", {"dem/io/import_vtk_xml.cpp"}},
      {"liggghts/", {"dem/liggghts/histories.cpp", "dem/liggghts/refusal.cpp", "dem/liggghts/session.cpp"}},
      {"mpi.h", {"dem/ranks/mpi_group.cpp", "dem/liggghts/session.cpp", "dem/liggghts/world.cpp"}},
      {"Eigen/",
       {"coupling/heat/radiosity", "raytrace/slab/steady_network.cpp", "coupling/heat/harmonic_radiosity",
        "fit/fitting/least_squares.cpp"}},
  };
  for (const auto& include : all_includes())
    for (const auto& [prefix, files] : homes) {
      if (!include.header.starts_with(prefix)) continue;
      EXPECT_TRUE(starts_with_any(include.file, files)) << include.file << " includes " << include.header;
    }
}

// Messages read "cause; advice": in no literal does advice follow a closed reason without the semicolon.
TEST(Layering, CauseAndAdviceAreJoinedByASemicolon) {
  static const std::regex glued(
      R"("[^"]*\) (try|use|add|make|give|choose|set|remove|raise|enlarge|check|sort|wait|install|lower|shorten)[ "])");
  std::size_t literals = 0;
  for (const auto& room : rooms)
    for (const auto& entry : fs::recursive_directory_iterator(source_dir / room)) {
      if (entry.path().extension() != ".cpp" && entry.path().extension() != ".h") continue;
      std::ifstream in(entry.path());
      std::size_t number = 0;
      for (std::string line; std::getline(in, line);) {
        ++number;
        if (line.find('"') == std::string::npos || line.find_first_not_of(' ') == line.find("//")) continue;
        ++literals;
        EXPECT_FALSE(std::regex_search(line, glued) && line.find(") try {") == std::string::npos)
            << entry.path() << ":" << number << ": join cause and advice by advised(): " << line;
      }
    }
  EXPECT_GT(literals, 1000u);
}

// Tests run side by side, one a process: a file of a fixed name in the folder all share is another test's as well.
// Temporary files stand in a TemporaryFolder. Planted: one test goes back to the shared folder.
TEST(Layering, TestsShareNoTemporaryFile) {
  static const std::regex shared(R"(\bTempDir\(|\btmpnam\(|"/tmp/)");
  for (const auto& entry : fs::recursive_directory_iterator(source_dir / "tests")) {
    if (entry.path().extension() != ".cpp" && entry.path().extension() != ".h") continue;
    if (entry.path().filename() == "layering_test.cpp") continue;
    std::ifstream in(entry.path());
    std::size_t number = 0;
    for (std::string line; std::getline(in, line);) {
      ++number;
      EXPECT_FALSE(std::regex_search(line, shared)) << entry.path() << ":" << number << ": " << line;
    }
  }
}

TEST(Layering, NoOtherFolderHoldsCode) {
  for (const auto& entry : fs::directory_iterator(source_dir)) {
    const std::string name = entry.path().filename();
    if (!entry.is_directory() || name.starts_with('.') || name.starts_with("build") || name == "out")
      continue;
    EXPECT_TRUE(starts_with_any(name, {"dem", "raytrace", "fit", "coupling", "data", "tests", "docs",
                                       "python", "cmake", "packaging"}))
        << name;
  }
}

}  // namespace

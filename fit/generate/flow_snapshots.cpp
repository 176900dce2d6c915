#include "fit/generate/flow_snapshots.h"

#include <fmt/format.h>
#include <glob.h>

#include <algorithm>

#include "dem/base/error.h"
#include "dem/base/files/text_file.h"
#include "dem/base/program.h"

namespace granrad {

namespace {

namespace fs = std::filesystem;

/// Paths that match a pattern beside a folder, in order.
std::vector<fs::path> matching(const fs::path& beside, const std::string& pattern) {
  glob_t found{};
  std::vector<fs::path> paths;
  if (glob((beside / pattern).c_str(), 0, nullptr, &found) == 0)
    for (std::size_t k = 0; k < found.gl_pathc; ++k) paths.emplace_back(found.gl_pathv[k]);
  globfree(&found);
  return paths;
}

std::vector<fs::path> read_patterns(TomlTable& table, const Key& key, const fs::path& beside) {
  std::vector<fs::path> all;
  if (!table.has(key.name)) return all;
  for (const auto& pattern : table.string_list(key, 1)) {
    const auto found = matching(beside, pattern);
    if (found.empty())
      table.problem(key.name, advised("\"" + pattern + "\" matches no file", "name what is there"));
    all.insert(all.end(), found.begin(), found.end());
  }
  return all;
}

/// Walls and radii of files that have none.
void read_enclosure_settings(TomlTable& table, EnclosureSettings& s) {
  if (table.has("walls"))
    for (const auto& text : table.string_list({"walls", "STL files of walls, FILE or FILE:SCALE"})) try {
        s.stl.push_back(parse_stl(text));
      } catch (const InputError& error) {
        table.problem("walls", error.what());
      }
  const Vec3 size = table.vec3({"box_size_m", "six black walls around files without walls"},
                               {.unit = "m", .min = 0}, Vec3{}),
             origin = table.vec3({"box_origin_m", "corner of that box"}, {.unit = "m"}, Vec3{});
  if (size.x > 0 && size.y > 0 && size.z > 0) s.box = Box{origin, origin + size};
  s.radius_m = table.number({"radius_m", "of files without radii"}, {.unit = "m", .min = 0}, 0);
}

FlowRow scene_row(const FlowSettings& s, const fs::path& scene, double solid_fraction,
                  const fs::path& folder) {
  FlowRow row;
  row.name = scene.stem().string();
  const std::string text = read_text_file(scene);
  const bool fed = text.find("[feed]") != std::string::npos;
  for (int seed = 1; seed <= s.seeds; ++seed) {
    FlowRun run;
    run.scene = scene;
    run.every_s = s.every_s;
    run.set = s.set;
    if (solid_fraction > 0) run.set.push_back(fmt::format("feed.solid_fraction={}", solid_fraction));
    if (fed) run.set.push_back(fmt::format("feed.seed={}", seed));
    std::string depends = text;
    for (const auto& assignment : run.set) depends += " " + assignment;
    const auto name = fmt::format("{}_{:02}_{:016x}", row.name, seed, text_hash(depends));
    run.folder =
        folder / "runs" / (solid_fraction > 0 ? fmt::format("phi_{:.4f}_{}", solid_fraction, name) : name);
    row.runs.push_back(run);
    if (!fed) break;  // nothing would differ
  }
  if (solid_fraction > 0) row.name += fmt::format(" at solid fraction {}", solid_fraction);
  return row;
}

void check_choice(TomlTable& table, const FlowSettings& s) {
  const int kinds = table.has("scene") + table.has("folders") + table.has("files");
  if (kinds != 1)
    table.problem(
        "scene",
        advised(fmt::format("{} of scene, folders and files are given (a row has one origin)", kinds),
                "give exactly one"));
  if (!s.solid_fractions.empty() && s.scenes.size() != 1)
    table.problem(
        "solid_fractions",
        advised(fmt::format("there are {} scenes (each solid fraction is a run of one)", s.scenes.size()),
                "name one scene, or leave solid_fractions out"));
  if (s.most_snapshots < s.snapshots)
    table.problem("most_snapshots", advised("fewer than snapshots", "ask for as many or more"));
}

}  // namespace

FlowSettings read_flow_settings(TomlTable table, const fs::path& beside) {
  FlowSettings s;
  if (!table.present()) return s;
  if (table.has("scene")) {
    s.scenes = matching(beside, table.string({"scene", "scenes to run, by * and ?; each is a row"}));
    if (s.scenes.empty()) table.problem("scene", advised("matches no file", "name a scene beside this file"));
  }
  s.folders = read_patterns(table, {"folders", "in place of scene: folders of runs, by * and ?"}, beside);
  std::erase_if(s.folders, [](const fs::path& path) { return !fs::is_directory(path); });  // logs beside them
  s.files = read_patterns(table, {"files", "in place of scene: snapshots, by * and ?"}, beside);
  if (table.has("solid_fractions"))
    s.solid_fractions = table.number_list({"solid_fractions", "of a plug: a row each"},
                                          {.unit = "1", .min = 0, .max = 0.6, .min_exclusive = true}, 1);
  if (table.has("set")) s.set = table.string_list({"set", "key=value for every run"});
  read_enclosure_settings(table, s.enclosure);
  s.seeds = static_cast<int>(table.integer({"seeds", "runs of each row"}, 1, 100, 2));
  s.snapshots = static_cast<int>(table.integer({"snapshots", "of each row, at least"}, 1, 1000, 4));
  s.most_snapshots =
      static_cast<int>(table.integer({"most_snapshots", "of each row"}, 1, 1000, std::max(16, s.snapshots)));
  s.start_s = table.number({"start_s", "flows are judged from here on"}, {.unit = "s", .min = 0}, 0);
  s.every_s = table.number({"every_s", "between history rows and frames of the runs"},
                           {.unit = "s", .min = 0, .min_exclusive = true}, 0.05);
  s.most_time_s = table.number({"most_time_s", "simulated time of a run, at most"},
                               {.unit = "s", .min = 0, .min_exclusive = true}, 20);
  s.curve_error =
      table.number({"curve_error", "sampling error wanted of mean F_pp at 1.5 < d* < 2.5, relative"},
                   {.unit = "1", .min = 0, .max = 1, .min_exclusive = true}, 0.01);
  check_choice(table, s);
  return s;
}

std::vector<FlowRow> flow_rows(const FlowSettings& settings, const fs::path& folder) {
  std::vector<FlowRow> rows;
  for (const auto& scene : settings.scenes) {
    if (settings.solid_fractions.empty()) rows.push_back(scene_row(settings, scene, 0, folder));
    for (const double phi : settings.solid_fractions) rows.push_back(scene_row(settings, scene, phi, folder));
  }
  for (const auto& run : settings.folders) {
    FlowRow row;
    row.name = run.filename().string();
    row.made = true;
    row.runs.emplace_back().folder = run;
    rows.push_back(row);
  }
  return rows;
}

namespace {

/// Snapshots of one run, which goes on until it is steady and has `count` of them. Empty when interrupted.
std::vector<fs::path> snapshots_of(const FlowRun& run, bool made, const FlowSettings& s, std::size_t count,
                                   int threads, const std::function<void(const std::string&)>& say) {
  double end_s = std::max(reached_s(run.folder), s.start_s + 12 * s.every_s);
  for (;;) {
    if (!made && !advance_to(run, end_s, threads)) return {};
    if (interrupt_signal()) return {};
    const auto steady = judge_steadiness(run.folder / "history.csv", s.start_s);
    const double reached = reached_s(run.folder);
    say(fmt::format("{} at {:.3g} s, {}", run.folder.filename().string(), reached,
                    steady.reached ? fmt::format("steady, residence time {:.3g} s", steady.residence_s)
                                   : "not steady yet"));
    if (steady.reached) {
      auto frames = spaced_frames(run.folder, steady, count);
      if (frames.size() >= count || made || !(steady.residence_s > 0) ||
          reached >= s.most_time_s * (1 - 1e-9))
        return frames;
    } else if (made || reached >= s.most_time_s * (1 - 1e-9)) {
      throw NumericalError(
          advised(fmt::format("{}: not steady after {:.3g} s (the solid fraction drifts by {:.2g} %)",
                              run.folder.string(), reached, 100 * steady.drift),
                  made ? "let the run go on, or set start_s" : "raise most_time_s, or set start_s"));
    }
    // Half of what is there is thrown away as the way to the steady state.
    const double wanted = s.start_s + 2 * steady.residence_s * (static_cast<double>(count) - 0.5);
    const double longer = s.start_s + 1.5 * (reached - s.start_s);
    end_s = std::min(s.most_time_s, steady.reached && wanted > reached ? wanted : longer);
    end_s = s.every_s * std::ceil(end_s / s.every_s - 1e-9);
  }
}

}  // namespace

std::vector<fs::path> take_snapshots(const FlowRow& row, const FlowSettings& settings, std::size_t count,
                                     int threads, const std::function<void(const std::string&)>& say) {
  const std::size_t each = (count + row.runs.size() - 1) / row.runs.size();
  std::vector<fs::path> all;
  for (const auto& run : row.runs) {
    const auto some = snapshots_of(run, row.made, settings, each, threads, say);
    if (interrupt_signal()) return {};
    all.insert(all.end(), some.begin(), some.end());
  }
  return all;
}

}  // namespace granrad

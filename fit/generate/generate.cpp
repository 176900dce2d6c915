#include "fit/generate/generate.h"

#include <fmt/core.h>

#include "dem/base/error.h"
#include "dem/base/toml/toml_reader.h"
#include "dem/packing/packing.h"
#include "raytrace/rays/view_factor_file.h"

namespace granrad {

namespace {

/// FNV-1a, 32 bits: enough to tell settings apart.
std::uint32_t fingerprint(const std::string& text) {
  std::uint32_t h = 2166136261u;
  for (const char c : text) h = (h ^ static_cast<unsigned char>(c)) * 16777619u;
  return h;
}

std::string snapshot_dependencies(const GenerateSettings& s) {
  return fmt::format("packing 1 {} {} {} {} {} {}", s.size_m.x, s.size_m.y, s.size_m.z, s.diameter_m,
                     s.sweeps, s.seed);
}

std::string trace_dependencies(const GenerateSettings& s) {
  return fmt::format("{} trace {} {} {} {}", snapshot_dependencies(s), view_factor_version,
                     to_string(s.trace.method), s.trace.rays, s.trace.seed);
}

std::string name_of(double solid_fraction, int number, const std::string& dependencies) {
  return fmt::format("phi_{:.4f}_{:02}_{:08x}", solid_fraction, number,
                     fingerprint(fmt::format("{} {} {}", dependencies, solid_fraction, number)));
}

void read_snapshot_settings(TomlTable table, GenerateSettings& s) {
  s.solid_fractions = table.number_list({"solid_fractions", "one row of the table each"},
                                        {.unit = "1",
                                         .min = 0,
                                         .max = 0.6,
                                         .min_exclusive = true,
                                         .why = "0.6 is the densest disordered packing"},
                                        1);
  s.size_m = table.vec3({"size_m", "lengths of the box that is filled"},
                        {.unit = "m", .min = 0, .min_exclusive = true});
  s.diameter_m =
      table.number({"diameter_m", "diameter of the spheres"}, {.unit = "m", .min = 0, .min_exclusive = true});
  for (int axis = 0; axis < 3; ++axis)
    if (s.size_m[axis] > 0 && s.diameter_m > 0.5 * s.size_m[axis])
      table.problem("diameter_m", advised(fmt::format("{} (the box is {} wide in {}: at least two diameters)",
                                                      s.diameter_m, s.size_m[axis], "xyz"[axis]),
                                          "enlarge size_m"));
  s.count = static_cast<int>(table.integer({"count", "beds per solid fraction"}, 1, 1000, 1));
  s.sweeps = static_cast<int>(
      table.integer({"sweeps", "moves tried per sphere before a bed counts as random"}, 0, 1000000, 100));
  s.seed = static_cast<std::uint64_t>(
      table.integer({"seed", "of the beds and the rays"}, 0, std::numeric_limits<std::int64_t>::max(), 1));
}

void read_trace_settings(TomlTable table, GenerateSettings& s) {
  s.trace.method =
      table.choice({"method", "how view factors are traced"}, {"lines", "embree"}, "lines") == "lines"
          ? TraceMethod::lines
          : TraceMethod::embree;
  s.trace.rays = table.number({"rays", "rays per particle"},
                              {.unit = "1", .min = 100, .max = 1e9, .why = "rays per particle"}, 10000);
  s.trace.seed = s.seed;
}

void read_fit_settings(TomlTable table, GenerateSettings& s) {
  auto names = correlation_form_names();
  names.insert(names.begin(), "both");
  names.push_back("paper");
  const auto form = table.choice({"form", "which correlation is fitted"}, names, "both");
  const double cutoff =
      table.number({"cutoff", "d* of the farthest pair that counts"},
                   {.unit = "1", .min = 1.5, .max = largest_pp_cutoff, .why = "d* of a pair"}, 10);
  for (const auto known : correlation_forms)
    if (form == "both" || form == to_string(known)) {
      FitOptions options;
      options.form = known;
      options.pp_cutoff = cutoff;
      s.fits.emplace_back(to_string(known), options);
    }
  if (form == "paper") s.fits.emplace_back("paper", paper_choices());
  if (form == "paper" && table.has("cutoff"))
    table.problem("cutoff", "is 20 in the paper's choices; leave it out");
}

}  // namespace

GenerateSettings read_generate_settings(const std::filesystem::path& config) {
  auto document = TomlDocument::from_file(config);
  return read_generate_settings(document);
}

GenerateSettings read_generate_settings(TomlDocument& document) {
  auto root = document.root();
  GenerateSettings settings;
  settings.title = root.string({"title", "what the table will be called"}, "");
  auto packed = root.table({"snapshots", "The random beds that are traced"});
  auto flow = root.table({"flow", "In place of [snapshots]: the flows whose snapshots are traced"});
  if (packed.present() && flow.present())
    document.problem("flow",
                     advised("[snapshots] and [flow] are both there (packings, or flows)", "keep one"));
  if (flow.present()) settings.flow = read_flow_settings(flow, document.folder());
  if (packed.present() || !flow.present()) read_snapshot_settings(packed, settings);
  read_trace_settings(root.table({"trace", "How they are traced"}), settings);
  read_fit_settings(root.table({"fit", "What is fitted"}), settings);
  document.finish();
  return settings;
}

Bed packed_bed(const GenerateSettings& settings, double solid_fraction, int number) {
  PackingRequest request;
  request.where.box = {{0, 0, 0}, settings.size_m};
  request.radius_m = equal_radii(request.where.box, solid_fraction, 0.5 * settings.diameter_m);
  request.seed = settings.seed * 1000 + static_cast<std::uint64_t>(number);
  request.equilibration_sweeps = settings.sweeps;
  Bed bed;
  bed.materials.emplace_back();
  bed.box = request.where.box;
  for (auto& wall : box_walls(bed.box)) {
    wall.role = WallRole::isothermal;
    bed.walls.push_back(wall);
  }
  for (const auto& centre : pack_spheres(request)) bed.add(centre, {}, 0.5 * settings.diameter_m, 300);
  return bed;
}

std::string snapshot_name(const GenerateSettings& settings, double solid_fraction, int number) {
  return name_of(solid_fraction, number, snapshot_dependencies(settings));
}

std::string traced_name(const GenerateSettings& settings, double solid_fraction, int number) {
  return name_of(solid_fraction, number, trace_dependencies(settings));
}

std::string traced_name(const GenerateSettings& s, const std::filesystem::path& snapshot) {
  const auto depends =
      fmt::format("{} trace {} {} {} {}", std::filesystem::absolute(snapshot).string(), view_factor_version,
                  to_string(s.trace.method), s.trace.rays, s.trace.seed);
  return fmt::format("{}_{:08x}", snapshot.stem().string(), fingerprint(depends));
}

}  // namespace granrad

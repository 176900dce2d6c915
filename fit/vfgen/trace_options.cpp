#include <fmt/core.h>

#include "dem/base/error.h"
#include "fit/vfgen/vfgen_commands.h"
#include "fit/vfgen/vfgen_options.h"

namespace granrad {

namespace {

/// Options as text, until they are checked.
struct TraceText {
  std::string method = "embree", sampling = "sobol", box, step = "last";
  std::vector<std::string> stl;
};

/// How many rays, drawn how, and the memory for what they find.
void add_effort(CLI::App& sub, TraceText& text, TraceSettings& trace) {
  auto* rays = sub.add_option("--rays", trace.rays, "rays per particle, walls in proportion to area")
                   ->check(number_in(1, 1e9))
                   ->capture_default_str();
  sub.add_option(
         "--error", trace.error,
         "instead: rms error wanted, relative: of the particle-wall sums, or of the particle fluxes of "
         "--hot-walls")
      ->check(number_in(1e-6, 1))
      ->excludes(rays);
  sub.add_option("--hot-walls", trace.hot_walls,
                 "names of walls: the stated error is that of the fluxes they alone send to the particles")
      ->delimiter(',');
  sub.add_option("--sampling", text.sampling,
                 "of embree: scrambled Sobol points or independent random numbers")
      ->check(CLI::IsMember({"sobol", "random"}))
      ->capture_default_str();
  sub.add_option("--memory", trace.memory_limit_bytes,
                 "largest use, such as 512MiB; beyond, rare pairs are thinned out at random (default 4GiB)")
      ->transform(memory_size());
  sub.add_option("--seed", trace.seed, "of the random numbers")->check(seed_number())->capture_default_str();
  sub.add_option("--threads", trace.threads, "0: all; results do not depend on it")
      ->check(CLI::Range(0, 4096));
}

/// What the rays meet.
void add_geometry(CLI::App& sub, TraceText& text, TraceCommand& command) {
  sub.add_option("--emissivity", command.trace.emissivity,
                 "of the particles: total exchange areas of grey surfaces")
      ->check(number_in(1e-6, 1));
  sub.add_option("--wall-emissivity", command.trace.wall_emissivity, "of the walls; default: each wall's own")
      ->check(number_in(1e-6, 1));
  sub.add_option("--box", text.box, "six black walls: X,Y,Z in metres, corner at the origin or at :x0,y0,z0");
  sub.add_option("--radius", command.enclosure.radius_m, "radius in metres, only for files without one")
      ->check(number_in(1e-12, 1e6));
  sub.add_option("--step", text.step,
                 "of files of several snapshots: first, last, all or the number of a step")
      ->capture_default_str();
  sub.add_option(
      "--walls", text.stl,
      "STL file of walls in metres, or FILE:SCALE (hopper.stl:0.001 for millimetres); may be repeated");
}

}  // namespace

void add_trace(CLI::App& app, Body& body) {
  const auto command = std::make_shared<TraceCommand>();
  const auto text = std::make_shared<TraceText>();
  auto& sub = *app.add_subcommand("trace", "View factors of snapshots by ray tracing");
  sub.add_option("SNAPSHOT", command->snapshots,
                 "frame (.hdf), CSV, LIGGGHTS/LAMMPS text dump, XYZ, VTK (.vtp .vtu .vtk); also .gz")
      ->required();
  sub.add_option("-o,--output", command->output,
                 "HDF5 file; of several snapshots, number k goes to FILE_000k.h5")
      ->required();
  sub.add_option("--method", text->method, "embree: any walls; lines: convex boxes, faster")
      ->check(CLI::IsMember({"embree", "lines"}))
      ->capture_default_str();
  add_effort(sub, *text, command->trace);
  add_geometry(sub, *text, *command);
  sub.callback([&body, command, text] {
    command->trace.method = text->method == "lines" ? TraceMethod::lines : TraceMethod::embree;
    command->trace.sampling = text->sampling == "random" ? Sampling::plain : Sampling::sobol;
    body = [command, text](Verbosity verbosity) {
      if (!text->box.empty()) command->enclosure.box = parse_box(text->box);
      for (const auto& stl : text->stl) command->enclosure.stl.push_back(parse_stl(stl));
      command->every_step = text->step == "all";
      if (!command->every_step) command->enclosure.which = parse_step(text->step);
      return run_trace(*command, verbosity);
    };
  });
}

}  // namespace granrad

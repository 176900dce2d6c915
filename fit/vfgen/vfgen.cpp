#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <functional>
#include <optional>

#include "dem/base/error.h"
#include "dem/base/program.h"
#include "dem/base/toml/key_reference.h"
#include "fit/generate/generate.h"
#include "fit/vfgen/vfgen_commands.h"

namespace {

using namespace granrad;
using Body = std::function<int(Verbosity)>;

/// Options as text, until they are checked.
struct TraceText {
  std::string method = "embree", sampling = "sobol", box, step = "last";
  std::vector<std::string> stl;
};

/// A number in [low, high]; unlike CLI::Range it refuses NaN and what follows a number.
CLI::Validator number_in(double low, double high) {
  const auto problem = [low, high](std::string& text) -> std::string {
    double value = 0;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool whole = failure == std::errc{} && end == text.data() + text.size();
    if (whole && value >= low && value <= high) return {};
    return fmt::format("{} (must be a number in [{:g}, {:g}])", text, low, high);
  };
  return {problem, fmt::format("in [{:g}, {:g}]", low, high)};
}

/// CLI11 would let -1 wrap around.
CLI::Validator seed_number() {
  const auto problem = [](std::string& text) -> std::string {
    std::int64_t value = 0;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (failure == std::errc{} && end == text.data() + text.size() && value >= 0) return {};
    return fmt::format("{} (must be a whole number >= 0)", text);
  };
  return {problem, ">= 0"};
}

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
  auto* rays = sub.add_option("--rays", command->trace.rays, "rays per particle, walls in proportion to area")
                   ->check(number_in(1, 1e9))
                   ->capture_default_str();
  sub.add_option(
         "--error", command->trace.error,
         "instead: rms error wanted, relative: of the particle-wall sums, or of the particle fluxes of "
         "--hot-walls")
      ->check(number_in(1e-6, 1))
      ->excludes(rays);
  sub.add_option("--hot-walls", command->trace.hot_walls,
                 "names of walls: the stated error is that of the fluxes they alone send to the particles")
      ->delimiter(',');
  sub.add_option("--sampling", text->sampling,
                 "of embree: scrambled Sobol points or independent random numbers")
      ->check(CLI::IsMember({"sobol", "random"}))
      ->capture_default_str();
  sub.add_option("--memory", command->trace.memory_limit_bytes,
                 "largest use, such as 512MiB; beyond, rare pairs are thinned out at random (default 4GiB)")
      ->transform(CLI::AsSizeValue(true));
  sub.add_option("--emissivity", command->trace.emissivity,
                 "of the particles: total exchange areas of grey surfaces")
      ->check(number_in(1e-6, 1));
  sub.add_option("--wall-emissivity", command->trace.wall_emissivity,
                 "of the walls; default: each wall's own")
      ->check(number_in(1e-6, 1));
  sub.add_option("--box", text->box,
                 "six black walls: X,Y,Z in metres, corner at the origin or at :x0,y0,z0");
  sub.add_option("--radius", command->enclosure.radius_m, "radius in metres, only for files without one")
      ->check(number_in(1e-12, 1e6));
  sub.add_option("--step", text->step,
                 "of files of several snapshots: first, last, all or the number of a step")
      ->capture_default_str();
  sub.add_option(
      "--walls", text->stl,
      "STL file of walls in metres, or FILE:SCALE (hopper.stl:0.001 for millimetres); may be repeated");
  sub.add_option("--seed", command->trace.seed, "of the random numbers")
      ->check(seed_number())
      ->capture_default_str();
  sub.add_option("--threads", command->trace.threads, "0: all; results do not depend on it")
      ->check(CLI::Range(0, 4096));
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

/// Options of a fit as text, until they are checked.
struct FitText {
  std::string form = "cubic", pairs = "all", wall_distance = "centre_to_plane_over_d", choices = "own";
};

/// The paper's choices, unless an option says otherwise.
FitOptions fit_options(const CLI::App& sub, const FitText& text, FitOptions given) {
  const bool paper = text.choices == "paper";
  FitOptions options = paper ? paper_choices() : FitOptions{};
  const auto asked = [&](const char* option) { return !paper || sub.count(option) > 0; };
  if (asked("--form")) options.form = correlation_form(text.form);
  if (asked("--pairs")) options.visible_only = text.pairs == "visible";
  if (asked("--cutoff")) options.pp_cutoff = given.pp_cutoff;
  if (asked("--fit-walls")) options.walls = given.walls;
  if (asked("--wall-reach")) options.pw_reach = given.pw_reach;
  if (asked("--wall-distance"))
    options.pw_distance = text.wall_distance == "h_plus_r_over_d" ? WallDistance::h_plus_r_over_d
                                                                  : WallDistance::centre_to_plane_over_d;
  if (options.pw_distance == WallDistance::h_plus_r_over_d && !takes_wall_distance_from_surface(options.form))
    throw InputError(advised(
        fmt::format("--wall-distance: h_plus_r_over_d (form {} is defined for h/d)", to_string(options.form)),
        "use --wall-distance centre_to_plane_over_d"));
  return options;
}

void add_fit(CLI::App& app, Body& body) {
  const auto command = std::make_shared<FitCommand>();
  const auto text = std::make_shared<FitText>();
  auto& sub = *app.add_subcommand("fit", "Correlation table from traced view factors");
  sub.add_option("FILE", command->files, "HDF5 files of vfgen trace; equal solid fractions become one row")
      ->required();
  sub.add_option("-o,--output", command->output, "table, TOML")->required();
  sub.add_option("--form", text->form,
                 "cubic: polynomial in 1/d*; transmittance: exact factor times exp(-a (d*-1)^b)")
      ->check(CLI::IsMember(correlation_form_names()))
      ->capture_default_str();
  sub.add_option("--report", command->report, "HTML page of the fit");
  sub.add_option("--cutoff", command->options.pp_cutoff, "largest d* of a pair")
      ->check(number_in(1.5, largest_pp_cutoff))
      ->capture_default_str();
  sub.add_option("--pairs", text->pairs, "all: invisible pairs count as F = 0; visible: they are left out")
      ->check(CLI::IsMember({"all", "visible"}))
      ->capture_default_str();
  sub.add_option("--fit-walls", command->options.walls,
                 "names of the walls F_pw is fitted on, or all; default: the largest")
      ->delimiter(',');
  sub.add_option("--wall-distance", text->wall_distance, "what d* of a wall is (cubic only: h_plus_r_over_d)")
      ->check(CLI::IsMember({"centre_to_plane_over_d", "h_plus_r_over_d"}))
      ->capture_default_str();
  sub.add_option("--wall-reach", command->options.pw_reach,
                 "walls farther than this h/d are left out of the fit")
      ->check(number_in(1, largest_pw_cutoff))
      ->capture_default_str();
  sub.add_option("--choices", text->choices,
                 "paper: cubic, all pairs, --cutoff 20, --fit-walls all, --wall-distance h_plus_r_over_d, "
                 "--wall-reach 20, where no option says otherwise")
      ->check(CLI::IsMember({"own", "paper"}))
      ->capture_default_str();
  sub.callback([&body, &sub, command, text] {
    body = [&sub, command, text](Verbosity verbosity) {
      command->options = fit_options(sub, *text, command->options);
      return run_fit(*command, verbosity);
    };
  });
}

void add_generate(CLI::App& app, Body& body) {
  const auto command = std::make_shared<GenerateCommand>();
  auto& sub = *app.add_subcommand(
      "generate", "Snapshots, view factors, tables and reports for a list of solid fractions");
  sub.add_option("CONFIG", command->config, "TOML; its keys: vfgen keys")->required();
  sub.add_option("-o,--output", command->folder, "folder; what is there from the same settings is kept")
      ->required();
  sub.add_option("--threads", command->threads, "0: all; results do not depend on it")
      ->check(CLI::Range(0, 4096));
  sub.callback([&body, command] {
    body = [command](Verbosity verbosity) { return run_generate(*command, verbosity); };
  });
}

void add_curve(CLI::App& app, Body& body) {
  const auto command = std::make_shared<CurveCommand>();
  auto& sub = *app.add_subcommand("curve", "A curve through two columns of a CSV file, with errors");
  sub.add_option("DATA", command->data, "CSV with a header, of a study for example")->required();
  sub.add_option(
         "--form", command->form,
         "power: a x^b; line: a + b x; logarithm: a ln(b x); exponential_logarithm: a e^(b x) + c ln(d x)")
      ->required()
      ->check(CLI::IsMember({"power", "line", "logarithm", "exponential_logarithm"}));
  sub.add_option("-x", command->x, "column of x")->capture_default_str();
  sub.add_option("-y", command->y, "column of y")->capture_default_str();
  sub.add_option("-o,--output", command->output, "JSON file");
  sub.callback(
      [&body, command] { body = [command](Verbosity verbosity) { return run_curve(*command, verbosity); }; });
}

void add_measure(CLI::App& app, Body& body) {
  const auto command = std::make_shared<MeasureCommand>();
  const auto box = std::make_shared<std::string>();
  auto& sub = *app.add_subcommand("measure",
                                  "Extinction, transmittance, mean free path and exchange factor of a bed");
  sub.add_option("SNAPSHOT", command->snapshot, "frame (.hdf), CSV or LIGGGHTS/LAMMPS text dump")->required();
  sub.add_option("-o,--output", command->folder, "folder for measure.json and report.html");
  sub.add_option("--between", command->between,
                 "the plates are the walls of the box across x, y or z: exchange factor F")
      ->check(CLI::IsMember({"x", "y", "z"}));
  sub.add_option("--emissivity", command->emissivity, "of particles and plates, for F")
      ->check(number_in(1e-6, 1))
      ->capture_default_str();
  sub.add_option("--rays", command->rays, "for F, per particle of each of four replicates")
      ->check(number_in(1, 1e9))
      ->capture_default_str();
  sub.add_option("--box", *box, "walls: X,Y,Z in metres, corner at the origin or at :x0,y0,z0");
  sub.add_option("--radius", command->enclosure.radius_m, "radius in metres, for files without one")
      ->check(number_in(1e-12, 1e6));
  sub.add_option("--walls", command->enclosure.stl, "STL file of walls, metres");
  sub.add_option("--seed", command->seed, "of the random numbers")
      ->check(seed_number())
      ->capture_default_str();
  sub.add_option("--threads", command->threads, "0: all; results do not depend on it")
      ->check(CLI::Range(0, 4096));
  sub.callback([&body, command, box] {
    body = [command, box](Verbosity verbosity) {
      if (!box->empty()) command->enclosure.box = parse_box(*box);
      return run_measure(*command, verbosity);
    };
  });
}

void add_check(CLI::App& app, Body& body) {
  const auto table = std::make_shared<std::filesystem::path>();
  auto& sub = *app.add_subcommand("check", "Bounds, range and closure of a correlation table");
  sub.add_option("TABLE", *table, "table, TOML")->required();
  sub.callback(
      [&body, table] { body = [table](Verbosity verbosity) { return run_check(*table, verbosity); }; });
}

void add_keys(CLI::App& app, Body& body) {
  const auto md = std::make_shared<bool>(false), toml = std::make_shared<bool>(false),
             schema = std::make_shared<bool>(false);
  auto& sub = *app.add_subcommand("keys", "Every key of a CONFIG of generate: unit, range, default, meaning");
  auto* markdown = sub.add_flag("--md", *md, "a page in Markdown (the default)");
  auto* as_toml = sub.add_flag("--toml", *toml, "a commented file to start from")->excludes(markdown);
  sub.add_flag("--schema", *schema, "a JSON schema for editors")->excludes(markdown)->excludes(as_toml);
  sub.callback([&body, md, toml, schema] {
    body = [toml, schema](Verbosity) {
      const auto tables = key_catalogue([](TomlDocument& document) { read_generate_settings(document); });
      const char* title = "Settings of vfgen generate";
      fmt::print("{}", *schema ? reference_schema(tables, title)
                       : *toml ? reference_toml(tables, title)
                               : reference_markdown(tables));
      return exit_ok;
    };
  });
}

int run(int argc, char** argv) {
  CLI::App app("View factors of particle beds by ray tracing, and correlations fitted to them.", "vfgen");
  app.set_version_flag("--version", fmt::format("vfgen {} ({})", program_version(), program_git_sha()));
  app.require_subcommand(1);
  app.fallthrough();
  bool quiet = false, verbose = false;
  auto* q = app.add_flag("-q,--quiet", quiet, "only results and errors");
  app.add_flag("-v,--verbose", verbose,
               "also the settings of a trace, coefficients of a fit, curves of a check; time and memory")
      ->excludes(q);
  Body body;
  add_trace(app, body);
  add_fit(app, body);
  add_generate(app, body);
  add_check(app, body);
  add_keys(app, body);
  add_curve(app, body);
  add_measure(app, body);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? exit_ok : exit_bad_input;
  }
  return run_program("vfgen", [&] {
    install_signal_handlers();
    const int code = body(quiet ? Verbosity::quiet : verbose ? Verbosity::verbose : Verbosity::normal);
    if (verbose) fmt::print(stderr, "vfgen: {}\n", resources_used());
    return code;
  });
}

}  // namespace

int main(int argc, char** argv) {
  return run(argc, argv);
}

#include <fmt/core.h>

#include <CLI/CLI.hpp>

#include "dem/base/command_line.h"
#include "dem/base/error.h"
#include "dem/base/program.h"
#include "dem/base/toml/key_reference.h"
#include "dem/ranks/ranks.h"
#include "fit/generate/generate.h"
#include "fit/vfgen/vfgen_commands.h"
#include "fit/vfgen/vfgen_options.h"

namespace {

using namespace granrad;

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
  const auto walls = std::make_shared<std::vector<std::string>>();
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
  sub.add_option(
      "--walls", *walls,
      "STL file of walls in metres, or FILE:SCALE (hopper.stl:0.001 for millimetres); may be repeated");
  sub.add_option("--seed", command->seed, "of the random numbers")
      ->check(seed_number())
      ->capture_default_str();
  sub.add_option("--threads", command->threads, "0: all; results do not depend on it")
      ->check(CLI::Range(0, 4096));
  sub.callback([&body, command, box, walls] {
    body = [command, box, walls](Verbosity verbosity) {
      if (!box->empty()) command->enclosure.box = parse_box(*box);
      for (const auto& text : *walls) command->enclosure.stl.push_back(parse_stl(text));
      return run_measure(*command, verbosity);
    };
  });
}

void add_export(CLI::App& app, Body& body) {
  const auto command = std::make_shared<ExportCommand>();
  auto& sub = *app.add_subcommand("export", "Traced view factors for other programs");
  sub.add_option("FILE", command->file, "HDF5 file of vfgen trace")->required();
  sub.add_option("--to", command->format,
                 "csv: a row a pair, with its distance; npz: scipy.sparse.load_npz; mtx: Matrix Market")
      ->required()
      ->check(CLI::IsMember({"csv", "npz", "mtx", "aspherix"}).description("csv, npz or mtx"));
  sub.add_option("-o,--output", command->output, "file; default: beside FILE, named after the format");
  sub.callback([&body, command] {
    body = [command](Verbosity verbosity) { return run_export(*command, verbosity); };
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
  set_manners(app);
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
  add_export(app, body);
  add_keys(app, body);
  add_curve(app, body);
  add_measure(app, body);
  join_ranks();
  return run_command(app, argc, argv, [&](const std::string& command) {
    if (command != "trace") refuse_several_ranks("vfgen " + command);
    install_signal_handlers();
    const int code = body(quiet ? Verbosity::quiet : verbose ? Verbosity::verbose : Verbosity::normal);
    if (verbose) fmt::print(stderr, "vfgen: {}\n", resources_used());
    return code;
  });
}

}  // namespace

int main(int argc, char** argv) {
  return leave_ranks(run_program("vfgen", [&] { return run(argc, argv); }));
}

#include <fmt/core.h>
#include <omp.h>

#include <CLI/CLI.hpp>
#include <functional>
#include <memory>

#include "coupling/granrun/case_report.h"
#include "coupling/granrun/check.h"
#include "coupling/granrun/export.h"
#include "coupling/granrun/keys.h"
#include "coupling/granrun/new_scene.h"
#include "coupling/granrun/render.h"
#include "coupling/granrun/run.h"
#include "coupling/measure/measure_command.h"
#include "coupling/study/run_study.h"
#include "coupling/validate/validate.h"
#include "dem/base/error.h"
#include "dem/base/program.h"

namespace {

using namespace granrad;

struct Arguments {
  std::string scene, folder, format, walltime;
  std::vector<std::string> overrides, removed;
  std::vector<std::string> scenes;
  std::vector<double> emissivities;
  ValidateOptions validate;
  StudyOptions study;
  ConductivityCommand measure;
  RunOptions options;
  bool quiet = false, verbose = false;
};

double seconds_of(const std::string& walltime) {
  int hours = 0, minutes = 0, seconds = 0, length = 0;
  constexpr std::size_t longest = 12;  // 99999:59:59: no number overflows
  if (walltime.size() > longest ||
      std::sscanf(walltime.c_str(), "%5d:%2d:%2d%n", &hours, &minutes, &seconds, &length) != 3 ||
      length != static_cast<int>(walltime.size()) || hours < 0 || minutes < 0 || minutes > 59 ||
      seconds < 0 || seconds > 59)
    throw InputError(advised(fmt::format("--walltime = {} (must be HH:MM:SS, at most 99999 hours)", walltime),
                             "try 00:30:00"));
  return 3600.0 * hours + 60.0 * minutes + seconds;
}

/// As a shell would read it.
std::string command_line(int argc, char** argv) {
  std::string line;
  for (int k = 0; k < argc; ++k) {
    const std::string word = argv[k];
    const bool plain = word.find_first_of(" '\"\\$[]{}*?;&|<>()#!~`\t\n") == std::string::npos;
    std::string inside;
    for (char c : word) inside += c == '\'' ? std::string("'\\''") : std::string(1, c);
    line += fmt::format("{}{}", k ? " " : "", plain && !word.empty() ? word : fmt::format("'{}'", inside));
  }
  return line;
}

void add_common(CLI::App* command, Arguments& a) {
  command->add_option("--threads", a.options.threads, "threads; results do not depend on it")
      ->check(CLI::Range(1, 4096));
  auto* quiet = command->add_flag("-q,--quiet", a.quiet, "errors only");
  command->add_flag("-v,--verbose", a.verbose, "also each row as it comes, time and memory on stderr")
      ->excludes(quiet);
}

void add_scene_edits(CLI::App* command, Arguments& a) {
  command->add_option("--set", a.overrides, "override a scene value, e.g. --set radiation.rays=1000")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  command->add_option("--unset", a.removed, "take a key out of the scene, e.g. --unset feed.mass_flow_kg_s")
      ->type_name("KEY")
      ->allow_extra_args(false);
  add_common(command, a);
}

void add_scene(CLI::App* command, Arguments& a) {
  command->add_option("SCENE", a.scene, "scene file (TOML)")->required();
  add_scene_edits(command, a);
}

void add_output(CLI::App* command, Arguments& a) {
  command->add_option("-o,--output", a.folder, "folder for the results")->required()->type_name("DIR");
}

void add_stopping(CLI::App* command, Arguments& a) {
  command->add_option("--walltime", a.walltime, "save a checkpoint and exit 75 after HH:MM:SS");
}

void add_study_options(CLI::App* command, Arguments& a) {
  command->add_option("STUDY", a.scene, "study file (TOML)")->required();
  add_output(command, a);
  add_stopping(command, a);
  command->add_option("--jobs", a.study.jobs, "cases at the same time; default: one a core")
      ->check(CLI::Range(1, 4096));
  command->add_option("--case", a.study.only, "run this case alone, for clusters")->type_name("NAME");
  command->add_flag("--list", a.study.list_only, "write jobs.txt, slurm_array.sh and Snakefile, run nothing");
  command->add_flag("--quick", a.study.quick, "only the cases that the study marks as quick");
  command->add_flag("--any-version", a.study.any_version,
                    "keep what another version of granrun has finished");
  command->add_option("--book", a.study.book, "write the claims as a book in Markdown too")
      ->type_name("FILE.md");
  add_common(command, a);
}

void add_conductivity(CLI::App* command, Arguments& a) {
  command->require_subcommand(1);
  auto* one =
      command->add_subcommand("conductivity", "k by path and the exchange factor F, between two plates");
  one->add_option("BED", a.measure.bed, "a scene; or a frame, CSV or dump with --scene")->required();
  one->add_option("--between", a.measure.between, "the plates are the walls of the box across x, y or z")
      ->check(CLI::IsMember({"x", "y", "z"}))
      ->capture_default_str();
  one->add_option("--scene", a.measure.scene, "scene whose walls and materials BED has")
      ->type_name("FILE.toml");
  one->add_option("--temperature", a.measure.temperature_K,
                  "K; default: the mean of the plates, else of the particles")
      ->check(CLI::Range(1.0, 1e4));
  one->add_option("--rays", a.measure.rays, "rays per particle of each replicate")
      ->check(CLI::Range(1.0, 1e9))
      ->capture_default_str();
  one->add_option("--replicates", a.measure.replicates, "of the rays, for their error")
      ->check(CLI::Range(2, 1000))
      ->capture_default_str();
  add_scene_edits(one, a);
  add_output(one, a);
}

void apply(Arguments& a) {
  if (a.quiet) a.options.verbosity = Verbosity::quiet;
  if (a.verbose) a.options.verbosity = Verbosity::verbose;
  if (!a.walltime.empty()) a.options.walltime_s = seconds_of(a.walltime);
  if (a.options.threads > 0) omp_set_num_threads(a.options.threads);
}

/// What the command chosen does, once the arguments are known.
using Body = std::function<int()>;

void add_run(CLI::App& app, Arguments& a, Body& body) {
  auto* run = app.add_subcommand("run", "run a scene");
  add_scene(run, a);
  add_output(run, a);
  add_stopping(run, a);
  run->add_flag("--resume", a.options.resume, "continue from the last whole frame in DIR");
  run->callback([&] {
    body = [&] { return run_case(read_case(a.scene, a.overrides, a.removed), a.folder, a.options); };
  });
}

void add_check(CLI::App& app, Arguments& a, Body& body) {
  auto* check =
      app.add_subcommand("check", "validate a scene; print limits, what is modelled and what is not");
  add_scene(check, a);
  const auto defaults = std::make_shared<bool>(false);
  check->add_flag("--defaults", *defaults, "print the scene with every default in force, as comments");
  check->callback([&, defaults] {
    body = [&, defaults] {
      return check_case(read_case(a.scene, a.overrides, a.removed), a.options, *defaults);
    };
  });
}

void add_render(CLI::App& app, Arguments& a, Body& body) {
  auto* render = app.add_subcommand("render", "a picture or a film of a case, without a screen");
  render->add_option("DIR", a.folder, "folder of a case")->required();
  const auto file = std::make_shared<std::string>();
  render->add_option("-o,--output", *file, "picture.png (the last frame) or film.mp4 (all frames)")
      ->required();
  add_common(render, a);
  render->callback([&, file] { body = [&, file] { return render_case(a.folder, *file, a.options); }; });
}

void add_new(CLI::App& app, Body& body) {
  auto* starter = app.add_subcommand("new", "copy an example scene with what it needs");
  const auto file = std::make_shared<std::string>(), example = std::make_shared<std::string>();
  starter->add_option("FILE", *file, "the new scene")->required();
  starter->add_option("--from", *example, "plug, hopper, frozen, or any scene in share/granrad/scenes")
      ->default_val("plug");
  starter->callback([&body, file, example] { body = [=] { return new_scene(*file, *example); }; });
}

void add_keys(CLI::App& app, Body& body) {
  struct Asked {
    std::string of = "scene";
    bool markdown = false, toml = false, schema = false;
  };
  const auto asked = std::make_shared<Asked>();
  auto* keys = app.add_subcommand("keys", "every key of a scene: unit, range, default, meaning");
  keys->add_option("OF", asked->of, "scene, or table (of a correlation)")
      ->check(CLI::IsMember({"scene", "table"}))
      ->capture_default_str();
  auto* markdown = keys->add_flag("--md", asked->markdown, "a page in Markdown (the default)");
  auto* toml = keys->add_flag("--toml", asked->toml, "a commented file to start from")->excludes(markdown);
  keys->add_flag("--schema", asked->schema, "a JSON schema for editors")->excludes(markdown)->excludes(toml);
  keys->callback([&body, asked] {
    body = [asked] { return print_keys(asked->of, asked->toml ? "toml" : asked->schema ? "schema" : "md"); };
  });
}

/// Every scene, once with each emissivity asked for.
std::vector<Case> cases_to_validate(const Arguments& a) {
  std::vector<Case> cases;
  for (const auto& scene : a.scenes) {
    if (a.emissivities.empty()) cases.push_back(read_case(scene, a.overrides, a.removed));
    for (double one : a.emissivities) {
      auto overrides = a.overrides;
      overrides.push_back(fmt::format("material.emissivity={}", one));
      cases.push_back(read_case(scene, overrides, a.removed));
    }
  }
  return cases;
}

void add_validate(CLI::App& app, Arguments& a, Body& body) {
  auto* validate = app.add_subcommand("validate", "compare exchange sources on frozen beds");
  validate->add_option("SCENE", a.scenes, "scene files (TOML)")->required();
  validate->add_option("--emissivity", a.emissivities, "of the particles: each scene once with each")
      ->delimiter(',')
      ->check(CLI::Range(0.0, 1.0));
  validate
      ->add_option("--max-error", a.validate.max_error_pct, "exit 4 when a source is off by more than PCT %")
      ->type_name("PCT")
      ->check(CLI::PositiveNumber);
  add_scene_edits(validate, a);
  add_output(validate, a);
  validate->callback(
      [&] { body = [&] { return validate_cases(cases_to_validate(a), a.folder, a.validate, a.options); }; });
}

void add_study(CLI::App& app, Arguments& a, Body& body) {
  auto* study =
      app.add_subcommand("study", "many cases: runs, validations, measurements, traces, fits; resumable");
  add_study_options(study, a);
  study->callback([&] {
    body = [&] {
      a.study.run = a.options;
      return run_study(a.scene, a.folder, a.study);
    };
  });
}

void add_sweep(CLI::App& app, Arguments& a, Body& body) {
  auto* sweep = app.add_subcommand("sweep", "the old name of study");
  add_study_options(sweep, a);
  sweep->callback([&] {
    body = [&] {
      a.study.run = a.options;
      return run_study(a.scene, a.folder, a.study, "sweep.csv");
    };
  });
}

void add_measure(CLI::App& app, Arguments& a, Body& body) {
  auto* measure = app.add_subcommand("measure", "properties of a bed");
  add_conductivity(measure, a);
  measure->callback([&] {
    body = [&] {
      a.measure.overrides = a.overrides;
      a.measure.removed = a.removed;
      return measure_case(a.measure, a.folder, a.options);
    };
  });
}

void add_report(CLI::App& app, Arguments& a, Body& body) {
  auto* report = app.add_subcommand("report", "HTML report of a finished or running case");
  report->add_option("DIR", a.folder, "folder of a case")->required();
  add_common(report, a);
  report->callback([&] { body = [&] { return report_case(a.folder, a.options); }; });
}

void add_export(CLI::App& app, Arguments& a, Body& body) {
  auto* exporter = app.add_subcommand("export", "frames for OVITO and other tools, into DIR/export");
  exporter->add_option("DIR", a.folder, "folder of a case")->required();
  exporter->add_option("--to", a.format, "vtp, dump or csv")
      ->required()
      ->check(CLI::IsMember({"vtp", "dump", "csv"}));
  add_common(exporter, a);
  exporter->callback([&] { body = [&] { return export_case(a.folder, a.format, a.options); }; });
}

int granrun(int argc, char** argv) {
  CLI::App app{"granrun: granular flows heated by conduction and radiation"};
  app.set_version_flag("--version", fmt::format("granrun {} ({})", program_version(), program_git_sha()));
  app.require_subcommand(1);
  app.footer(
      "Exit codes: 0 ok, 1 numerical failure, 2 usage or input, 3 file cannot be read or written,\n"
      "4 threshold missed, 75 wall time reached (checkpoint saved), 129/130/143 hung up, interrupted, terminated\n"
      "(checkpoint saved). SIGUSR1 saves a checkpoint and the run goes on.");
  Arguments a;
  Body body;
  for (auto* add : {add_run, add_check, add_validate, add_study, add_sweep, add_measure, add_report,
                    add_export, add_render})
    add(app, a, body);
  add_new(app, body);
  add_keys(app, body);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? exit_ok : exit_bad_input;
  }
  refuse_several_ranks();
  apply(a);
  a.options.command_line = command_line(argc, argv);
  const int code = body();
  if (a.verbose) fmt::print(stderr, "granrun: {}\n", resources_used());
  return code;
}

}  // namespace

int main(int argc, char** argv) {
  return run_program("granrun", [&] { return granrun(argc, argv); });
}

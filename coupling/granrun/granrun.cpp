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
#include "coupling/granrun/sweep.h"
#include "coupling/granrun/validate.h"
#include "dem/base/error.h"
#include "dem/base/program.h"

namespace {

using namespace granrad;

struct Arguments {
  std::string scene, folder, format, walltime;
  std::vector<std::string> overrides;
  RunOptions options;
  bool quiet = false, verbose = false, list_only = false;
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

void add_scene(CLI::App* command, Arguments& a) {
  command->add_option("SCENE", a.scene, "scene file (TOML)")->required();
  command->add_option("--set", a.overrides, "override a scene value, e.g. --set radiation.rays=1000")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  add_common(command, a);
}

void add_output(CLI::App* command, Arguments& a) {
  command->add_option("-o,--output", a.folder, "folder for the results")->required()->type_name("DIR");
}

void add_stopping(CLI::App* command, Arguments& a) {
  command->add_option("--walltime", a.walltime, "save a checkpoint and exit 75 after HH:MM:SS");
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
  run->callback(
      [&] { body = [&] { return run_case(read_case(a.scene, a.overrides), a.folder, a.options); }; });
}

void add_check(CLI::App& app, Arguments& a, Body& body) {
  auto* check =
      app.add_subcommand("check", "validate a scene; print limits, what is modelled and what is not");
  add_scene(check, a);
  const auto defaults = std::make_shared<bool>(false);
  check->add_flag("--defaults", *defaults, "print the scene with every default in force, as comments");
  check->callback([&, defaults] {
    body = [&, defaults] { return check_case(read_case(a.scene, a.overrides), a.options, *defaults); };
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

void add_validate(CLI::App& app, Arguments& a, Body& body) {
  auto* validate = app.add_subcommand("validate", "compare exchange sources on a frozen bed");
  add_scene(validate, a);
  add_output(validate, a);
  validate->callback(
      [&] { body = [&] { return validate_case(read_case(a.scene, a.overrides), a.folder, a.options); }; });
}

void add_sweep(CLI::App& app, Arguments& a, Body& body) {
  auto* sweep = app.add_subcommand("sweep", "parameter study; resumable");
  sweep->add_option("SWEEP", a.scene, "sweep file (TOML)")->required();
  add_output(sweep, a);
  add_stopping(sweep, a);
  sweep->add_flag("--list", a.list_only, "write the cases and jobs.txt, run nothing");
  add_common(sweep, a);
  sweep->callback([&] { body = [&] { return run_sweep(a.scene, a.folder, a.list_only, a.options); }; });
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
  for (auto* add : {add_run, add_check, add_validate, add_sweep, add_report, add_export, add_render})
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

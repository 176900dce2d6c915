#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <functional>
#include <memory>

#include "coupling/granrun/arguments.h"
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
#include "dem/base/command_line.h"
#include "dem/base/error.h"
#include "dem/base/program.h"
#include "dem/ranks/ranks.h"

namespace {

using namespace granrad;

void add_study_options(CLI::App* command, Arguments& a, StudyOptions& study) {
  command->add_option("STUDY", a.scene, "study file (TOML)")->required();
  add_output(command, a);
  add_stopping(command, a);
  command->add_option("--jobs", study.jobs, "cases at the same time; default: one a core")
      ->check(CLI::Range(1, 4096));
  command->add_option("--case", study.only, "run this case alone, for clusters")->type_name("NAME");
  command->add_flag("--list", study.list_only, "write jobs.txt, slurm_array.sh and Snakefile, run nothing");
  command->add_flag("--quick", study.quick, "only the cases that the study marks as quick");
  command->add_flag("--any-version", study.any_version, "keep what another version of granrun has finished");
  command->add_option("--book", study.book, "write the claims as a book in Markdown too")
      ->type_name("FILE.md");
  add_common(command, a);
}

void add_conductivity(CLI::App* command, Arguments& a, ConductivityCommand& measure) {
  command->require_subcommand(1);
  auto* one =
      command->add_subcommand("conductivity", "k by path and the exchange factor F, between two plates");
  one->add_option("BED", measure.bed, "a scene; or a frame, CSV or dump with --scene")->required();
  one->add_option("--between", measure.between, "the plates are the walls of the box across x, y or z")
      ->check(CLI::IsMember({"x", "y", "z"}))
      ->capture_default_str();
  one->add_option("--scene", measure.scene, "scene whose walls and materials BED has")
      ->type_name("FILE.toml");
  one->add_option("--temperature", measure.temperature_K,
                  "K; default: the mean of the plates, else of the particles")
      ->check(CLI::Range(1.0, 1e4));
  one->add_option("--rays", measure.rays, "rays per particle of each replicate")
      ->check(CLI::Range(1.0, 1e9))
      ->capture_default_str();
  one->add_option("--replicates", measure.replicates, "of the rays, for their error")
      ->check(CLI::Range(2, 1000))
      ->capture_default_str();
  add_scene_edits(one, a);
  add_output(one, a);
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
  const auto asked = std::make_shared<CheckOptions>();
  check->add_flag("--defaults", asked->defaults, "print the scene with every default in force, as comments");
  check->add_option("--ranks", asked->ranks, "forecast for so many ranks, one a node; see mpirun")
      ->check(CLI::Range(1, 1024));
  check->add_option("--slurm", asked->slurm, "write a job of Slurm for these ranks and threads")
      ->type_name("FILE.sh");
  check->callback([&, asked] {
    body = [&, asked] {
      asked->scene_line = in_quotes(a.scene);
      for (const auto& one : a.overrides) asked->scene_line += " --set " + in_quotes(one);
      for (const auto& one : a.removed) asked->scene_line += " --unset " + in_quotes(one);
      return check_case(read_case(a.scene, a.overrides, a.removed), a.options, *asked);
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
  auto* starter = app.add_subcommand("new", "copy an example scene or study with what it needs");
  const auto file = std::make_shared<std::string>(), example = std::make_shared<std::string>();
  starter->add_option("FILE", *file, "the new scene")->required();
  starter
      ->add_option(
          "--from", *example,
          "plug, hopper, frozen, dump (with an STL, two materials), period, validate, sweep (a study), or any in share/granrad")
      ->default_val("plug");
  starter->callback([&body, file, example] { body = [=] { return new_scene(*file, *example); }; });
}

int print_keys_of(const std::string& kind, const std::string& format) {
  if (kind == "study") return print_keys(read_study_keys, "A study of granrad", format);
  if (kind == "table") return print_keys(read_table_keys, "A correlation table of granrad", format);
  return print_keys(read_scene_keys, "A scene of granrad", format);
}

void add_keys(CLI::App& app, Body& body) {
  struct Asked {
    std::string of = "scene";
    bool markdown = false, toml = false, schema = false;
  };
  const auto asked = std::make_shared<Asked>();
  auto* keys = app.add_subcommand("keys", "every key of a file: unit, range, default, meaning");
  keys->add_option("OF", asked->of, "scene, study, or table (of a correlation)")
      ->check(CLI::IsMember({"scene", "study", "table"}))
      ->capture_default_str();
  auto* markdown = keys->add_flag("--md", asked->markdown, "a page in Markdown (the default)");
  auto* toml = keys->add_flag("--toml", asked->toml, "a commented file to start from")->excludes(markdown);
  keys->add_flag("--schema", asked->schema, "a JSON schema for editors")->excludes(markdown)->excludes(toml);
  keys->callback([&body, asked] {
    body = [asked] {
      return print_keys_of(asked->of, asked->toml ? "toml" : asked->schema ? "schema" : "md");
    };
  });
}

/// Scenes to validate.
struct ValidateArguments {
  std::vector<std::string> scenes;
  std::vector<double> emissivities;
  ValidateOptions options;
};

/// Every scene, once with each emissivity asked for.
std::vector<Case> cases_to_validate(const Arguments& a, const ValidateArguments& asked) {
  std::vector<Case> cases;
  for (const auto& scene : asked.scenes) {
    if (asked.emissivities.empty()) cases.push_back(read_case(scene, a.overrides, a.removed));
    for (double one : asked.emissivities) {
      auto overrides = a.overrides;
      overrides.push_back(fmt::format("material.emissivity={}", one));
      cases.push_back(read_case(scene, overrides, a.removed));
    }
  }
  return cases;
}

void add_validate(CLI::App& app, Arguments& a, Body& body) {
  const auto asked = std::make_shared<ValidateArguments>();
  auto* validate = app.add_subcommand("validate", "compare exchange sources on frozen beds");
  validate->add_option("SCENE", asked->scenes, "scene files (TOML)")->required();
  validate->add_option("--emissivity", asked->emissivities, "of the particles: each scene once with each")
      ->delimiter(',')
      ->check(CLI::Range(0.0, 1.0));
  validate
      ->add_option("--max-error", asked->options.max_error_pct,
                   "exit 4 when a source is off by more than PCT %")
      ->type_name("PCT")
      ->check(CLI::PositiveNumber);
  add_scene_edits(validate, a);
  add_output(validate, a);
  validate->callback([&, asked] {
    body = [&, asked] {
      return validate_cases(cases_to_validate(a, *asked), a.folder, asked->options, a.options);
    };
  });
}

/// The command, and its old name with the name of its table.
void add_study_as(const char* name, const char* meaning, const char* table, CLI::App& app, Arguments& a,
                  Body& body) {
  const auto options = std::make_shared<StudyOptions>();
  auto* study = app.add_subcommand(name, meaning);
  add_study_options(study, a, *options);
  study->callback([&, options, table] {
    body = [&, options, table] {
      options->run = a.options;
      return run_study(a.scene, a.folder, *options, table);
    };
  });
}

void add_study(CLI::App& app, Arguments& a, Body& body) {
  add_study_as("study", "many cases: runs, validations, measurements, traces, fits; resumable", "study.csv",
               app, a, body);
  add_study_as("sweep", "the old name of study", "sweep.csv", app, a, body);
}

void add_measure(CLI::App& app, Arguments& a, Body& body) {
  const auto command = std::make_shared<ConductivityCommand>();
  auto* measure = app.add_subcommand("measure", "properties of a bed");
  add_conductivity(measure, a, *command);
  measure->callback([&, command] {
    body = [&, command] {
      command->overrides = a.overrides;
      command->removed = a.removed;
      return measure_case(*command, a.folder, a.options);
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
  exporter->add_option("--to", a.format, "vtp, dump, csv or npz (numpy)")
      ->required()
      ->check(CLI::IsMember({"vtp", "dump", "csv", "npz"}));
  add_common(exporter, a);
  exporter->callback([&] { body = [&] { return export_case(a.folder, a.format, a.options); }; });
}

int granrun(int argc, char** argv) {
  CLI::App app{"granrun: granular flows heated by conduction and radiation", "granrun"};
  set_manners(app);
  app.footer(
      "Exit codes: 0 ok, 1 numerical failure, 2 usage or input,\n"
      "3 file cannot be read or written, 4 threshold missed,\n"
      "75 wall time reached, 129/130/143 hung up, interrupted, terminated (these\n"
      "save a checkpoint). SIGUSR1 saves a checkpoint and the run goes on.");
  Arguments a;
  Body body;
  for (auto* add :
       {add_run, add_check, add_validate, add_study, add_measure, add_report, add_export, add_render})
    add(app, a, body);
  add_new(app, body);
  add_keys(app, body);
  join_ranks();
  return run_command(app, argc, argv, [&](const std::string& command) {
    if (command != "run") refuse_several_ranks("granrun " + command);
    apply(a, argc, argv);
    const int code = body();
    if (a.verbose) fmt::print(stderr, "granrun: {}\n", resources_used());
    return code;
  });
}

}  // namespace

int main(int argc, char** argv) {
  return leave_ranks(run_program("granrun", [&] { return granrun(argc, argv); }));
}

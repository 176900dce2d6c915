#include "coupling/granrun/arguments.h"

#include <fmt/core.h>
#include <omp.h>

#include <cstdio>

#include "dem/base/error.h"

namespace granrad {

namespace {

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

std::string command_line(int argc, char** argv) {
  std::string line;
  for (int k = 0; k < argc; ++k) line += (k ? " " : "") + in_quotes(argv[k]);
  return line;
}

}  // namespace

std::string in_quotes(const std::string& word) {
  const bool plain = word.find_first_of(" '\"\\$[]{}*?;&|<>()#!~`\t\n") == std::string::npos;
  if (plain && !word.empty()) return word;
  std::string inside;
  for (char c : word) inside += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return fmt::format("'{}'", inside);
}

void add_common(CLI::App* command, Arguments& a) {
  command->add_option("--threads", a.options.threads, "threads; results do not depend on it")
      ->check(CLI::Range(1, 4096));
  auto* quiet = command->add_flag("-q,--quiet", a.quiet, "errors only");
  command->add_flag("-v,--verbose", a.verbose, "also each row as it comes, time and memory on stderr")
      ->excludes(quiet);
}

void add_scene_edits(CLI::App* command, Arguments& a) {
  command
      ->add_option(
          "--set", a.overrides,
          "override a scene value, e.g. --set radiation.rays=1000; files: from here, else beside the scene")
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

void apply(Arguments& a, int argc, char** argv) {
  if (a.quiet) a.options.verbosity = Verbosity::quiet;
  if (a.verbose) a.options.verbosity = Verbosity::verbose;
  if (!a.walltime.empty()) a.options.walltime_s = seconds_of(a.walltime);
  if (a.options.threads > 0) omp_set_num_threads(a.options.threads);
  a.options.command_line = command_line(argc, argv);
}

}  // namespace granrad

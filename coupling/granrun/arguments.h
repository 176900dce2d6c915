#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "coupling/granrun/run_options.h"

namespace granrad {

/// What many subcommands take.
struct Arguments {
  std::string scene, folder, format, walltime;
  std::vector<std::string> overrides, removed;
  RunOptions options;
  bool quiet = false, verbose = false;
};

/// The options that many subcommands have, each added to `command`.
void add_common(CLI::App* command, Arguments& a);       ///< --threads, -q, -v
void add_scene_edits(CLI::App* command, Arguments& a);  ///< --set, --unset and the common ones
void add_scene(CLI::App* command, Arguments& a);        ///< SCENE and what edits it
void add_output(CLI::App* command, Arguments& a);
void add_stopping(CLI::App* command, Arguments& a);

/// A word as a shell would read it.
std::string in_quotes(const std::string& word);

/// Puts the options in force. Throws InputError.
void apply(Arguments& a, int argc, char** argv);

}  // namespace granrad
